# SPDX-License-Identifier: BSD-3-Clause
"""A Turtlebot in Bullet: wheels that roll and slip, walls that it slides along, a lidar of Bullet's rays."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...core.rng import normal
from ...vehicles.turtlebot import Lidar
from ...worlds import World, planar
from ..native.turtlebot.init import place as place_record
from ..native.turtlebot.state import TICK_S, TICK_US
from ..native.turtlebot.step import wheel_speeds
from . import worlds
from .client import Client, forget, load, save
from .picture import Camera, Picture
from .turtlebot_model import TORQUE, build
from .wheels import filter_by_both
from .worlds import cast

_ITERATIONS, _RESIDUAL = 50, 1e-14
_FORCE = 9
"""Column of pybullet's contacts: how hard [N]."""
_NOTHING = (0.0, 0.0, 0.0)


class BulletTurtlebot:
    """One robot in a world of Bullet of its own.

    Args:
        v: view of its record (``native.turtlebot.state.Turtlebot``), which always tells where it is.
        world: that it drives in.
        lidar: its rays and readings.

    Raises:
        MissingExtra: pybullet is not installed.
    """

    def __init__(self, v: Any, world: World, lidar: Lidar) -> None:
        self.v, self.world = v, world
        self._rays = planar.rays(lidar.rays, lidar.field_of_view)
        self._ranges, self._readings = np.empty(lidar.rays), np.empty(lidar.readings)
        self._client: Client | None = None
        self._picture: Picture | None = None
        self._airframe = b""
        self._rates = (math.nan, math.nan)

    def _fit(self) -> Client:
        """The world with a model of the robot as its properties are now."""
        airframe = bytes(self.v.airframe._bytes)
        if self._client is None or airframe != self._airframe:
            self.close()
            self._airframe, self._client = airframe, Client(TICK_S, _ITERATIONS, _RESIDUAL)
            filter_by_both(self._client)
            self.surfaces = worlds.build(self._client, self.world, self.world.floor_z)
            self.model = build(self._client, self.v.airframe, self.world.floor_z)
            self._zero = self.world.floor_z + self.model.height
            self._as_built: int = self._client.p.saveState(self._client.id)
            self._rates = (math.nan, math.nan)
        return self._client

    def place(self, north: float, east: float, heading: float, seed: int) -> None:
        """Put it at a pose on the floor, at rest [m, rad]."""
        place_record(self.v, north, east, 0.0 - self.world.floor_z, heading, seed)
        self.put()

    def put(self) -> None:
        """Put it where its record says, at rest."""
        client, b = self._fit(), self.v.body
        p, id_, number = client.p, client.id, self.model.body
        half = -0.5 * b.heading
        p.restoreState(self._as_built, physicsClientId=id_)
        forget(client, number, self._zero)
        at = (b.north, 0.0 - b.east, self._zero)
        p.resetBasePositionAndOrientation(number, at, (0.0, 0.0, math.sin(half), math.cos(half)), id_)
        p.resetBaseVelocity(number, _NOTHING, _NOTHING, id_)
        self._rates = (math.nan, math.nan)

    def advance(self, ticks: int) -> None:
        """Move on by ``ticks`` of 0.01 s under the command in its record."""
        client, v = self._fit(), self.v
        c, b, number = v.command, v.body, self.model.body
        timeout, has_solids = float(v.airframe.command_timeout), bool(self.surfaces.solids)
        p, id_ = client.p, client.id
        for _ in range(ticks):
            is_fresh = 1e-6 * (v.time_us - c.time_us) < timeout
            self._turn(client, wheel_speeds(v.airframe, c.forward, c.turn) if is_fresh else (0.0, 0.0))
            p.stepSimulation(id_)
            v.time_us += TICK_US
            if has_solids and not b.collided:
                rows = p.getContactPoints(number, -1, -1, -2, id_)
                b.collided = any(row[_FORCE] > 0.0 for row in rows)
        if ticks > 0:
            self._read(client)

    def _turn(self, client: Client, speeds: tuple[float, float]) -> None:
        """Rims to speeds [m/s], if they change."""
        f, p = self.v.airframe, client.p
        rates = (speeds[0] / f.wheel_radius_left, speeds[1] / f.wheel_radius_right)
        if rates == self._rates:
            return
        self._rates = rates
        p.setJointMotorControlArray(
            self.model.body,
            self.model.wheels,
            p.VELOCITY_CONTROL,
            targetVelocities=rates,
            forces=(TORQUE, TORQUE),
            physicsClientId=client.id,
        )

    def _read(self, client: Client) -> None:
        p, id_, number, b = client.p, client.id, self.model.body, self.v.body
        (x, y, _), (qx, qy, qz, qw) = p.getBasePositionAndOrientation(number, id_)
        (vx, vy, _), (_, _, turn) = p.getBaseVelocity(number, id_)
        c, s = 1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy + qw * qz)
        b.north, b.east, b.heading = x, 0.0 - y, 0.0 - math.atan2(s, c)
        b.speed, b.yaw_rate = c * vx + s * vy, 0.0 - turn

    def scan(self, readings: Any) -> None:
        """Read the lidar into ``readings`` (float32) [m], as ``native.turtlebot.scan``."""
        client, v = self._fit(), self.v
        b, f = v.body, v.airframe
        c, s = math.cos(b.heading), math.sin(b.heading)
        x, y = self._rays[0], self._rays[1]
        directions = np.stack([c * x - s * y, s * x + c * y, np.zeros_like(x)])
        ahead, longest = float(f.lidar_ahead), float(f.range_max)
        origin = np.array([b.north + c * ahead, b.east + s * ahead, b.down - float(f.lidar_height)])
        cast(client, origin, directions, self._ranges, longest)
        readings[:] = planar.publish(self._ranges, longest, self._readings)
        if f.range_noise > 0.0:
            for k in range(len(readings)):
                error = f.range_noise * normal(v.rng)
                if readings[k] < longest:
                    readings[k] = min(max(float(readings[k]) + error, 0.0), longest)

    def render(self, width: int, height: int, camera: Camera | None = None) -> Any:
        """A picture of it in its world, uint8, shape (height, width, 3); see ``Picture``."""
        client, floor = self._fit(), self.world.floor_z
        if self._picture is None:
            airframe = self.v.airframe
            self._picture = Picture(lambda c: build(c, airframe, floor).body, self.world, floor, 0.5)
        position, attitude = client.p.getBasePositionAndOrientation(self.model.body, client.id)
        return self._picture.render(position, attitude, width, height, camera)

    def snapshot(self) -> bytes:
        """What the record does not hold. Among solids it goes on as if it had been restored (``client.save``)."""
        saved = save(self._fit())
        if self.surfaces.solids:
            self.restore(saved)
        return saved

    def restore(self, state_: bytes) -> None:
        """Go back to a snapshot; the record has been put back already.

        Raises:
            EngineError: it is of another robot or world.
        """
        client = self._fit()
        load(client, state_, self.model.body, self._zero)
        self._rates = (math.nan, math.nan)

    def close(self) -> None:
        """Give its world up."""
        if self._picture is not None:
            self._picture.close()
            self._picture = None
        if self._client is not None:
            self._client.close()
            self._client = None
