# SPDX-License-Identifier: BSD-3-Clause
"""Arrangements of motors (FRAME_CLASS, FRAME_TYPE) under ArduPilot's numbers, with its numbering and directions.

Source: https://ardupilot.org/copter/docs/connect-escs-and-motors.html. Positions and directions are data here; from
them follow the parts of roll, pitch and yaw that each motor takes (as ArduPilot's: at most one half each) and the order
of the motor test (clockwise from the front).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sitl.core.elementary import atan2, cos, sin

from ..parameters import Parameters
from .state import MOTORS_MAX, MotorsState
from .state import QUAD as MOTORS_OF_QUAD

QUAD, HEXA, OCTA, OCTAQUAD, Y6 = 1, 2, 3, 4, 5
"""FRAME_CLASS"""
PLUS, X, V, H, PLUSREV = 0, 1, 2, 3, 6
Y6B, Y6F, BF_X, DJI_X, CW_X, I_TYPE, BF_X_REV, Y4 = 10, 11, 12, 13, 14, 15, 18, 19
"""FRAME_TYPE"""
_FIRST_FUNCTION = 33
"""SERVOn_FUNCTION of motor 1; the others follow."""


class Motor(NamedTuple):
    """One motor."""

    forward: float
    """Position, in any unit that all motors of a frame share."""
    right: float
    yaw: float
    """Its part of yaw: positive when it turns counter-clockwise."""


Frame = tuple[Motor, ...]
"""Motors in the order of their numbers."""


def _ring(angles: tuple[float, ...], turns: str, yaw: tuple[float, ...] = ()) -> Frame:
    """Motors on a circle at angles clockwise from the front [deg]; turns: + counter-clockwise, - clockwise."""
    points = tuple((cos(math.radians(angle)), sin(math.radians(angle))) for angle in angles)
    return _positions(points, turns, yaw)


def _positions(points: tuple[tuple[float, float], ...], turns: str, yaw: tuple[float, ...] = ()) -> Frame:
    """Motors at (forward, right)."""
    parts = yaw or (1.0,) * len(points)
    signs = [1.0 if turn == "+" else -1.0 for turn in turns]
    return tuple(Motor(*p, sign * part) for p, sign, part in zip(points, signs, parts, strict=True))


_QUAD_X = (45, -135, -45, 135)
_PAIRS_X = (45, -45, -135, 135, -45, 45, 135, -135)
_FRONT_WEAK = 0.7981  # of a V: the arms in front are longer to the side, their motors turn it less
_THIRD = 1.0 / 3.0

FRAMES: dict[tuple[int, int], Frame] = {
    (QUAD, PLUS): _ring((90, -90, 0, 180), "++--"),
    (QUAD, X): _ring(_QUAD_X, "++--"),
    (QUAD, V): _ring(_QUAD_X, "++--", (_FRONT_WEAK, 1.0, _FRONT_WEAK, 1.0)),
    (QUAD, H): _ring(_QUAD_X, "--++"),
    (QUAD, PLUSREV): _ring((90, -90, 0, 180), "--++"),
    (QUAD, BF_X): _ring((135, 45, -135, -45), "-++-"),
    (QUAD, BF_X_REV): _ring((135, 45, -135, -45), "+--+"),
    (QUAD, DJI_X): _ring((45, -45, -135, 135), "+-+-"),
    (QUAD, CW_X): _ring((45, 135, -135, -45), "+-+-"),
    (QUAD, Y4): _positions(((1, 1), (-1, 0), (-1, 0), (1, -1)), "+-+-"),
    (HEXA, PLUS): _ring((0, 180, -120, 60, -60, 120), "-+-++-"),
    (HEXA, X): _ring((90, -90, -30, 150, 30, -150), "-+-++-"),
    (HEXA, H): _positions(((0, 1), (0, -1), (1, -1), (-1, 1), (1, 1), (-1, -1)), "-+-++-"),
    (HEXA, DJI_X): _ring((30, -30, -90, -150, 150, 90), "+-+-+-"),
    (HEXA, CW_X): _ring((30, 90, 150, -150, -90, -30), "+-+-+-"),
    (OCTA, PLUS): _ring((0, 180, 45, 135, -45, -135, -90, 90), "--++++--"),
    (OCTA, X): _ring((22.5, -157.5, 67.5, 157.5, -22.5, -112.5, -67.5, 112.5), "--++++--"),
    (OCTA, V): _positions(
        ((0.34, -0.83), (-0.32, 0.67), (-0.32, -0.67), (-1, 0.5), (1, -1), (0.34, 0.83), (1, 1), (-1, -0.5)),
        "--++++--",
    ),
    (OCTA, H): _positions(
        ((1, 1), (-1, -1), (_THIRD, 1), (-1, 1), (1, -1), (-_THIRD, -1), (_THIRD, -1), (-_THIRD, 1)), "--++++--"
    ),
    (OCTA, I_TYPE): _positions(
        ((-1, -_THIRD), (1, _THIRD), (-1, -1), (1, -_THIRD), (-1, _THIRD), (1, 1), (-1, 1), (1, -1)), "--++++--"
    ),
    (OCTA, DJI_X): _ring((22.5, -22.5, -67.5, -112.5, -157.5, 157.5, 112.5, 67.5), "+-+-+-+-"),
    (OCTA, CW_X): _ring((22.5, 67.5, 112.5, 157.5, -157.5, -112.5, -67.5, -22.5), "+-+-+-+-"),
    (OCTAQUAD, PLUS): _ring((0, -90, 180, 90, -90, 0, 90, 180), "+-+-+-+-"),
    (OCTAQUAD, X): _ring(_PAIRS_X, "+-+-+-+-"),
    (OCTAQUAD, V): _ring(_PAIRS_X, "+-+-+-+-", (_FRONT_WEAK, _FRONT_WEAK, 1.0, 1.0) * 2),
    (OCTAQUAD, H): _ring(_PAIRS_X, "-+-+-+-+"),
    (OCTAQUAD, CW_X): _ring((45, 45, 135, 135, -135, -135, -45, -45), "+--++--+"),
    (OCTAQUAD, BF_X): _ring((135, 45, -135, -45) * 2, "-++-+--+"),
    (OCTAQUAD, BF_X_REV): _ring((135, 45, -135, -45) * 2, "+--+-++-"),
    (Y6, Y6B): _ring((60, 60, 180, 180, -60, -60), "-+-+-+"),
    (Y6, Y6F): _ring((180, 60, -60, 180, 60, -60), "+++---"),
}
_Y6_PLAIN = _ring((60, -60, -60, 180, 60, 180), "+-+--+")
_Y6_PLAIN_ORDER = (4, 0, 5, 3, 1, 2)


def frame_of(frame_class: int, frame_type: int) -> Frame | None:
    """The motors of a frame; None: the class does not have that type. A Y6 takes every type."""
    found = FRAMES.get((frame_class, frame_type))
    return _Y6_PLAIN if found is None and frame_class == Y6 else found


def order(p: Parameters) -> tuple[int, ...]:
    """Motors 0 .. in the order of the motor test: clockwise from the front."""
    frame = frame_of(int(p.FRAME.CLASS), int(p.FRAME.TYPE)) or ()
    if frame is _Y6_PLAIN:
        return _Y6_PLAIN_ORDER
    angles = [round(math.degrees(atan2(m.right, m.forward)), 6) % 360.0 for m in frame]
    return tuple(sorted(range(len(frame)), key=angles.__getitem__))


def load_frame(motors: MotorsState, p: Parameters, assigns: bool = True) -> None:
    """Let the mixer drive the frame that FRAME_CLASS and FRAME_TYPE name, by the outputs that SERVOn_FUNCTION name.

    A motor that no output has gets the output of its number (``assigns``), if that has no function yet (as
    ArduPilot's). A frame that there is not has no motors, and cannot be armed.
    """
    frame = frame_of(int(p.FRAME.CLASS), int(p.FRAME.TYPE)) or ()
    motors.count = len(frame)
    factors = _halves([-m.right for m in frame]), _halves([m.forward for m in frame]), _halves([m.yaw for m in frame])
    for k, (roll, pitch, yaw) in enumerate(zip(*factors, strict=True)):
        motors.roll_factor[k], motors.pitch_factor[k], motors.yaw_factor[k] = roll, pitch, yaw
        motors.yaw_range[k] = 1.0 / abs(yaw)
    functions = [int(p.SERVO[k].FUNCTION) for k in range(len(p.SERVO))]
    for k in range(MOTORS_MAX):
        wanted = _FIRST_FUNCTION + k
        if assigns and k < len(frame) and wanted not in functions and functions[k] == 0:
            p.SERVO[k].FUNCTION = functions[k] = wanted
        motors.output[k] = functions.index(wanted) if wanted in functions else -1
    motors.is_plain_quad = list(motors.output[: motors.count]) == list(range(MOTORS_OF_QUAD))


def _halves(parts: list[float]) -> list[float]:
    """Parts scaled so that the greatest is one half."""
    largest = max((abs(part) for part in parts), default=1.0)
    return [round(0.5 * part / largest, 9) + 0.0 for part in parts]
