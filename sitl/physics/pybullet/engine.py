# SPDX-License-Identifier: BSD-3-Clause
"""A copter in Bullet: a rigid body with legs under the forces of its rotors, among the solids of a world.

The record's position is that of the soles: 0 on the floor. Bullet's is the centre of mass, which is the height of the
pressed legs above; since that offset stays upright, both have the same velocity.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import Any, ClassVar

from ...core.algebra import rotate
from ...core.constants import GRAVITY
from ...core.vectors import Quat, Vec3
from ...worlds.contact import clearance
from ..engine import Array, Engine, EngineError, EngineVehicle, offset
from ..native.obstacles import settle
from ..native.records import GROUND_AIRBORNE, GROUND_STANDING
from . import urdf, worlds
from .client import load, save
from .contacts import CLEAR, Row, contacts_report
from .copter_body import ALL, BODY, CopterBody
from .picture import Camera, Picture

_MARGIN = 0.1
"""What is farther away than this cannot have left anything in Bullet's contacts [m]."""
_SLOW = 0.05
"""A standing copter that slides faster than this may run into something with its feet [m/s]."""
_NO_STATE = -1
_ORIGIN = (0.0, 0.0, 0.0)
_LINK_FRAME = 1
_BODY_NUMBERS = struct.Struct("<13d")
"""pos, vel, q, rates of ``physics.body``."""
_VELOCITY, _VELOCITY_AT = struct.Struct("<3d"), 24
_WRENCH = struct.Struct("<6d")
"""force, torque of ``physics.motion``."""


