# SPDX-License-Identifier: BSD-3-Clause
"""A Turtlebot on the page: base, plates on posts, lidar, where its airframe has them."""

from __future__ import annotations

from ..vehicles.airframe import Airframe
from .shape import BLADE, DARK, FRONT, GREY, Piece, Shape, box, cylinder, joined, moved


def shape(airframe: Airframe) -> Shape:
    """Its shape; the origin is on the floor."""
    radius, top = float(airframe.value("radius")), float(airframe.value("top"))
    bottom = float(airframe.value("bottom"))
    base = 0.25 * top
    plate, post = 0.012 * top, 0.025 * radius
    plates = joined(*(moved(cylinder(0.9 * radius, plate), 0.0, 0.0, at * top) for at in (0.42, 0.62, 0.82)))
    posts = joined(*(
        box((post, post, 0.82 * top - base), (x * radius, y * radius, 0.5 * (0.82 * top + base)))
        for x, y in ((0.6, 0.5), (0.6, -0.5), (-0.6, 0.5), (-0.6, -0.5))
    ))  # fmt: skip
    lidar = (float(airframe.value("lidar_ahead")), 0.0, float(airframe.value("lidar_height")))
    pieces = (
        Piece("base", moved(cylinder(radius, base - bottom, corners=32), 0.0, 0.0, 0.5 * (base + bottom)), DARK),
        Piece("plates", plates, BLADE),
        Piece("posts", posts, GREY),
        Piece("nose", box((0.25 * radius, 0.8 * radius, 0.4 * base), (0.9 * radius, 0.0, 0.6 * base)), FRONT),
        Piece("lidar", cylinder(0.2 * radius, 0.1 * top), DARK, lidar),
    )
    return Shape(pieces, 2.5 * radius)
