# SPDX-License-Identifier: BSD-3-Clause
"""Many vehicles in the scene, drawn by instancing: all of one shape are one node, whose positions are sent together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..axes import all_to_scene, turns
from ..colours import of_ends, of_vehicle
from ..frame import Company
from ..shape import DARK, FRONT, Mesh, Piece, Shape, joined, moved, painted

LABELLED = 32
"""Up to so many have their numbers above them."""
_FEW = 64
"""Up to so many are drawn with all of their pieces."""


class CompanyNodes:
    """The nodes of several vehicles.

    Args:
        scene: of the page.
        shapes: of each vehicle.
    """

    def __init__(self, scene: Any, shapes: Sequence[Shape]) -> None:
        self.count = len(shapes)
        rows: dict[int, list[int]] = {}
        for number, shape in enumerate(shapes):
            rows.setdefault(id(shape), []).append(number)
        self._groups = []
        own = of_ends([of_vehicle(number) for number in range(self.count)])
        for number, which in enumerate(rows.values()):
            shape = shapes[which[0]]
            for k, (colour, mesh) in enumerate(by_colour(shape, is_plain=self.count > _FEW)):
                still = np.tile([1.0, 0.0, 0.0, 0.0], (len(which), 1))
                colours = own[which] if colour == painted(shape) else of_ends([colour])[0]
                node = scene.add_batched_meshes_simple(
                    f"/stage/company/{number}_{k}", mesh.vertices, mesh.faces, batched_wxyzs=still,
                    batched_positions=np.zeros((len(which), 3), np.float32), batched_colors=colours,
                    lod="off", flat_shading=True, cast_shadow=self.count <= _FEW, side="double",
                )  # fmt: skip
                self._groups.append((node, np.array(which)))
        self.labels = [
            scene.add_label(f"/stage/company/label{k + 1}", str(k + 1), anchor="bottom-center", font_screen_scale=0.9)
            for k in range(self.count if self.count <= LABELLED else 0)
        ]
        """Number of each, counted from 1; none where there are too many."""
        self._above = [0.5 * shape.size for shape in shapes[: len(self.labels)]]

    @property
    def nodes(self) -> list[tuple[Any, npt.NDArray[np.int64]]]:
        """Nodes, with the numbers of the vehicles that each draws."""
        return self._groups

    def show(self, company: Company) -> None:
        """Draw a moment."""
        at, q = all_to_scene(company.pos).astype(np.float32), turns(company.q).astype(np.float32)
        for node, which in self._groups:
            node.batched_positions, node.batched_wxyzs = at[which], q[which]
        for label, (x, y, z), above in zip(self.labels, at[: len(self.labels)].tolist(), self._above, strict=True):
            label.position = (x, y, z + above)


def by_colour(shape: Shape, is_plain: bool = False) -> list[tuple[tuple[int, int, int], Mesh]]:
    """A shape's pieces as one mesh for each colour, in their places; what turns stands still.

    Args:
        shape: of a vehicle.
        is_plain: leave out all but its greatest pieces, and draw the discs of rotors by few triangles: a fifth of all.
    """
    pieces = [piece for piece in shape.pieces if piece.opacity == 1.0]
    meshes: dict[tuple[int, int, int], list[Mesh]] = {}
    if is_plain:
        for piece in shape.pieces:
            if piece.opacity < 1.0:
                colour = piece.colour if piece.colour == FRONT else DARK  # light ones are not seen from far away
                meshes.setdefault(colour, []).append(moved(_disc(piece.mesh), *piece.at))
        pieces = sorted(pieces, key=_size, reverse=True)
        pieces = [piece for piece in pieces if len(piece.mesh.faces) <= 24][:8] or pieces[:4]
    for piece in pieces:
        meshes.setdefault(piece.colour, []).append(moved(piece.mesh, *piece.at))
    return [(colour, joined(*each)) for colour, each in meshes.items()]


def _disc(mesh: Mesh) -> Mesh:
    """A flat octagon of the same width."""
    turn = np.arange(8) * (np.pi / 4)
    rim = 0.5 * np.ptp(mesh.vertices[:, 0]) * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(8)])
    faces = [(0, j, j + 1) for j in range(1, 7)]
    return Mesh(rim.astype(np.float32), np.array(faces, np.uint32))


def _size(piece: Piece) -> float:
    return float(np.ptp(piece.mesh.vertices, axis=0).prod())
