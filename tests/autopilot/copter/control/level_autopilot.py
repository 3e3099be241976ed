# SPDX-License-Identifier: BSD-3-Clause
"""An autopilot that stands level at the origin with the firmware's defaults, and how to fly it in plain
Python.
"""

from __future__ import annotations

from typing import Any

from sitl.autopilot.copter.control import throttle_mix
from sitl.autopilot.copter.control.control_step import drive, init
from sitl.autopilot.copter.control.frames import load_frame
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.copter.state import Autopilot
from sitl.core.algebra import euler_of, multiply, normalise, quat_from_rotation_vector
from sitl.core.border import Actuators
from sitl.core.vectors import Quat


def make_autopilot() -> Any:
    """A view of one autopilot record; controllers initialised, disarmed."""
    ap = Autopilot()
    TABLE.set_defaults(ap.params)
    ap.params.FRAME_CLASS = 1.0
    load_frame(ap.control.motors, ap.params)
    ap.estimate.q = ap.estimate.q.replace(w=1.0)
    init(*parts(ap))
    return ap


def make_actuators() -> Any:
    """A view of one actuators record."""
    return Actuators()


def parts(ap: Any) -> tuple[Any, Any, Any]:
    """What the controllers work on: their record, the estimate, the parameters."""
    return ap.control, ap.estimate, ap.params


def arm(ap: Any, throttle: float = 0.35) -> None:
    """Armed long ago, spooled up, throttle steady."""
    ap.arming.armed = 1
    ap.arming.armed_us = -10_000_000
    ap.control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    ap.control.motors.spool_state = SpoolState.THROTTLE_UNLIMITED
    ap.control.motors.thrust_max = 1.0
    throttle_mix.set_throttle_out(ap.control, ap.params, throttle, True, 0.0)


def output(ap: Any, actuators: Any) -> None:
    """What ``control.control_step`` does after the modes, on records that are not inside a vehicle."""
    drive(ap, actuators, 0)


def set_attitude(ap: Any, q: Quat) -> None:
    """Put an attitude into the estimate."""
    ap.estimate.q = normalise(q)
    ap.estimate.euler = euler_of(ap.estimate.q)


def turn(ap: Any, dt: float, authority: tuple[float, float, float] = (120.0, 120.0, 50.0)) -> None:
    """One period of a rigid body that the roll, pitch and yaw demands accelerate, ``authority`` [rad/s^2] at
    1.
    """
    est, m = ap.estimate, ap.control.motors
    demands = [min(max(float(demand), -1.0), 1.0) for demand in (m.roll, m.pitch, m.yaw)]
    est.rates = [r + (a * d - 0.3 * r) * dt for r, a, d in zip(est.rates, authority, demands, strict=True)]
    set_attitude(ap, multiply(est.q, quat_from_rotation_vector(est.rates * dt)))
