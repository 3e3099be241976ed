# SPDX-License-Identifier: BSD-3-Clause
"""An artificial horizon as SVG, with heading, speed and height: the vehicle's own, as on a ground station, or the truth
where no autopilot says anything. It says which."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..core.algebra import euler_of
from .frame import LOG, VEHICLE, Frame

_PIXELS_A_DEGREE = 2.2
_WIDTH, _HEIGHT = 260, 170


class Reading(NamedTuple):
    """What the instrument shows."""

    whose: str
    roll: float
    """[deg]"""
    pitch: float
    """[deg]"""
    heading: float | None
    """[deg]"""
    speed: float | None
    """Over the ground [m/s]."""
    height: float | None
    """Above home, or above the start [m]."""


WHOSE = {VEHICLE: "vehicle's estimate", LOG: "as logged"}
TRUTH = "truth"


def read(frame: Frame) -> Reading:
    """The numbers of a moment."""
    reported = frame.reported
    if reported is None:
        roll, pitch, yaw = (math.degrees(angle) for angle in euler_of(frame.q))
        return Reading(TRUTH, roll, pitch, yaw % 360.0, math.hypot(frame.vel.x, frame.vel.y), true_height(frame))
    roll, pitch = math.degrees(reported.roll), math.degrees(reported.pitch)
    return Reading(WHOSE[reported.by], roll, pitch, reported.heading, reported.speed, reported.height)


def true_height(frame: Frame) -> float:
    """Height above the ground point where its world begins [m]."""
    return frame.stands.z - frame.pos.z


def number(value: float | None, digits: int, unit: str) -> str:
    """A number with its unit; a dash for what is not known."""
    return "-" if value is None else f"{value:.{digits}f} {unit}".replace("-0.0 ", "0.0 ").replace("-0.00 ", "0.00 ")


def degrees(value: float | None) -> str:
    """A heading, 000° to 359°."""
    return "-" if value is None else f"{round(value) % 360:03d}°"


def draw(frame: Frame) -> str:
    """The instrument for a moment."""
    whose, roll, pitch, heading, speed, height = read(frame)
    middle_x, middle_y, far = _WIDTH / 2, _HEIGHT / 2, 400
    down = pitch * _PIXELS_A_DEGREE
    ladder = "".join(
        f'<line x1="{-w}" x2="{w}" y1="{-k * _PIXELS_A_DEGREE:.1f}" y2="{-k * _PIXELS_A_DEGREE:.1f}"/>'
        for k in range(-60, 61, 10) if k for w in [22 if k % 20 == 0 else 11]
    )  # fmt: skip
    return (
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="100%" style="display:block;border-radius:6px" '
        f'font-family="sans-serif" font-size="12">'
        f'<g transform="translate({middle_x} {middle_y}) rotate({-roll:.1f}) translate(0 {down:.1f})">'
        f'<rect x="{-far}" y="{-far}" width="{2 * far}" height="{far}" fill="#5aa9e6"/>'
        f'<rect x="{-far}" y="0" width="{2 * far}" height="{far}" fill="#a9744f"/>'
        f'<g stroke="#fff"><line x1="{-far}" x2="{far}" y1="0" y2="0" stroke-width="1.5"/>{ladder}</g></g>'
        f'<g stroke="#ffd400" stroke-width="3" fill="none">'
        f'<path d="M{middle_x - 55} {middle_y}h35l8 8M{middle_x + 55} {middle_y}h-35l-8 8"/></g>'
        f'<circle cx="{middle_x}" cy="{middle_y}" r="2.5" fill="#ffd400"/>'
        f'<g fill="#111" fill-opacity="0.55"><rect x="0" y="{middle_y - 12}" width="58" height="24"/>'
        f'<rect x="{_WIDTH - 58}" y="{middle_y - 12}" width="58" height="24"/>'
        f'<rect x="{middle_x - 28}" y="0" width="56" height="20"/></g>'
        f'<g fill="#fff" text-anchor="middle"><text x="29" y="{middle_y + 4}">{number(speed, 1, "m/s")}</text>'
        f'<text x="{_WIDTH - 29}" y="{middle_y + 4}">{number(height, 1, "m")}</text>'
        f'<text x="{middle_x}" y="14">{degrees(heading)}</text>'
        f'<text x="{middle_x}" y="{_HEIGHT - 7}" font-size="11">{whose}</text></g></svg>'
    )
