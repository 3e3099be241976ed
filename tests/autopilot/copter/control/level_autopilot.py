# SPDX-License-Identifier: BSD-3-Clause
"""An autopilot that stands level at the origin with the firmware's defaults, and how to fly it in plain
Python.
"""

from __future__ import annotations

from typing import Any

from sitl.autopilot.copter.control import motors, rate, throttle_mix
from sitl.autopilot.copter.control.update import init
from sitl.autopilot.copter.state import Autopilot
from sitl.autopilot.copter.table import TABLE
from sitl.autopilot.state import Actuators
from sitl.core.rotations import quat_from_rotation_vector, quat_multiply, quat_normalise, quat_to_euler


def make_autopilot() -> Any:
    """A view of one autopilot record; controllers initialised, disarmed."""
    ap = Autopilot()
    TABLE.set_defaults(ap.params)
    ap.params.FRAME_CLASS = 1.0
    ap.estimate.q[0] = 1.0
    init(ap)
    return ap


def make_actuators() -> Any:
    """A view of one actuators record."""
    return Actuators()


def arm(ap: Any, throttle: float = 0.35) -> None:
    """Armed long ago, spooled up, throttle steady."""
    ap.arming.armed = 1
    ap.arming.armed_us = -10_000_000
    ap.control.motors.desired_spool = motors.DESIRED_THROTTLE_UNLIMITED
    ap.control.motors.spool_state = motors.THROTTLE_UNLIMITED
    ap.control.motors.thrust_max = 1.0
    throttle_mix.set_throttle_out(ap, throttle, 1, 0.0)


def output(ap: Any, actuators: Any) -> None:
    """What ``control.update`` does after the modes, on records that are not inside a vehicle."""
    throttle_mix.update_mix(ap)
    rate.update(ap)
    motors.update(ap, 0)
    motors.write_actuators(ap, actuators)
    ap.control.tick += 1


def set_attitude(ap: Any, w: float, x: float, y: float, z: float) -> None:
    """Put an attitude into the estimate."""
    ap.estimate.q[:] = quat_normalise(w, x, y, z)
    ap.estimate.euler[:] = quat_to_euler(*ap.estimate.q)


def turn(ap: Any, dt: float, authority: tuple[float, float, float] = (120.0, 120.0, 50.0)) -> None:
    """One period of a rigid body that the roll, pitch and yaw demands accelerate, ``authority`` [rad/s^2] at
    1.
    """
    est, m = ap.estimate, ap.control.motors
    for k, demand in enumerate((m.roll, m.pitch, m.yaw)):
        limited = min(max(float(demand), -1.0), 1.0)
        est.rates[k] += (authority[k] * limited - 0.3 * est.rates[k]) * dt
    q = quat_multiply(*est.q, *quat_from_rotation_vector(*(float(r) * dt for r in est.rates)))
    set_attitude(ap, *q)
