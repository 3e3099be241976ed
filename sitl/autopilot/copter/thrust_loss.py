# SPDX-License-Identifier: BSD-3-Clause
"""Loss of thrust: when a vehicle sinks at full throttle and does not lean, a motor is taken to fail, and the mixer
boosts the others (FLIGHT_OPTIONS 1 switches that off)."""

from __future__ import annotations

import math
from typing import Any

from ...core.kernels import inlined, law
from ...core.mavlink import MavSeverity
from ..aux_switch import LOW
from ..events import Event, emit, err
from ..log_events import LogErrorSubsystem
from ..notes import EventNote, Switched, Text
from ..payload import SWITCH_GRIPPER
from .control.mixer import BOOST_MOTORS, watch_balance
from .control.state import AttitudeState, MotorsState
from .state import Vehicle

TRIGGER_TICKS = 400
"""1 s."""
THROTTLE_HIGH, THROTTLE_LOW = 0.9, 0.25
LEAN_MAX = math.radians(15.0)
"""Greatest lean that is asked for."""
ERROR_MAX = math.radians(30.0)
"""From there on a crash is more likely."""
_OFF, _OPENS_GRIPPER = 1, 4
"""FLIGHT_OPTIONS"""


def _texts(v: Any, motor: float, b: float) -> list[EventNote]:
    notes: list[EventNote] = [Text(MavSeverity.EMERGENCY, f"Potential Thrust Loss ({motor:.0f})")]
    opens = int(v.autopilot.params.FLIGHT_OPTIONS) & _OPENS_GRIPPER != 0
    return [*notes, Switched(SWITCH_GRIPPER, LOW)] if opens else notes


THRUST_LOST = Event(40, says=_texts, log=err(LogErrorSubsystem.THRUST_LOSS_CHECK, 1))  # a: motor 1 .. that fails


@inlined
def may_be_lost(attitude: AttitudeState, motors: MotorsState, vel_d: float) -> bool:
    """Whether throttle is used up and the vehicle sinks all the same; ``vel_d``: down [m/s]."""
    if attitude.throttle_in < THROTTLE_HIGH and not motors.limit_throttle_upper:  # first, since seldom otherwise
        return False
    return attitude.throttle_in >= THROTTLE_LOW and vel_d > 0.0


@law
def is_level(attitude: AttitudeState) -> bool:
    """Whether little lean is asked for, and held."""
    if attitude.thrust_error_angle >= ERROR_MAX:
        return False
    target = attitude.target_euler
    return target.roll * target.roll + target.pitch * target.pitch <= LEAN_MAX * LEAN_MAX


@inlined
def check(v: Vehicle) -> None:
    """One tick: count, and boost after a second."""
    ap = v.autopilot
    attitude, motors = ap.control.attitude, ap.control.motors
    if may_be_lost(attitude, motors, ap.estimate.vel.z):
        watch(v)
    elif motors.loss_ticks != 0:
        motors.loss_ticks = 0


@law
def watch(v: Vehicle) -> None:
    """The rest of ``check``, which few ticks come to."""
    ap = v.autopilot
    motors = ap.control.motors
    watched = (
        ap.arming.armed and not ap.arming.landed and not motors.boosting and int(ap.params.FLIGHT_OPTIONS) & _OFF == 0
    )
    if motors.count < BOOST_MOTORS:
        watch_balance(motors, 1.0, 0.0)
    motors.loss_ticks = motors.loss_ticks + 1 if watched and is_level(ap.control.attitude) else 0
    if motors.loss_ticks >= TRIGGER_TICKS:
        motors.loss_ticks = 0
        motors.boosting = True
        emit(ap.events, v.time_us, THRUST_LOST, float(motors.strongest + 1), 0.0)
