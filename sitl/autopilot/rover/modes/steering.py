# SPDX-License-Identifier: BSD-3-Clause
"""STEERING: the sticks are lateral acceleration and speed.

Full stick is the acceleration of the tightest turn (TURN_RADIUS) at this speed, at most ATC_TURN_MAX_G. A skid-steered
vehicle that stands turns on the spot.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import constrain
from .. import pilot
from ..control import motors
from ..control.steering import lat_accel_max, out_from_lat_accel, out_from_rate
from ..state import Vehicle
from . import drive
from .mode import RoverMode

STEERING = 3

ACCEL_MIN = 0.1  # [m/s^2]
RADIUS_MIN = 0.1  # [m]


@law
def full_stick_accel(speed: float, turn_radius: float, accel_max: float) -> float:
    """Lateral acceleration [m/s^2] of a full stick at ``speed`` [m/s], for a tightest turn of ``turn_radius`` [m]."""
    return constrain(speed * speed / max(turn_radius, RADIUS_MIN), ACCEL_MIN, max(accel_max, ACCEL_MIN))


@law
def stick_accel(wanted: pilot.SteeringAndSpeed, forward: float, turn_radius: float, accel_max: float) -> float:
    """Lateral acceleration [m/s^2] to the right that the sticks ask for at the speed ``forward`` [m/s]."""
    accel = full_stick_accel(forward, turn_radius, accel_max) * wanted.steering
    return constrain(-accel if wanted.speed < 0.0 else accel, -accel_max, accel_max)


@law
def run(v: Vehicle) -> None:
    """One period; without a known speed the motors rest."""
    ap = v.autopilot
    control, p = ap.control, ap.params
    if not control.speed.forward_ok:
        motors.set_throttle(control.motors, ap.arming.armed, 0.0, p.MOT)
        motors.set_steering(control.motors, 0.0)
        return
    wanted = pilot.steering_and_speed(ap.modes.pilot, control, p)
    if wanted.speed == 0.0 and motors.is_skid(p):
        turn_rate = wanted.steering * math.radians(p.ACRO_TURN_RATE)
        demand = out_from_rate(control, ap.estimate, turn_rate, p.ATC)
    else:
        accel = stick_accel(wanted, control.speed.forward, p.TURN_RADIUS, lat_accel_max(p.ATC))
        demand = out_from_lat_accel(control, ap.estimate, accel, p.ATC)
    motors.set_steering(control.motors, demand)
    drive.at_speed(v, wanted.speed)


MODE = RoverMode(number=STEERING, name="STEERING", run=run, needs_velocity=True, manual_input=True)
