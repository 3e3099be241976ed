# SPDX-License-Identifier: BSD-3-Clause
"""A rover as a multibody of Bullet, built from the properties of its airframe.

A chassis, four wheels on axle joints, two steering joints in front. Tyres are spheres that touch the floor alone: a
sphere meets a plane in one exact point, so that a wheel rolls smoothly, while a cylinder's set of contact points
jumps about (and costs three times as much). Springs and dampers of the suspension act in that point (Bullet's contact
stiffness and damping, solved implicitly): the chassis heaves, pitches and rolls on them as on prismatic joints with
massless hubs; joints of their own would cost twice the time and show nothing else. Solids meet the outline of the
airframe, upright discs on the chassis without friction.

Body axes are Bullet's: forward, left, up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...core.constants import GRAVITY
from ...vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS, STEERING_SKID
from .client import Client
from .wheels import ALONG_Y, Parts, meet, touch_in_one_point
from .worlds import FLOOR_GROUP, SOLID_GROUP

WHEELS_SHARE = 80.0 / 882.0
"""Weight of all wheels by that of the vehicle: the paper's Erle-Rover's."""
BLOCK_SHARE = 1.0 / 882.0
"""The same of one steering block."""
SAG = 0.1
"""By which the vehicle's weight presses its springs together, by wheel radius."""
FASTEST = 1e4
"""Of a joint [rad/s]; Bullet's own limit of 100 is below what small wheels turn."""
ROTORS = 0.25
"""Inertia of skid steering's geared motors, as they appear at the rim, by the vehicle's mass."""
DAMPING = 0.6
"""Share of critical damping."""
LEAST_INERTIA = 0.2
"""Share of the vehicle's inertia that the chassis keeps at least when its wheels' is taken off."""


@dataclass(frozen=True)
class Layout:
    """Where the parts are, from the properties of an airframe; metres and kilograms."""

    wheelbase: float
    track: float
    radius: float
    """Of the wheels."""
    height: float
    """Of the centre of mass over the floor."""
    behind: float
    """From the rear axle forward to the centre of mass."""
    origin: float
    """The airframe's origin, where the IMU is, ahead of the centre of mass."""
    steers: bool
    """Front wheels steer and only rear ones are driven; else the wheels of each side are driven as one."""

    @property
    def sag(self) -> float:
        """By which springs are pressed together at rest [m]."""
        return SAG * self.radius

    @property
    def wheels(self) -> tuple[tuple[float, float], ...]:
        """Forward and left of the centre of mass [m]: front left, front right, rear left, rear right."""
        ahead, half = self.wheelbase - self.behind, 0.5 * self.track
        return ((ahead, half), (ahead, -half), (-self.behind, half), (-self.behind, -half))

    def load(self, wheel: int) -> float:
        """Share of the weight on a wheel, 0 .. 1."""
        front = self.behind / self.wheelbase
        return 0.5 * (front if wheel < 2 else 1.0 - front)


def layout(a: Any) -> Layout:
    """The layout that properties ``a`` of an airframe (``physics.airframe``) ask for.

    What wheels scrub with skid steering comes from their friction: on the spot the tyres' forces balance about the
    vertical when the yaw rate follows a track that is 1 + (wheelbase / track)^2 times as wide: hence the wheelbase.
    """
    model, track, wheelbase = int(a.steering_model), float(a.track), float(a.wheelbase)
    if model == STEERING_SKID:
        wheelbase = track * math.sqrt(max(float(a.track_slip) - 1.0, 0.1))
    elif wheelbase <= 0.0:
        wheelbase = track
    behind = wheelbase * (float(a.front_load) if model == STEERING_FRONT_WHEELS else 0.5)
    origin = float(a.rear_axle) - (0.0 if model == STEERING_SKID else behind)
    radius = float(a.wheel_radius) or wheelbase / 6.0
    height = float(a.centre_height) or 1.5 * radius
    return Layout(wheelbase, track, radius, height, behind, origin, model != STEERING_SKID)


@dataclass(frozen=True)
class Model:
    """The vehicle in Bullet."""

    layout: Layout
    body: int
    """Bullet's number of it."""
    height: float
    """Of the chassis' centre of mass over the floor at rest [m]."""
    rolling_mass: float
    """What resists acceleration when all wheels roll: the vehicle's mass and that of its wheels' spin [kg]."""
    stiffness: float
    """Of a wheel's spring when all carry the same [N/m]."""
    damping: float
    """[N/(m/s)]."""
    driven: tuple[int, ...]
    """Joints of the driven wheels: left and right in turn."""
    steering: tuple[int, ...]
    """Joints of left and right front wheel; none with skid steering."""
    joints: tuple[int, ...]
    """All joints that move."""


