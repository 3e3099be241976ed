# SPDX-License-Identifier: BSD-3-Clause
"""An autopilot that stands level at the origin with the firmware's defaults, and how to fly it in plain
Python.
"""

from __future__ import annotations

from typing import Any

from sitl.autopilot.copter.control import altitude_start, position_start, throttle_mix
from sitl.autopilot.copter.control.control_step import drive, init
from sitl.autopilot.copter.control.frames import load_frame
from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.copter.state import Autopilot
from sitl.core.algebra import euler_of, multiply, normalise, quat_from_rotation_vector
from sitl.core.border import Actuators
from sitl.core.vectors import Euler, Quat, Vec3


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


def moving(ap: Any) -> Any:
    """The controllers of a vehicle somewhere, with a velocity and a lean to the right."""
    ap.control.tick = 100
    ap.estimate.pos, ap.estimate.vel = Vec3(1.0, -2.0, -30.0), Vec3(3.0, 4.0, -1.5)
    set_attitude(ap, quat_from_rotation_vector(Vec3(0.2, 0.0, 0.0)))
    ap.control.attitude.target_euler = Euler(0.2, 0.0, 0.0)
    ap.control.attitude.lean_max = 1.2
    ap.estimate.reset_ne_count, ap.estimate.reset_d_count = 3, 4
    position_start.set_max_speed_accel_ne(ap.control.pos_ne, ap.params, 10.0, 2.5)
    altitude_start.set_max_speed_accel_d(ap.control.pos_d, ap.params.PSC, 1.5, 2.5, 1.0)
    return ap.control