class BulletEngine(Engine):
    """A copter in a world of Bullet of its own.

    Args:
        vehicle: record, airframe, compiled laws and world.

    Raises:
        MissingExtra: pybullet is not installed.
    """

    name: ClassVar[str] = "pybullet"

    def __init__(self, vehicle: EngineVehicle) -> None:
        super().__init__(vehicle)
        self._memory: Any = vehicle.fleet.view("u1").data
        base = vehicle.index * vehicle.fleet.dtype.itemsize
        self._body_at = base + offset(vehicle.fleet.dtype, "physics", "body")
        self._wrench_at = base + offset(vehicle.fleet.dtype, "physics", "motion")
        self._load = vehicle.laws.load
        self._ground, self._obstacles = vehicle.v.physics.ground, vehicle.v.physics.obstacles
        self._body: CopterBody | None = None
        self._airframe = b""
        self._picture: Picture | None = None

    @property
    def body(self) -> CopterBody:
        """The model in its world, as the vehicle's properties are now."""
        a = self.vehicle.v.physics.airframe
        airframe = bytes(a._bytes)
        if self._body is None or airframe != self._airframe:
            self.close()
            self._body, self._airframe = CopterBody(a, self.vehicle.world, self.vehicle.floor), airframe
        return self._body

    # ------------------------------------------------------------------ going on

    def place(self) -> None:
        body, p = self.body, self.vehicle.v.physics
        position, (x, y, z, w) = self._pose()
        body.put(position, (x, y, z, w))
        _, found = body.client.p.getBasePositionAndOrientation(body.number, body.client.id)
        if found[0] * x + found[1] * y + found[2] * z + found[3] * w < 0.0:
            p.body.q = -p.body.q  # the same attitude under the sign that Bullet gives it
        if body.has_hard_feet:
            settle(p.obstacles)

    def move(self) -> None:
        body = self._body
        if body is None:
            raise EngineError("the engine moves nothing before the vehicle was powered on (place)")
        p, id_, number, zero = body.client.p, body.client.id, body.number, body.zero
        memory, body_at, wrench_at = self._memory, self._body_at, self._wrench_at
        ground, obstacles = self._ground, self._obstacles
        may_rest = _NO_STATE if body.has_hard_feet else GROUND_STANDING
        for _ in range(body.substeps):
            self._load()
            fx, fy, fz, mx, my, mz = _WRENCH.unpack_from(memory, wrench_at)
            p.applyExternalForce(number, BODY, (fx, -fy, -fz), _ORIGIN, _LINK_FRAME, id_)
            p.applyExternalTorque(number, BODY, (mx, -my, -mz), _LINK_FRAME, id_)
            p.stepSimulation(id_)
            (x, y, z), (qx, qy, qz, qw) = p.getBasePositionAndOrientation(number, id_)
            (vx, vy, vz), (ox, oy, oz) = p.getBaseVelocity(number, id_)
            roll, pitch, yaw = rotate(Quat(qw, -qx, -qy, -qz), Vec3(ox, oy, oz))  # from the world to the body
            links = ALL
            if ground.state == may_rest and abs(vx) + abs(vy) < _SLOW and z < zero + CLEAR:
                links = BODY  # its feet stand where they stood
            rows = p.getContactPoints(number, -1, links, ALL, id_)
            if rows or obstacles.touching or (links == ALL and ground.state != GROUND_AIRBORNE):
                before = _VELOCITY.unpack_from(memory, body_at + _VELOCITY_AT)
                numbers = (x, -y, zero - z, vx, -vy, -vz, qw, qx, -qy, -qz, roll, -pitch, -yaw)
                _BODY_NUMBERS.pack_into(memory, body_at, *numbers)
                if links == BODY:
                    rows = p.getContactPoints(number, -1, ALL, ALL, id_)
                self._touch(body, rows, before, (fx, fy, fz))
            else:
                _BODY_NUMBERS.pack_into(
                    memory, body_at, x, -y, zero - z, vx, -vy, -vz, qw, qx, -qy, -qz, roll, -pitch, -yaw
                )

    def _touch(self, body: CopterBody, rows: Sequence[Row], before: Sequence[float], force: Sequence[float]) -> None:
        """After a step with contacts, or the first without: what they mean, and what hard ones did to the velocity."""
        v = self.vehicle.v
        is_hard = contacts_report(v, body.surfaces, rows, before)
        if not (is_hard or (rows and body.has_hard_feet)):
            return
        b, motion, dt = v.physics.body, v.physics.motion, body.step_s
        gained = b.vel - Vec3(*before) - dt / body.model.mass * rotate(b.q, Vec3(*force))
        motion.contact += Vec3(gained.x, gained.y, gained.z - dt * GRAVITY)

    # ------------------------------------------------------------------ snapshots

    def snapshot(self) -> bytes:
        """See ``Engine``. A vehicle that has something near goes on as if it had been restored (``client.save``)."""
        saved = save(self.body.client)
        if self._is_near():
            self.restore(saved)
        return saved

    def restore(self, state_: bytes) -> None:
        body = self.body
        load(body.client, state_, body.number)

    def _is_near(self) -> bool:
        """Whether floor or solids are so near that Bullet may have something about them in mind."""
        body, world, a = self.body, self.vehicle.world, self.vehicle.v.physics.airframe
        position, _ = body.client.p.getBasePositionAndOrientation(body.number, body.client.id)
        north, east, down = position[0], -position[1], -position[2]
        reach = 1.5 * (math.hypot(float(a.contact_radius), float(a.contact_top)) + body.model.height) + _MARGIN
        if -down - body.surfaces.height < reach or body.keeps_contacts():
            return True
        if world is None:
            return False
        return clearance(world.geometry, north, east, down - reach, down + reach, reach).distance < 0.0

    # ------------------------------------------------------------------ the rest

    def cast(self, origin: Array, directions: Array, ranges: Array, reach: float) -> bool:
        worlds.cast(self.body.client, origin, directions, ranges, reach)
        return True

    def render(self, width: int, height: int, camera: Camera | None = None) -> Array:
        """A picture of it in its world, uint8, shape (height, width, 3); see ``Picture``."""
        text = self.body.model.text
        if self._picture is None:
            reach = float(self.vehicle.v.physics.airframe.contact_radius) or 0.3
            self._picture = Picture(
                lambda client: urdf.load(client, text), self.vehicle.world, self.vehicle.floor, reach
            )
        return self._picture.render(*self._pose(), width, height, camera)

    def _pose(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Position and attitude that the record says, in Bullet's frame."""
        b = self.vehicle.v.physics.body
        (north, east, down), (w, x, y, z) = b.pos, b.q
        return (north, -east, self.body.zero - down), (x, -y, -z, w)

    def close(self) -> None:
        if self._picture is not None:
            self._picture.close()
            self._picture = None
        if self._body is not None:
            self._body.close()
            self._body = None
