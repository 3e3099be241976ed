# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks, as the copter's flight modes understand them (PILOT_*, THR_DZ)."""

from __future__ import annotations

import math

from ...core.algebra import norm2
from ...core.elementary import atan, cos, tan
from ...core.kernels import inlined, law
from ...core.scalars import constrain, is_same
from ...core.vectors import Vec2
from ..radio import (
    FRAME_S,
    PITCH,
    RECEIVER_PULSES,
    ROLL,
    THROTTLE,
    YAW,
    expo,
    ranged,
    ranged_middle,
    receive,
    stick_channel,
    stick_position,
)
from ..state import Failsafe, Radio
from .control.attitude import Lean
from .modes.state import Modes, PilotState
from .parameters import Parameters
from .parameters.flight_modes import Pilot
from .state import Vehicle

THROTTLE_ZERO_US = 400_000
"""The throttle counts as zero when it was low for so long."""
_THROTTLE_LOW = RECEIVER_PULSES[2]


def init(rc: Radio, pilot: PilotState) -> None:
    """A receiver is fitted; channels are not known yet."""
    rc.has_receiver = True
    pilot.throttle_zero = True
    pilot.throttle_zero_us = -THROTTLE_ZERO_US
    pilot.switch_position = -1
    pilot.switch_candidate = -1


@law
def has_receiver(rc: Radio, failsafe: Failsafe) -> bool:
    """Whether the sticks are the pilot's: the radio is there, and its failsafe off."""
    return rc.receiver_ok and not failsafe.radio


@law
def read(v: Vehicle) -> None:
    """One frame: effective channels, then the sticks. Called at 50 Hz."""
    ap = v.autopilot
    receive(ap.rc, v.sensors, ap.params, v.time_us, _THROTTLE_LOW, ap.params.RC_FS_TIMEOUT)
    read_sticks(ap.modes.pilot, has_receiver(ap.rc, ap.modes.failsafe), ap.rc, ap.params)
    note_throttle(ap.modes.pilot, v.time_us)
    filter_sticks(ap.modes.pilot, ap.params.PILOT)


@law
def read_sticks(pilot: PilotState, connected: bool, rc: Radio, p: Parameters) -> None:
    """Sticks from effective channels; without a radio (not ``connected``) centred, and the throttle closed."""
    if connected:
        pilot.roll = stick_position(rc, p, ROLL)
        pilot.pitch = stick_position(rc, p, PITCH)
        pilot.yaw = stick_position(rc, p, YAW)
        channel = stick_channel(p.RCMAP, THROTTLE)
        pilot.throttle = ranged(rc.channels[channel], p.RC[channel])
    else:
        pilot.roll = 0.0
        pilot.pitch = 0.0
        pilot.yaw = 0.0
        pilot.throttle = 0.0


@law
def note_throttle(pilot: PilotState, time_us: int) -> None:
    """Whether the throttle has been low for long enough to count as zero."""
    if pilot.throttle > 0.0:
        pilot.throttle_zero_us = time_us
        pilot.throttle_zero = False
    elif time_us - pilot.throttle_zero_us >= THROTTLE_ZERO_US:
        pilot.throttle_zero = True


@law
def filter_sticks(pilot: PilotState, p: Pilot) -> None:
    """PILOT_THR_FILT, and the turn rate by PILOT_Y_RATE, PILOT_Y_EXPO and PILOT_Y_RATE_TC."""
    gain = 1.0
    if p.THR_FILT > 0.0:
        gain = FRAME_S / (FRAME_S + 1.0 / (2.0 * math.pi * p.THR_FILT))
    pilot.throttle_filtered += gain * (pilot.throttle - pilot.throttle_filtered)
    gain = 1.0 if p.Y_RATE_TC <= 0.0 else FRAME_S / (FRAME_S + p.Y_RATE_TC)
    wanted = math.radians(p.Y_RATE) * expo(pilot.yaw, p.Y_EXPO)
    pilot.yaw_rate += gain * (wanted - pilot.yaw_rate)


