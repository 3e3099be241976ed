# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter on the page: arms and rotors where its airframe has them."""

from __future__ import annotations

import math
from typing import Any

from ..core.vectors import Vec3
from ..vehicles.properties.multicopter import THRUST_MOMENTUM
from .kind import KindView, Motion
from .shape import BLADE, DARK, FRONT, GREY, REAR, ROTOR, Piece, Shape, box, cylinder, joined, moved

_SHOWN_SPEED = 600.0
"""Speed at full command of rotors whose model has none [rad/s]."""


def shape(airframe: Any) -> Shape:
    """Body, legs, an arm and a rotor for each hub; what is in front is red."""
    hubs = [(airframe.rotor_x[k], -airframe.rotor_y[k], -airframe.rotor_z[k]) for k in range(int(airframe.rotor_count))]
    reach = max([math.hypot(x, y) for x, y, _ in hubs] + [0.1])
    gaps = [math.dist(a[:2], b[:2]) for k, a in enumerate(hubs) for b in hubs[:k] if math.dist(a[:2], b[:2]) > 0.01]
    blade = min([0.45 * gap for gap in gaps] + [0.75 * reach])
    wide, high = 0.5 * reach, 0.2 * reach
    stand = 0.6 * reach  # the origin is on the ground when the legs are
    hubs = [(x, y, z + stand) for x, y, z in hubs]
    pieces = [
        Piece("body", box((1.4 * wide, wide, high), (0.0, 0.0, stand)), DARK),
        Piece("top", box((0.9 * wide, 0.6 * wide, 0.6 * high), (-0.1 * wide, 0.0, stand + 0.7 * high)), GREY),
        Piece("nose", box((0.3 * wide, 0.5 * wide, 0.7 * high), (0.8 * wide, 0.0, stand)), FRONT),
    ]
    for k, (x, y, z) in enumerate(hubs):
        length, heading = math.hypot(x, y), math.atan2(y, x)
        colour = FRONT if x > 0.2 * reach else REAR
        middle = (0.5 * x, 0.5 * y, 0.5 * (z + stand))
        pieces.append(Piece(f"arm{k + 1}", box((length, 0.09 * reach, 0.07 * reach), middle, heading), colour))
        motor = moved(cylinder(0.11 * reach, 0.18 * reach), x, y, z - 0.05 * reach)
        pieces.append(Piece(f"motor{k + 1}", motor, DARK))
        blades = joined(box((2.0 * blade, 0.13 * blade, 0.02 * reach)), cylinder(0.05 * reach, 0.08 * reach))
        top = (x, y, z + 0.07 * reach)
        pieces.append(Piece(f"rotor{k + 1}", blades, BLADE, top, ROTOR, k))
        disc = cylinder(blade, 0.006 * reach, corners=32)
        pieces.append(Piece(f"disc{k + 1}", disc, colour, top, opacity=0.18))
    legs = joined(*(
        joined(
            box((0.05 * reach, 0.05 * reach, 0.5 * reach), (x, y, 0.3 * reach)),
            box((0.3 * reach, 0.06 * reach, 0.05 * reach), (x, y, 0.03 * reach)),
        )
        for x in (-0.4 * wide, 0.4 * wide) for y in (-0.7 * wide, 0.7 * wide)
    ))  # fmt: skip
    pieces.append(Piece("legs", legs, GREY))
    return Shape(tuple(pieces), 2.0 * (reach + blade))


def motion(v: Any) -> Motion:
    """Speeds of the rotors, and how it has landed."""
    airframe, rotors, ground = v.physics.airframe, v.physics.rotors, v.physics.ground
    scale = _SHOWN_SPEED if airframe.thrust_model == THRUST_MOMENTUM else 1.0
    count = int(airframe.rotor_count)
    speeds = tuple(scale * float(rotors.speed[k] * airframe.rotor_direction[k]) for k in range(count))
    return Motion(speeds, ground_hits=(int(ground.hit_count), float(ground.hit_speed), int(ground.hit_time_us)))


def set_point(v: Any) -> Vec3 | None:
    """The shaped path of the position controller, while it is at work."""
    control = v.autopilot.control
    if control.tick == 0 or control.tick - control.pos_ne.last_tick > 1:
        return None
    plane = control.pos_ne.pos_desired
    return Vec3(plane.x, plane.y, control.pos_d.pos_desired)


VIEW = KindView(shape, motion, set_point)
