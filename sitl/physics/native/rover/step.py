# SPDX-License-Identifier: BSD-3-Clause
"""One tick of a rover's world: motors, steering, motion, wheels, solids, battery, sensors. Wind does not move it."""

from __future__ import annotations

from ....core.kernels import law, unit
from ....vehicles.figures.rover import STEERING_SKID
from .. import battery, obstacles
from ..sensors.sense import sense
from ..tick import TICK_S, TICK_US
from . import encoders
from .drive import commanded, grip_along, run
from .motion import hold_back, roll
from .steering import curvature, grip_across, turn_wheels

STEERING_OUTPUT = 0
"""Output of the steering servo, or of the left motors."""
THROTTLE_OUTPUT = 2
"""Output of the motor, or of the right motors."""


@law
def drive(p, controls):
    """Let motors and steering follow the actuator controls [-1 .. 1] for a tick."""
    w, scale = p.wheels, float(p.derived.control_scale)
    first = commanded(float(controls[STEERING_OUTPUT]), scale)
    second = commanded(float(controls[THROTTLE_OUTPUT]), scale)
    if int(p.airframe.steering_model) == STEERING_SKID:
        w.power = 0.5 * (run(p, 0, first) + run(p, 1, second))
    else:
        turn_wheels(p, first)
        w.power = run(p, 0, second)


@law
def move(p, controls):
    """Advance motors, wheels and body by one tick under the actuator controls [-1 .. 1]."""
    w, rolled = p.wheels, p.wheels.distance
    before = float(w.forward)
    drive(p, controls)
    if int(p.airframe.steering_model) == STEERING_SKID:
        left, right = float(w.speed[0]), float(w.speed[1])
        accel = grip_along(p, 0.5 * (left + right))
        rate = (left - right) * float(p.derived.inverse_track)
        roll(p, before, grip_across(p, rate, accel))
    else:
        speed = float(w.speed[0])
        accel = grip_along(p, speed)
        roll(p, before, grip_across(p, float(w.forward) * curvature(p), accel))
        differ = 0.5 * float(p.airframe.track) * float(p.body.rates_mean[2])  # the outer wheel rolls further
        left, right = speed + differ, speed - differ
    rolled[0] += TICK_S * left
    rolled[1] += TICK_S * right


@law
def begin(v):
    """First thing of a tick: the clock goes on."""
    v.time_us += TICK_US
    v.tick += 1


@law
def end(v):
    """Last thing of a tick: battery and sensors."""
    p = v.physics
    battery.update(p, float(p.wheels.power))
    sense(p, v.sensors, int(v.tick), int(v.time_us), v.rng)
    encoders.update(p, v.sensors, int(v.tick))


@unit
def step(fleet, i):
    """Advance vehicle ``i`` by one tick of 2500 us: actuators in, sensors out."""
    v = fleet[i]
    begin(v)
    p, time_us = v.physics, int(v.time_us)
    move(p, v.actuators.controls)
    if p.obstacles.present != 0:
        if obstacles.collide(p, time_us):
            hold_back(p)
        obstacles.show(p)
    end(v)
