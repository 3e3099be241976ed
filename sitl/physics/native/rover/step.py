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
def commands(p, controls):
    """Commands -1 .. 1 of the two actuator controls in use."""
    scale = float(p.derived.control_scale)
    return (commanded(float(controls[STEERING_OUTPUT]), scale), commanded(float(controls[THROTTLE_OUTPUT]), scale))


@law
def drive_sides(p, left, right):
    """Let the motors of both sides follow their commands for a tick."""
    p.wheels.power = 0.5 * (run(p, 0, left) + run(p, 1, right))


@law
def drive_axle(p, steering, throttle):
    """Let steering and motor follow their commands for a tick."""
    turn_wheels(p, steering)
    p.wheels.power = run(p, 0, throttle)


@law
def move(p, controls):
    """Advance motors, wheels and body by one tick under the actuator controls [-1 .. 1]."""
    w, rolled = p.wheels, p.wheels.distance
    first, second = commands(p, controls)
    before = float(w.forward)
    if int(p.airframe.steering_model) == STEERING_SKID:
        drive_sides(p, first, second)
        left, right = float(w.speed[0]), float(w.speed[1])
        accel = grip_along(p, 0.5 * (left + right))
        rate = (left - right) * float(p.derived.inverse_track)
        roll(p, before, grip_across(p, rate, accel))
    else:
        drive_axle(p, first, second)
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
