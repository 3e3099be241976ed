# SPDX-License-Identifier: BSD-3-Clause
"""A rover's motors, steering and encoders, between record and JSBSim."""

from __future__ import annotations

import math
from typing import Any

from ...core.constants import TICK_S
from ...core.vectors import Vec2
from ...vehicles.properties.ground_vehicle import STEERING_SKID
from ..engine import EngineVehicle
from ..native.rover.steering import curvature
from . import rover_aircraft
from .engine import JsbsimEngine
from .formula import NAME
from .model import FOOT, Properties, VehicleModel
from .rover_aircraft import FRONT_LEFT, FRONT_RIGHT


class RoverModel(VehicleModel):
    """Wheel speeds and steering angle in, speed over the ground and travel of the wheels out."""

    def __init__(self, vehicle: EngineVehicle) -> None:
        super().__init__(vehicle)
        self._p = vehicle.v.physics
        self._wheels = self._p.wheels

    def document(self, a: Any, dt: float) -> str:
        return rover_aircraft.document(a, NAME, dt)

    def height(self, a: Any) -> float:
        return rover_aircraft.layout(a).height

    def bind(self, properties: Properties, a: Any, dt: float) -> None:
        at = rover_aircraft.layout(a)
        self.ahead = at.ahead
        self._wheelbase, self._half_track = at.wheelbase, at.half_track
        self._is_skid = int(a.steering_model) == STEERING_SKID
        self._speed_to = [properties.writer(f"drive/speed{k}") for k in (1, 2)]
        if not self._is_skid:
            numbers = (FRONT_LEFT, FRONT_RIGHT)
            self._turn = [properties.writer(f"fcs/steer-pos-deg[{k}]") for k in numbers]
        self._forward = properties.reader("velocities/u-fps")
        self._yaw_rate = properties.reader("velocities/r-rad_sec")

    def starting(self) -> None:
        self._angle = math.nan

    def inputs(self) -> None:
        left, right = self._wheels.speed
        self._speed_to[0](left)
        if self._is_skid:
            self._speed_to[1](right)
            return
        angle = self._wheels.angle
        if angle != self._angle:
            self._angle = angle
            self._steer(curvature(angle, self._p.airframe, self._p.derived))

    def _steer(self, bend: float) -> None:
        """Turn each front wheel to the circle of curvature ``bend`` [1/m] that the rear axle shall run on."""
        for write, y in zip(self._turn, (-self._half_track, self._half_track), strict=True):
            write(math.degrees(math.atan(self._wheelbase * bend / (1.0 - bend * y))))

    def outputs(self, down: float) -> None:
        self._wheels.forward = FOOT * self._forward()
        left, right = self._wheels.speed
        if not self._is_skid:
            differ = self._half_track * self._yaw_rate()  # the outer wheel rolls further
            left, right = left + differ, left - differ
        self._wheels.distance += TICK_S * Vec2(left, right)


def make(vehicle: EngineVehicle) -> JsbsimEngine:
    """JSBSim for a rover.

    Raises:
        EngineError: its world is nothing for JSBSim.
        MissingExtra: JSBSim is not installed.
    """
    return JsbsimEngine(vehicle, RoverModel(vehicle))
