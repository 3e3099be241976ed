# SPDX-License-Identifier: BSD-3-Clause
"""One tick of a rover's world: motors, steering, motion, wheels, solids, battery, sensors. Wind does not move it."""

from __future__ import annotations

from ....core.constants import TICK_S, TICK_US
from ....core.kernels import inline_unit, law
from ....core.records import Floats, Records
from ....core.vectors import Vec2
from ....vehicles.properties.ground_vehicle import STEERING_SKID, Properties
from .. import battery, bench, obstacles
from ..records import Body, Vehicle
from ..sensors.sense import sense
from ..tick import Clock
from . import encoders
from .drive import commanded, grip_along, run
from .motion import Course, hold_back, roll
from .state import Derived, Physics, Wheels
from .steering import approach, bend, followed, grip_across

STEERING_OUTPUT = 0
"""Output of the steering servo, or of the left motors."""
THROTTLE_OUTPUT = 2
"""Output of the motor, or of the right motors."""


@law
def drive(wheels: Wheels, airframe: Properties, derived: Derived, controls: Floats) -> None:
    """Let motors and steering follow the actuator controls [-1 .. 1] for a tick."""
    first = commanded(float(controls[STEERING_OUTPUT]), derived.control_scale)
    second = commanded(float(controls[THROTTLE_OUTPUT]), derived.control_scale)
    if wheels.is_faulty:
        first = wheels.held.x if wheels.stuck & 1 << STEERING_OUTPUT else first * wheels.share.x
        second = wheels.held.y if wheels.stuck & 1 << THROTTLE_OUTPUT else second * wheels.share.y
    if airframe.steering_model == STEERING_SKID:
        left = run(wheels.speed.x, first, airframe, derived)
        right = run(wheels.speed.y, second, airframe, derived)
        wheels.speed = Vec2(left.speed, right.speed)
        wheels.power = 0.5 * (left.power + right.power)
    else:
        if wheels.servo.is_slow:
            first = followed(wheels.servo, first)
        wheels.angle = approach(wheels.angle, first * airframe.steering_angle, derived.steering_step)
        axle = run(wheels.speed.x, second, airframe, derived)
        wheels.speed = Vec2(axle.speed, wheels.speed.y)
        wheels.power = axle.power


@law
def move(wheels: Wheels, body: Body, airframe: Properties, derived: Derived, controls: Floats) -> None:
    """Advance motors, wheels and body by one tick under the actuator controls [-1 .. 1]."""
    drive(wheels, airframe, derived, controls)
    before, left, right = wheels.forward, wheels.speed.x, wheels.speed.y
    skids = airframe.steering_model == STEERING_SKID
    pull = grip_along(before, 0.5 * (left + right) if skids else left, derived.drive_grip)
    wheels.forward = pull.speed
    if skids:
        wanted = (left - right) * derived.inverse_track
    else:
        wanted = pull.speed * bend(wheels.angle, airframe, derived)
    held = grip_across(wanted, pull.speed, pull.accel, derived.grip)
    yaw_rate = approach(body.rates.z, held, derived.yaw_step)
    roll(body, Course(before, pull.speed, yaw_rate), airframe.rear_axle)
    if not skids:
        differ = 0.5 * airframe.track * body.rates_mean.z  # the outer wheel rolls further
        left, right = left + differ, left - differ
    wheels.distance += TICK_S * Vec2(left, right)


@law
def begin(v: Vehicle[Physics]) -> None:
    """First thing of a tick: the clock goes on."""
    v.time_us += TICK_US
    v.tick += 1


@law
def end(v: Vehicle[Physics]) -> None:
    """Last thing of a tick: battery and sensors."""
    p = v.physics
    battery.discharge(p.battery, p.wheels.power, p.airframe, p.derived.charge_per_amp)
    battery.sag(p.battery, p.airframe, p.derived.charge_per_amp)
    sense(p, v.sensors, v.rng, Clock(v.tick, v.time_us))
    step, period = p.airframe.encoder_step, p.derived.encoder_period
    if period == 0:  # the airframe has none
        step, period = p.wheels.encoder_step, p.wheels.encoder_period
    encoders.sample(v.sensors, p.wheels.distance, step, period, v.tick)


@inline_unit
def step(fleet: Records[Vehicle[Physics]], i: int) -> None:
    """Advance vehicle ``i`` by one tick of 2500 us: actuators in, sensors out."""
    v = fleet[i]
    begin(v)
    p = v.physics
    if p.airframe.on_bench:
        bench.turn(p.body, v.actuators.pwm, v.time_us)
    else:
        move(p.wheels, p.body, p.airframe, p.derived, v.actuators.controls)
    if p.obstacles.present:
        if obstacles.collide(p.obstacles, p.body, p.airframe, v.time_us):
            hold_back(p.body, p.obstacles, p.wheels, p.airframe.rear_axle)
        obstacles.show(p.obstacles, p.body)
    end(v)
