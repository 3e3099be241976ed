# SPDX-License-Identifier: BSD-3-Clause
"""A rover in Bullet: motors turn its wheels, tyres move it.

The common laws say how fast motors would let the wheels roll and how far the servo has turned the steering
(``physics.wheels``), from where they really are. Behind an open differential that becomes one torque for both driven
wheels; with skid steering a speed controller for each side. Ackermann's linkage turns the front wheels, so that both
roll about one centre. What tyres and walls leave of it is read back from the wheels.
"""

from __future__ import annotations

import math
import struct
from typing import Any, ClassVar

from ...core.constants import GRAVITY, TICK_S
from ...vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS
from ..engine import Array, Engine, EngineError, EngineVehicle, offset
from . import worlds
from .client import Client, forget, load, save
from .contacts import hits_report
from .picture import Camera, Picture
from .rover_model import Model, build
from .tyres import scrub_all
from .wheels import filter_by_both

RESERVE = 1.25
"""Strength of skid steering's motors by what accelerates the vehicle's weight: they turn themselves as well."""
_ITERATIONS, _RESIDUAL = 20, 1e-12
_LINKS = -2
"""Any link, of any body."""
_NOTHING = (0.0, 0.0, 0.0)
_WORLD_FRAME = 2
_COMMAND = struct.Struct("<3d")
"""angle, speed of ``physics.wheels``."""
_ROLLED = struct.Struct("<4d")
"""speed, distance of ``physics.wheels``."""
_FORWARD = struct.Struct("<d")
_BODY = struct.Struct("<13d")
"""pos, vel, q, rates of ``physics.body``."""
_LAST = struct.Struct("<20d")
"""What a tick leaves for the next."""