def build(client: Client, a: Any, floor: float) -> Model:
    """Put a rover into a world of Bullet, at its origin, nose to x, at rest on its springs.

    Args:
        client: the world.
        a: properties of the airframe, in a record.
        floor: its height in Bullet's frame [m].
    """
    p, id_, plan, mass = client.p, client.id, layout(a), float(a.mass)
    block = BLOCK_SHARE * mass if plan.steers else 0.0
    masses, height = [], 0.0
    for k in range(4):  # heavier where the lever is shorter: they balance about the centre of mass
        masses.append(WHEELS_SHARE * mass * plan.load(k))
    chassis = mass - sum(masses)
    height = (mass * plan.height - sum(masses) * plan.radius) / chassis
    parts = Parts(p)
    inertia = list(a.inertia)
    least = [LEAST_INERTIA * i for i in inertia]
    wheel = p.createCollisionShape(p.GEOM_SPHERE, radius=plan.radius, physicsClientId=id_)
    rim = p.createVisualShape(
        p.GEOM_CYLINDER, radius=plan.radius - plan.sag, length=0.5 * plan.radius, rgbaColor=(0.1, 0.1, 0.1, 1.0),
        physicsClientId=id_,
    )  # fmt: skip
    hub = plan.radius - plan.sag - height
    axles, steering = [], []
    for k, (x, y) in enumerate(plan.wheels):
        at, parent, own = (x, y, hub), 0, masses[k]
        if plan.steers and k < 2:
            parent = parts.add(block, -1, -1, at, 0, (0.0, 0.0, 0.0, 1.0))
            steering.append(parent - 1)
            at, own = (0.0, 0.0, 0.0), own - block
        axles.append(parts.add(own, wheel, rim, at, parent, ALONG_Y) - 1)
        inertia[0] -= masses[k] * (y * y + hub * hub)
        inertia[1] -= masses[k] * (x * x + hub * hub)
        inertia[2] -= masses[k] * (x * x + y * y)
    body = p.createMultiBody(
        chassis,
        _outline(client, a, height),
        _shell(client, a, plan, height),
        basePosition=(0.0, 0.0, floor + height),
        **parts.arguments(),
        physicsClientId=id_,
    )
    _settle(client, body, a, [max(i, j) for i, j in zip(inertia, least)], axles, steering)
    touch_in_one_point(client)
    driven = tuple(axles[2:]) if plan.steers else tuple(axles)
    pulse = math.sqrt(GRAVITY / plan.sag)
    rolling = (1.0 + 0.5 * WHEELS_SHARE) * mass
    springs = (0.25 * mass * pulse * pulse, 0.5 * DAMPING * mass * pulse)
    return Model(plan, body, height, rolling, *springs, driven, tuple(steering), tuple(sorted((*axles, *steering))))


def _outline(client: Client, a: Any, height: float) -> int:
    """Collision shape of the chassis: the airframe's discs."""
    p, count = client.p, int(a.contact_discs)
    top, bottom, offset = float(a.contact_top), float(a.contact_bottom), layout(a).origin
    if float(a.contact_radius) <= 0.0 or top + bottom <= 0.0:
        return -1
    shape: int = p.createCollisionShapeArray(
        shapeTypes=[p.GEOM_CYLINDER] * count,
        radii=[float(a.contact_radius)] * count,
        lengths=[top + bottom] * count,
        halfExtents=[(0.0, 0.0, 0.0)] * count,
        collisionFramePositions=[
            (float(a.contact_along[k]) + offset, 0.0, 0.5 * (top - bottom) - height) for k in range(count)
        ],
        collisionFrameOrientations=[(0.0, 0.0, 0.0, 1.0)] * count,
        physicsClientId=client.id,
    )
    return shape


def _shell(client: Client, a: Any, plan: Layout, height: float) -> int:
    """What is seen of the chassis: a box between the wheels."""
    p = client.p
    front, back = plan.wheelbase - plan.behind, -plan.behind
    half = (0.5 * (front - back) + 0.6 * plan.radius, 0.5 * plan.track - 0.3 * plan.radius, 0.5 * plan.radius)
    shape: int = p.createVisualShape(
        p.GEOM_BOX,
        halfExtents=half,
        rgbaColor=(0.8, 0.1, 0.1, 1.0),
        visualFramePosition=(0.5 * (front + back), 0.0, 1.6 * plan.radius - height),
        physicsClientId=client.id,
    )
    return shape


def _settle(
    client: Client, body: int, a: Any, inertia: list[float], axles: Sequence[int], steering: Sequence[int]
) -> None:
    """Inertia, springs, friction and who touches what; no joint resists."""
    p, id_, plan, mass, grip = client.p, client.id, layout(a), float(a.mass), float(a.grip)
    radius = plan.radius
    pulse = math.sqrt(GRAVITY / plan.sag)
    still = {"linearDamping": 0.0, "angularDamping": 0.0, "physicsClientId": id_}
    p.changeDynamics(body, -1, localInertiaDiagonal=inertia, lateralFriction=0.0, restitution=0.0, **still)
    meet(client, body, -1, SOLID_GROUP)
    for k, joint in enumerate(axles):
        weight, own = mass * plan.load(k), WHEELS_SHARE * mass * plan.load(k)
        disc = 0.25 * own * radius * radius
        spin = 2.0 * disc if plan.steers else 0.25 * ROTORS * mass * radius * radius
        p.changeDynamics(body, joint, maxJointVelocity=FASTEST, physicsClientId=id_)  # first: it upsets other settings
        p.changeDynamics(
            body,
            joint,
            localInertiaDiagonal=(disc, disc, spin),
            lateralFriction=grip if plan.steers else 0.0,
            restitution=0.0,
            contactStiffness=weight * pulse * pulse,
            contactDamping=2.0 * DAMPING * weight * pulse,
            jointDamping=0.0,
            **still,
        )
        meet(client, body, joint, FLOOR_GROUP)
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.0, force=0.0, physicsClientId=id_)
    for joint in steering:
        own = BLOCK_SHARE * mass * 0.1 * radius * radius
        p.changeDynamics(body, joint, localInertiaDiagonal=(own, own, own), jointDamping=0.0, **still)
