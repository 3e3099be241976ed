# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle looks like: pieces on its body, some of which turn. Axes of a shape: forward, left, up; metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Vertices = npt.NDArray[np.float32]
Faces = npt.NDArray[np.uint32]
Colour = tuple[int, int, int]

DARK: Colour = (45, 48, 54)
GREY: Colour = (120, 126, 135)
FRONT: Colour = (214, 74, 56)
REAR: Colour = (225, 228, 232)
BLADE: Colour = (30, 32, 36)

ROTOR, WHEEL = "rotor", "wheel"


class Mesh(NamedTuple):
    """Triangles."""

    vertices: Vertices
    """Shape (n, 3) [m]."""
    faces: Faces
    """Shape (m, 3): numbers of vertices, counter-clockwise seen from outside."""


class Piece(NamedTuple):
    """A part of a vehicle."""

    name: str
    mesh: Mesh
    colour: Colour
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Its position on the body [m]; it turns about that."""
    turns: str = ""
    """ROTOR: about its vertical with rotor ``number``; WHEEL: rolls; "": it is fixed."""
    number: int = 0
    """Of the rotor, or the side of the wheel: 0 left, 1 right."""
    steers: bool = False
    radius: float = 0.0
    """Of a wheel [m]."""
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Shape:
    """A vehicle."""

    pieces: tuple[Piece, ...]
    size: float
    """About its greatest extent [m]."""


def box(size: Sequence[float], at: Sequence[float] = (0.0, 0.0, 0.0), heading: float = 0.0) -> Mesh:
    """A box by its full lengths [m], around ``at``, turned left by ``heading`` [rad]."""
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * np.asarray(size)
    c, s = np.cos(heading), np.sin(heading)
    turned = np.stack([c * corners[:, 0] - s * corners[:, 1], s * corners[:, 0] + c * corners[:, 1], corners[:, 2]], 1)
    faces = [
        (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
        (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
    ]  # fmt: skip
    return Mesh((turned + np.asarray(at)).astype(np.float32), np.array(faces, np.uint32))


def cylinder(radius: float, height: float, axis: int = 2, corners: int = 20, top: float = 1.0) -> Mesh:
    """A cylinder around the origin, along an axis 0, 1 or 2 [m]; ``top``: radius of its upper end by the lower's."""
    angles = np.arange(corners) * (2.0 * np.pi / corners)
    ring = np.stack([np.cos(angles), np.sin(angles)], 1) * radius
    low = np.column_stack([ring, np.full(corners, -0.5 * height)])
    high = np.column_stack([ring * top, np.full(corners, 0.5 * height)])
    ends = [[0.0, 0.0, -0.5 * height], [0.0, 0.0, 0.5 * height]]
    vertices = np.concatenate([low, high, ends])
    k = np.arange(corners)
    after, bottom, upper = (k + 1) % corners, 2 * corners, 2 * corners + 1
    faces = np.concatenate([
        np.stack([k, after, corners + after], 1), np.stack([k, corners + after, corners + k], 1),
        np.stack([after, k, np.full(corners, bottom)], 1),
        np.stack([corners + k, corners + after, np.full(corners, upper)], 1),
    ])  # fmt: skip
    return Mesh(np.roll(vertices, axis + 1, axis=1).astype(np.float32), faces.astype(np.uint32))


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes[:-1])])
    faces = [mesh.faces + np.uint32(start) for mesh, start in zip(meshes, starts, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def moved(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    """A mesh elsewhere [m]."""
    return Mesh(mesh.vertices + np.array([x, y, z], np.float32), mesh.faces)


def painted(shape: Shape) -> Colour:
    """The colour of a shape that stands for the vehicle's own: that of its rear, else of its greatest piece."""
    solid = [piece for piece in shape.pieces if piece.opacity == 1.0]
    if any(piece.colour == REAR for piece in solid):
        return REAR
    return max(solid, key=lambda piece: float(np.ptp(piece.mesh.vertices, axis=0).prod())).colour


def tinted(shape: Shape, colour: Colour) -> Shape:
    """A shape in another vehicle's colour."""
    own = painted(shape)
    pieces = (piece._replace(colour=colour) if piece.colour == own else piece for piece in shape.pieces)
    return Shape(tuple(pieces), shape.size)


def plain(length: float, width: float, height: float) -> Shape:
    """A box with a nose, for a vehicle of which nothing more is known."""
    body = Piece("body", box((length, width, height), (0.0, 0.0, 0.0)), GREY)
    nose = Piece("nose", box((0.25 * length, 0.4 * width, 0.5 * height), (0.6 * length, 0.0, 0.0)), FRONT)
    return Shape((body, nose), max(length, width))