class BulletRover(Engine):
    """A rover of any airframe in a world of Bullet of its own.

    Raises:
        MissingExtra: pybullet is not installed.
    """

    name: ClassVar[str] = "pybullet"

    def __init__(self, vehicle: EngineVehicle) -> None:
        super().__init__(vehicle)
        self._memory: Any = vehicle.fleet.view("u1").data
        base = vehicle.index * vehicle.fleet.dtype.itemsize
        self._body_at = base + offset(vehicle.fleet.dtype, "physics", "body", "pos")
        self._command_at = base + offset(vehicle.fleet.dtype, "physics", "wheels", "angle")
        self._rolled_at = base + offset(vehicle.fleet.dtype, "physics", "wheels", "speed")
        self._forward_at = base + offset(vehicle.fleet.dtype, "physics", "wheels", "forward")
        self._client: Client | None = None
        self._picture: Picture | None = None
        self._airframe = b""

    # ------------------------------------------------------------------ the model

    def _fit(self) -> Client:
        """The world with a model of the vehicle as its properties are now."""
        a = self.vehicle.v.physics.airframe
        airframe = bytes(a._bytes)
        if self._client is None or airframe != self._airframe:
            self.close()
            self._airframe = airframe
            self._client = self._built(a)
        return self._client

    def _built(self, a: Any) -> Client:
        vehicle = self.vehicle
        client = Client(TICK_S, _ITERATIONS, _RESIDUAL)
        filter_by_both(client)
        self.surfaces = worlds.build(client, vehicle.world, vehicle.floor)
        self.model: Model = build(client, a, vehicle.floor)
        self._has_solids = bool(self.surfaces.solids)
        plan, mass = self.model.layout, float(a.mass)
        self._number, self._radius, self._is_car = self.model.body, plan.radius, plan.steers
        self._zero = vehicle.floor + self.model.height
        self._gain = TICK_S / mass
        self._measured = self.model.driven
        if plan.steers:
            self._lever = 0.5 * self.model.rolling_mass * plan.radius / TICK_S
            self._bends = int(a.steering_model) == STEERING_FRONT_WHEELS
            self._scale = float(vehicle.v.physics.derived.circle_scale)
            turn = mass * GRAVITY * plan.radius
            self._strength: dict[str, Any] = {"forces": [turn, turn], "positionGains": [1.0, 1.0]}
        else:
            self._friction = float(a.grip) * (1.0 if vehicle.world is None else float(vehicle.world.friction))
            pull = float(a.drive_accel) if a.drive_accel > 0.0 else self._friction * GRAVITY
            self._strength = {"forces": [0.25 * RESERVE * pull * mass * plan.radius] * 4}
        self._strength["physicsClientId"] = client.id
        self._as_built: int = client.p.saveState(client.id)
        self._rest()
        return client

    def _rest(self) -> None:
        """As after power-on, at the origin."""
        self._target: tuple[float, ...] = (math.nan,)
        self._state = (0.0, 0.0, self._zero, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0)
        self._spin = _NOTHING
        self._speeds = (0.0, 0.0, 0.0, 0.0)

    # ------------------------------------------------------------------ going on

    def place(self) -> None:
        client, b, p = self._fit(), self.vehicle.v.physics.body, self._fit().p
        (n, e, _), (w, x, y, z) = b.pos, b.q
        ahead = self.model.layout.origin
        c, s = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z)
        p.restoreState(self._as_built, physicsClientId=client.id)
        forget(client, self._number, self._zero)
        p.resetBasePositionAndOrientation(
            self._number, (n - ahead * c, ahead * s - e, self._zero), (x, -y, -z, w), client.id
        )
        p.resetBaseVelocity(self._number, _NOTHING, _NOTHING, client.id)
        self._rest()
        self._state = (n - ahead * c, ahead * s - e, *self._state[2:9], c, -s, 0.0, 1.0)

    def move(self) -> None:
        client = self._client
        if client is None:
            raise EngineError("the engine moves nothing before the vehicle was powered on (place)")
        if self._is_car:
            self._drive(client)
        else:
            self._skid(client)
        client.p.stepSimulation(client.id)
        self._read(client)

    def _drive(self, client: Client) -> None:
        """The same torque on both rear wheels; the steering, if it turns."""
        p, number, model = client.p, self._number, self.model
        angle, speed, _ = _COMMAND.unpack_from(self._memory, self._command_at)
        left, right, _, _ = self._speeds
        torque = self._lever * (speed - 0.5 * (left + right))
        p.setJointMotorControlArray(
            number, model.driven, p.TORQUE_CONTROL, forces=(torque, torque), physicsClientId=client.id
        )
        if angle != self._target[0]:
            self._target = (angle,)
            self._steer(client, angle)

    def _steer(self, client: Client, angle: float) -> None:
        p, plan = client.p, self.model.layout
        half, base = 0.5 * plan.track, plan.wheelbase
        bend = math.tan(angle) / base if self._bends else math.sin(angle) * self._scale
        angles = (-math.atan(base * bend / (1.0 + half * bend)), -math.atan(base * bend / (1.0 - half * bend)))
        p.setJointMotorControlArray(
            self._number, self.model.steering, p.POSITION_CONTROL, targetPositions=angles, **self._strength
        )

    def _skid(self, client: Client) -> None:
        """The speeds of the sides to their wheels, if they change; what the tyres' scrubbing does."""
        p, number, model, radius = client.p, self._number, self.model, self._radius
        _, left, right = _COMMAND.unpack_from(self._memory, self._command_at)
        if (left, right) != self._target:
            self._target = (left, right)
            rates = (left / radius, right / radius, left / radius, right / radius)
            p.setJointMotorControlArray(
                number, model.driven, p.VELOCITY_CONTROL, targetVelocities=rates, **self._strength
            )
        self._scrub(client)

    def _scrub(self, client: Client) -> None:
        """Forces of the tyres: all on the chassis, at the floor, and what they do to the wheels' spin.

        A torque at a joint turns the chassis the other way, which makes up for the lever from the hub to the floor.
        """
        p, number, model = client.p, self._number, self.model
        x, y, z, *_, c, s, _, _ = self._state
        fx, fy, turning, torques = scrub_all(model, self._state, self._zero, self._speeds, self._friction)
        nx, ny, above = c * fx - s * fy, s * fx + c * fy, z - self.surfaces.height
        p.applyExternalForce(number, -1, (nx, ny, 0.0), (x, y, z), _WORLD_FRAME, client.id)
        p.applyExternalTorque(number, -1, (above * ny, -above * nx, turning), _WORLD_FRAME, client.id)
        p.setJointMotorControlArray(number, model.driven, p.TORQUE_CONTROL, forces=torques, physicsClientId=client.id)

    def _read(self, client: Client) -> None:
        """Pose, velocities and wheels into the record."""
        p, id_, number, memory, radius = client.p, client.id, self._number, self._memory, self._radius
        (x, y, z), (qx, qy, qz, qw) = p.getBasePositionAndOrientation(number, id_)
        (vx, vy, vz), (ox, oy, oz) = p.getBaseVelocity(number, id_)
        joints = p.getJointStates(number, self._measured, id_)
        if self._has_solids:
            rows = p.getContactPoints(number, -1, -1, _LINKS, id_)
            if rows or self.vehicle.v.physics.obstacles.touching:
                before = self._state
                hits_report(self.vehicle.v, rows, before[:3], before[3:6], self._spin, self._gain)
        # Axes of the body, forward and left and up, in the world's frame.
        a, b, c = 1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy + qw * qz), 2.0 * (qx * qz - qw * qy)
        d, e, f = 2.0 * (qx * qy - qw * qz), 1.0 - 2.0 * (qx * qx + qz * qz), 2.0 * (qy * qz + qw * qx)
        g, h, k = 2.0 * (qx * qz + qw * qy), 2.0 * (qy * qz - qw * qx), 1.0 - 2.0 * (qx * qx + qy * qy)
        rolls, pitches, turns = a * ox + b * oy + c * oz, d * ox + e * oy + f * oz, g * ox + h * oy + k * oz
        self._spin = (ox, oy, oz)
        self._state = (x, y, z, vx, vy, vz, rolls, pitches, turns, a, b, c, f)
        forward = a * vx + b * vy + c * vz
        ahead = self.model.layout.origin
        if ahead != 0.0:
            x, y, z = x + ahead * a, y + ahead * b, z + ahead * c
            vx, vy, vz = (
                vx + ahead * (oy * c - oz * b), vy + ahead * (oz * a - ox * c), vz + ahead * (ox * b - oy * a)
            )  # fmt: skip
        _BODY.pack_into(
            memory, self._body_at, x, -y, self._zero - z, vx, -vy, -vz, qw, qx, -qy, -qz, rolls, -pitches, -turns
        )
        left, right = joints[-2], joints[-1]
        first, second = radius * left[1], radius * right[1]
        if self._is_car:
            self._speeds = (first, second, 0.0, 0.0)
            first = second = 0.5 * (first + second)
        else:
            self._speeds = (radius * joints[0][1], radius * joints[1][1], first, second)
        _ROLLED.pack_into(memory, self._rolled_at, first, second, radius * left[0], radius * right[0])
        _FORWARD.pack_into(memory, self._forward_at, forward)

    # ------------------------------------------------------------------ the rest

    def snapshot(self) -> bytes:
        """See ``Engine``. Among solids it goes on as if it had been restored (``client.save``)."""
        saved = _LAST.pack(*self._state, *self._spin, *self._speeds) + save(self._fit())
        if self._has_solids:
            self.restore(saved)
        return saved

    def restore(self, state_: bytes) -> None:
        load(self._fit(), state_[_LAST.size :], self._number, self._zero)
        last = _LAST.unpack_from(state_)
        self._state, self._spin, self._speeds = last[:13], last[13:16], last[16:]
        self._target = (math.nan,)

    def cast(self, origin: Array, directions: Array, ranges: Array, reach: float) -> bool:
        worlds.cast(self._fit(), origin, directions, ranges, reach)
        return True

    def render(self, width: int, height: int, camera: Camera | None = None) -> Array:
        """A picture of it in its world, uint8, shape (height, width, 3); see ``Picture``."""
        client, vehicle = self._fit(), self.vehicle
        if self._picture is None:
            a, reach = vehicle.v.physics.airframe, self.model.layout.wheelbase
            self._picture = Picture(lambda c: build(c, a, vehicle.floor).body, vehicle.world, vehicle.floor, reach)
        position, attitude = client.p.getBasePositionAndOrientation(self._number, client.id)
        joints = {k: client.p.getJointState(self._number, k, client.id)[0] for k in self.model.joints}
        return self._picture.render(position, attitude, width, height, camera, joints)

    def close(self) -> None:
        if self._picture is not None:
            self._picture.close()
            self._picture = None
        if self._client is not None:
            self._client.close()
            self._client = None
