# SPDX-License-Identifier: BSD-3-Clause
"""What follows from a rover's properties; call again after changing any of them in the record."""

from __future__ import annotations

from ....core.constants import GRAVITY, TICK_S
from ....core.elementary import sin
from ....core.kernels import law
from ....vehicles.properties.ground_vehicle import (
    STEERING_FRONT_WHEELS,
    STEERING_SKID,
    STEERING_TURNING_CIRCLE,
    Properties,
)
from ..prepare import decay, prepare_shared, whole_ticks
from .state import Derived

UNLIMITED = 1e9
"""A step that nothing reaches."""


@law
def _step(rate: float) -> float:
    """Largest change in a tick at a rate a second; 0 is no limit."""
    return rate * TICK_S if rate > 0.0 else UNLIMITED


@law
def yaw_acceleration(a: Properties) -> float:
    """Greatest yaw acceleration [rad/s^2] that the tyres can give.

    Front wheels: the side force of the front axle about the centre of mass, which is (1 - front_load) of the
    wheelbase behind it. Skid steering: one side pushes, the other brakes, half a track from the middle.
    """
    force = a.grip * GRAVITY * a.mass
    if a.steering_model == STEERING_FRONT_WHEELS:
        torque = force * a.front_load * (1.0 - a.front_load) * a.wheelbase
    elif a.steering_model == STEERING_SKID:
        torque = 0.5 * force * a.track
    else:
        return 0.0
    return torque / a.inertia.z


@law
def prepare(a: Properties, d: Derived) -> None:
    """Fill ``d`` from the airframe's properties."""
    d.control_scale = 1.0 / a.control_full
    lag = d.motor_lag if d.motor_lag > 0.0 else a.time_constant
    d.speed_decay = decay(lag, TICK_S)
    d.speed_step = _step(a.drive_accel)
    resisting = lag * (1.0 - d.speed_decay) if lag > 0.0 else TICK_S  # exact for a motor of first order
    d.rolling_step = a.rolling_resistance * GRAVITY * resisting
    d.grip = a.grip * GRAVITY
    d.drive_grip = d.grip * a.driven_load
    d.yaw_step = _step(yaw_acceleration(a))
    d.steering_step = _step(d.servo_rate if d.servo_rate > 0.0 else a.steering_rate)
    d.inverse_wheelbase, d.circle_scale, d.inverse_track = 0.0, 0.0, 0.0
    if a.steering_model == STEERING_FRONT_WHEELS:
        d.inverse_wheelbase = 1.0 / a.wheelbase
    elif a.steering_model == STEERING_TURNING_CIRCLE:
        d.circle_scale = 2.0 / (a.turning_diameter * sin(a.steering_angle))
    else:
        d.inverse_track = 1.0 / (a.track * a.track_slip)
    d.bend, d.bend_angle = 0.0, 0.0  # straight on, whatever the properties
    d.power_by_accel = 0.0
    if a.efficiency > 0.0:
        d.power_by_accel = a.mass / a.efficiency
    d.encoder_period = 0
    if a.encoder_rate > 0.0:
        d.encoder_period = max(whole_ticks(1.0 / a.encoder_rate), 2)
    prepare_shared(a, d)
