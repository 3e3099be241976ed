# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter as a URDF model, made from its properties.

Frame: forward, left, up; the origin is the centre of mass. Two links: ``body`` has mass, inertia and the rigid outline
that runs into things; ``legs`` has a foot under each rotor, each on a spring and damper that take up a touch in the
airframe's ``leg_time_constant``, critically damped. The legs are as long as ``tip_angle`` asks for: at that lean the
centre of mass stands over the line between two feet. The outline reaches farther out than they do and keeps a vehicle
that leans more from falling over: it lands on its feet again from up to about a right angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...core.constants import GRAVITY
from .urdf import Contact, Vector, box, cylinder, document, link, sphere

FOOT_RADIUS = 0.01
"""[m]."""
_SHORTEST, _LONGEST = 0.03, 0.5
"""Height of the centre of mass over the feet [m]."""
_OUTLINE_FRICTION = 0.3
"""Coulomb coefficient of plastic hoods and rotor guards (assumed)."""
_ARM, _HUB = 0.012, 0.006
"""Half the width of an arm, half the height of a rotor's disc [m]."""
_LOOK = {
    "body": (0.15, 0.15, 0.17, 1.0),
    "arm": (0.30, 0.30, 0.33, 1.0),
    "front": (0.90, 0.25, 0.15, 0.9),
    "back": (0.20, 0.20, 0.20, 0.9),
    "foot": (0.10, 0.10, 0.10, 1.0),
}


@dataclass(frozen=True)
class CopterModel:
    """What the engine has to know of a model."""

    text: str
    """URDF."""
    mass: float
    """[kg]."""
    inertia: Vector
    """About forward, left, up [kg m^2]. An airframe's published properties need not be those of a real body, which URDF
    readers insist on, so that they are set after reading."""
    height: float
    """Of the centre of mass over the soles of unloaded legs [m]."""


def model(airframe: Any) -> CopterModel:
    """The model of an airframe.

    Args:
        airframe: properties of a copter: the record ``physics.airframe`` (``sitl.vehicles.properties.multicopter``).
    """
    hubs = [
        (float(airframe.rotor_x[k]), -float(airframe.rotor_y[k]), -float(airframe.rotor_z[k]))
        for k in range(int(airframe.rotor_count))
    ]
    feet = footing(hubs, float(airframe.contact_radius))
    height = leg_length(feet, float(airframe.tip_angle))
    mass = float(airframe.mass)
    inertia = (airframe.inertia.x, airframe.inertia.y, airframe.inertia.z)
    outline = _outline(airframe, height)
    body = link("body", mass, inertia, outline, _looks(airframe, hubs, height), Contact(_OUTLINE_FRICTION))
    soles = [sphere(FOOT_RADIUS, (x, y, FOOT_RADIUS - height)) for x, y in feet]
    contact = Contact(float(airframe.ground_friction), *springs(mass, float(airframe.leg_time_constant), len(feet)))
    legs = link("legs", 0.0, (0.0, 0.0, 0.0), soles, [sole.coloured(_LOOK["foot"]) for sole in soles], contact)
    return CopterModel(document("copter", [body, legs], [("body", "legs")]), mass, inertia, height)


def footing(hubs: list[Vector], radius: float) -> list[tuple[float, float]]:
    """Where the feet are, forward and left [m]: under the rotors, or at the corners of a square when those are too few
    to stand on."""
    if len(hubs) >= 3:
        return [(x, y) for x, y, _ in hubs]
    reach = max(0.5 * radius, 0.05)
    return [(reach, reach), (-reach, reach), (-reach, -reach), (reach, -reach)]


def leg_length(feet: list[tuple[float, float]], tip_angle: float) -> float:
    """Height of the centre of mass over the ground [m] at which it tips over at a lean of ``tip_angle`` [rad]."""
    around = sorted(feet, key=lambda foot: math.atan2(foot[1], foot[0]))
    edge = math.inf  # distance of the centre from the nearest line between neighbours
    for (x, y), (next_x, next_y) in zip(around, [*around[1:], around[0]], strict=True):
        length = math.hypot(next_x - x, next_y - y)
        if length > 1e-9:
            edge = min(edge, abs(x * next_y - y * next_x) / length)
    if not edge < math.inf or tip_angle <= 0.0:
        return _LONGEST
    slope = math.tan(tip_angle) if tip_angle < 0.5 * math.pi else math.inf
    return min(max(edge / slope, _SHORTEST), _LONGEST)


def springs(mass: float, time_constant: float, count: int) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N s/m] of each of ``count`` feet, critically damped; zeros: hard feet."""
    if time_constant <= 1e-4:
        return 0.0, 0.0
    natural = 1.0 / time_constant
    return mass * natural * natural / count, 2.0 * mass * natural / count


def sag(time_constant: float) -> float:
    """How far the weight presses the legs in [m]."""
    return GRAVITY * time_constant * time_constant if time_constant > 1e-4 else 0.0


def _outline(airframe: Any, height: float) -> list[Any]:
    """Upright cylinders that run into things: ``contact_*``, whose heights count from the soles, from the centre of
    mass up: what is lower is legs."""
    radius = float(airframe.contact_radius)
    top = max(float(airframe.contact_top) - height, 0.02)
    if radius <= 0.0:
        return []
    along = [float(airframe.contact_along[k]) for k in range(int(airframe.contact_discs))]
    return [cylinder(radius, top, (x, 0.0, 0.5 * top)) for x in along]


def _looks(airframe: Any, hubs: list[Vector], height: float) -> list[Any]:
    """What is to be seen of it and nothing else: a hull, arms, discs of rotors (the front ones red), legs."""
    reach = max((math.hypot(x, y) for x, y, _ in hubs), default=0.1)
    hull = box((0.55 * reach, 0.4 * reach, 0.25 * reach), (0.0, 0.0, 0.0)).coloured(_LOOK["body"])
    parts = [hull]
    neighbours = [math.dist(a, b) for a in hubs for b in hubs if a is not b]
    blade = min(0.48 * min(neighbours, default=2.0 * reach), max(float(airframe.contact_radius) - reach, 0.3 * reach))
    for x, y, z in hubs:
        arm = box((math.hypot(x, y), 2.0 * _ARM, _ARM), (0.5 * x, 0.5 * y, 0.5 * z), math.atan2(y, x))
        leg = box((_ARM, _ARM, height), (x, y, -0.5 * height))
        colour = _LOOK["front"] if x > 0.2 * reach else _LOOK["back"]
        disc = cylinder(blade, 2.0 * _HUB, (x, y, z))
        parts += [arm.coloured(_LOOK["arm"]), leg.coloured(_LOOK["arm"]), disc.coloured(colour)]
    return parts
