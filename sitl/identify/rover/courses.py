# SPDX-License-Identifier: BSD-3-Clause
"""Drives of a rover's physics under given outputs, many at once: what a log's outputs would have made of an airframe.

The laws are those of the simulator (``sitl.physics.native.rover``), so that properties are fitted to the very model
that they are for.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core.array_kernels import Kernel, Line, Table
from ...core.constants import TICK_S
from ...core.kernels import law
from ...core.records import Records
from ...physics.native.rover.prepare import prepare
from ...physics.native.rover.state import Physics
from ...physics.native.rover.step import STEERING_OUTPUT, THROTTLE_OUTPUT, move
from ...vehicles.properties.ground_vehicle import STEERING_SKID

Array = np.ndarray[Any, Any]

_TICKS = 4
STEP_S = _TICKS * TICK_S
"""Between two samples of a course [s]."""


@law
def write_courses(
    cars: Records[Physics], first: Table, second: Table, controls: Line, speed: Table, yaw_rate: Table, work: Table
) -> None:
    """Drive each car by its outputs.

    Args:
        cars: as they are at the beginning.
        first: of the steering servo or of the left motors, -1 .. 1, shape (cars, samples).
        second: of the motor or of the right motors.
        controls: scratch, as many as a vehicle has.
        speed: forward, after each sample's ticks [m/s].
        yaw_rate: [rad/s].
        work: mean over the sample's ticks of what the battery gives [W].
    """
    for i in range(first.shape[0]):
        car = cars[i]
        for k in range(first.shape[1]):
            controls[STEERING_OUTPUT] = first[i, k]
            controls[THROTTLE_OUTPUT] = second[i, k]
            total = 0.0
            for _ in range(_TICKS):
                move(car.wheels, car.body, car.airframe, car.derived, controls)
                total += car.wheels.power
            speed[i, k] = car.wheels.forward
            yaw_rate[i, k] = car.body.rates.z
            work[i, k] = total / _TICKS


_courses = Kernel(write_courses)


class Courses(NamedTuple):
    """What the cars did; each (cars, samples)."""

    speed: Array
    """Forward [m/s]."""
    yaw_rate: Array
    """[rad/s]"""
    work: Array
    """What the battery gives [W]."""


def drive(properties: Array, first: Array, second: Array, speed: Array, yaw_rate: Array) -> Courses:
    """Courses of an airframe.

    Args:
        properties: record of the airframe (``Airframe.record``).
        first, second: outputs -1 .. 1 (cars, samples), ``STEP_S`` apart.
        speed, yaw_rate: at the beginning (cars,) [m/s], [rad/s]; wheels and servos are as if they had been there.
    """
    count, samples = first.shape
    cars = np.zeros(count, Physics.dtype)
    one = Physics.of(cars, 0)
    cars["airframe"] = properties
    prepare(one.airframe, one.derived)
    cars["derived"] = cars["derived"][0]
    skids = properties["steering_model"] == STEERING_SKID
    across = 0.5 / one.derived.inverse_track * yaw_rate if skids else np.zeros(count)
    wheels, body = cars["wheels"], cars["body"]
    wheels["speed"][:, 0], wheels["speed"][:, 1] = speed + across, speed - across
    wheels["forward"] = speed
    if not skids:
        wheels["angle"] = np.clip(first[:, 0] / one.airframe.control_full, -1.0, 1.0) * one.airframe.steering_angle
    body["q"][:, 0] = 1.0
    body["rates"][:, 2] = yaw_rate
    out = [np.zeros((count, samples)) for _ in Courses._fields]
    _courses(cars, np.ascontiguousarray(first, float), np.ascontiguousarray(second, float), np.zeros(16), *out)
    return Courses(*out)
