# SPDX-License-Identifier: BSD-3-Clause
"""A rover on the page: chassis and wheels where its airframe has them."""

from __future__ import annotations

from typing import Any

from ..core.vectors import Vec3
from ..vehicles.properties.ground_vehicle import STEERING_SKID
from .kind import KindView, Motion
from .shape import BLADE, DARK, FRONT, GREY, REAR, WHEEL, Piece, Shape, box, cylinder, joined

_RECENT = 2
"""Periods of the controllers."""


def shape(airframe: Any) -> Shape:
    """Chassis, mast and four wheels; what is in front is red. The origin is on
    the floor, ``rear_axle`` ahead of the rear axle."""
    track = float(airframe.track)
    base = float(airframe.wheelbase) or 1.2 * track
    radius = float(airframe.wheel_radius) or base / 6.0
    rear = -float(airframe.rear_axle) if airframe.rear_axle != 0.0 else -0.5 * base
    front, middle, width = rear + base, rear + 0.5 * base, 0.45 * radius
    deck = 1.7 * radius
    body = box((1.25 * base, 0.7 * track, 0.7 * radius), (middle, 0.0, deck))
    cabin = box((0.5 * base, 0.55 * track, 0.8 * radius), (middle - 0.15 * base, 0.0, deck + 0.7 * radius))
    nose = box((0.12 * base, 0.7 * track, 0.6 * radius), (middle + 0.68 * base, 0.0, deck))
    pieces = [Piece("chassis", body, REAR), Piece("cabin", cabin, DARK), Piece("nose", nose, FRONT)]
    if airframe.lidar_samples > 0:
        at = airframe.lidar_at
        lidar = (float(at.x), -float(at.y), -float(at.z))
        pieces.append(Piece("lidar", cylinder(0.35 * radius, 0.4 * radius), BLADE, lidar))
    wheel = joined(cylinder(radius, width, axis=1, corners=24), box((1.5 * radius, 1.1 * width, 0.2 * radius)))
    steers = airframe.steering_model != STEERING_SKID
    for name, x, is_front in (("front", front, True), ("rear", rear, False)):
        for side, word in ((0, "left"), (1, "right")):
            at_wheel = (x, (0.5 - side) * track, radius)
            colour, turns = BLADE if is_front else GREY, steers and is_front
            pieces.append(Piece(f"{name}_{word}", wheel, colour, at_wheel, WHEEL, side, turns, radius))
    return Shape(tuple(pieces), 1.4 * base)


def motion(v: Any) -> Motion:
    """Steering, and how far the wheels have rolled."""
    wheels = v.physics.wheels
    return Motion(steering=float(wheels.angle), rolled=(float(wheels.distance.x), float(wheels.distance.y)))


def set_point(v: Any) -> Vec3 | None:
    """What the position controller follows, while it is at work."""
    control = v.autopilot.control
    position = control.position
    if position.last_tick == 0 or control.tick + 1 - position.last_tick > _RECENT:
        return None
    return Vec3(position.pos_target.x, position.pos_target.y, v.autopilot.estimate.pos.z)


VIEW = KindView(shape, motion, set_point)