@law
def limit_stick(stick: Vec2, length_max: float) -> Vec2:
    """``stick`` shortened to at most ``length_max``."""
    size = norm2(stick)
    return stick * (length_max / size) if size > length_max and size > 0.0 else stick


@law
def lean_of_sticks(roll: float, pitch: float, angle_max: float, limit: float) -> Lean:
    """Lean of sticks -1 .. 1; ``angle_max`` at full stick, tilt at most ``limit`` [rad].

    Sticks are horizontal thrusts (tangents), so that the tilt of a diagonal stick is limited as a vector.
    """
    thrust = Vec2(-tan(angle_max * pitch), tan(angle_max * roll))  # forward, right
    thrust = limit_stick(thrust, tan(min(limit, angle_max)))
    pitch = -atan(thrust.x)
    return Lean(atan(cos(pitch) * thrust.y), pitch)


@inlined
def is_lean_known(pilot: PilotState, angle_max: float, limit: float) -> bool:
    """Whether the last lean was asked for by the same sticks and limits."""
    sticks = is_same(pilot.roll, pilot.lean_of_roll) and is_same(pilot.pitch, pilot.lean_of_pitch)
    return sticks and is_same(angle_max, pilot.lean_of_angle) and is_same(limit, pilot.lean_of_limit)


@law
def lean_angles(pilot: PilotState, angle_max: float, limit: float) -> Lean:
    """Lean asked by the sticks (``lean_of_sticks``), worked out when they or the limits [rad] change."""
    if not is_lean_known(pilot, angle_max, limit):
        lean = lean_of_sticks(pilot.roll, pilot.pitch, angle_max, limit)
        pilot.lean_roll, pilot.lean_pitch = lean.roll, lean.pitch
        pilot.lean_of_roll, pilot.lean_of_pitch = pilot.roll, pilot.pitch
        pilot.lean_of_angle, pilot.lean_of_limit = angle_max, limit
    return Lean(pilot.lean_roll, pilot.lean_pitch)


@law
def throttle_middle(p: Parameters) -> float:
    """Where the throttle stick 0 .. 1 is in its middle."""
    return ranged_middle(p.RC[stick_channel(p.RCMAP, THROTTLE)])


@law
def climb_of_stick(throttle: float, middle: float, dead: float, speed_up: float, speed_down: float) -> float:
    """Climb rate [m/s], up positive, of a throttle stick 0 .. 1; 0 within ``dead`` of its ``middle``."""
    top = middle + dead
    bottom = middle - dead
    if throttle < bottom:
        return speed_down * (throttle - bottom) / bottom
    if throttle > top:
        return speed_up * (throttle - top) / (1.0 - top)
    return 0.0


@law
def speed_down(p: Pilot) -> float:
    """PILOT_SPEED_DN [m/s], or PILOT_SPEED_UP where that is 0."""
    return (p.SPEED_DN if p.SPEED_DN > 0.0 else p.SPEED_UP) * 0.01


@law
def climb_rate(modes: Modes, rc: Radio, p: Parameters) -> float:
    """Climb rate of the throttle stick [m/s], up positive; 0 within THR_DZ of the middle, and without a radio."""
    if not has_receiver(rc, modes.failsafe):
        return 0.0
    dead = constrain(p.THR_DZ * 0.001, 0.0, 0.4)
    return climb_of_stick(modes.pilot.throttle, throttle_middle(p), dead, p.PILOT.SPEED_UP * 0.01, speed_down(p.PILOT))


@law
def throttle_out(throttle: float, middle: float, hover: float) -> float:
    """Motor throttle 0 .. 1 of the stick in STABILIZE: a cubic through 0, 1 and ``hover`` near its ``middle``.

    Source: ArduPilot's manual throttle curve, out = x (1 - e) + e x^3 with e from MOT_THST_HOVER.
    """
    e = constrain(-(hover - 0.5) / 0.375, -0.5, 1.0)
    x = 0.5 * throttle / middle if throttle < middle else 0.5 + 0.5 * (throttle - middle) / (1.0 - middle)
    return x * (1.0 - e) + e * x * x * x
