# SPDX-License-Identifier: BSD-3-Clause
"""What stands still in the scene: ground with a scale, solids of the world, what is painted on its floor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...worlds import World
from ...worlds.shapes import Box, Cylinder
from ..axes import about
from ..frame import Points
from ..shape import Mesh, box, cylinder

_WALL = (186, 158, 122)
_POST = (128, 148, 160)
_PLAIN_GROUND, _FLOOR = (214, 219, 208), (222, 222, 226)


_MOST = 20_000
"""Solids that are drawn: of more copies of a world, the first ones have theirs."""


def draw(scene: Any, world: World | None, copies: Points | None = None) -> Any:
    """Draw the ground and a world below "/stage"; returns the node that all solids are on.

    A cell of the ground is 1 m wide, a section 10 m.

    Args:
        scene: of the page.
        world: None: a plain.
        copies: positions at which the world stands, shape (n, 3) [m]; None: once, at the origin.
    """
    floor = 0.0 if world is None else world.floor_z
    scene.add_grid(
        "/stage/ground", plane="xy", infinite_grid=True, cell_size=1.0, section_size=10.0, cell_thickness=0.6,
        section_thickness=1.0, cell_color=(176, 184, 172), section_color=(150, 158, 148), fade_distance=250.0,
        position=(0.0, 0.0, floor - 0.005), plane_color=_PLAIN_GROUND if world is None else _FLOOR, plane_opacity=1.0,
        shadow_opacity=0.2,
    )  # fmt: skip
    node = scene.add_frame("/stage/world", show_axes=False)
    if world is not None:
        at = np.zeros((1, 3)) if copies is None else copies[: max(_MOST // max(len(world.solids), 1), 1)]
        _draw_boxes(scene, [solid for solid in world.solids if isinstance(solid, Box)], at)
        _draw_cylinders(scene, [solid for solid in world.solids if isinstance(solid, Cylinder)], at)
        _draw_markings(scene, world, at)
    return node


def _draw_boxes(scene: Any, solids: list[Box], copies: Points) -> None:
    if solids:
        turned, sizes = [about(2, solid.yaw) for solid in solids], [solid.size for solid in solids]
        _draw_solids(scene, "boxes", box((1.0, 1.0, 1.0)), solids, turned, sizes, copies, _WALL, True)


def _draw_cylinders(scene: Any, solids: list[Cylinder], copies: Points) -> None:
    if solids:
        turned = [(1.0, 0.0, 0.0, 0.0)] * len(solids)
        sizes = [(solid.radius, solid.radius, solid.height) for solid in solids]
        _draw_solids(scene, "cylinders", cylinder(1.0, 1.0, corners=32), solids, turned, sizes, copies, _POST, False)


def _draw_solids(
    scene: Any, name: str, unit: Mesh, solids: Sequence[Box | Cylinder], turned: Any, sizes: Any, copies: Points,
    colour: tuple[int, int, int], flat: bool,
) -> None:  # fmt: skip
    """All solids of one form as one node."""
    n = len(copies)
    centres = np.array([solid.centre for solid in solids])
    scene.add_batched_meshes_simple(
        f"/stage/world/{name}", unit.vertices, unit.faces,
        batched_wxyzs=np.tile(turned, (n, 1)),
        batched_positions=(copies[:, None] + centres).reshape(-1, 3),
        batched_scales=np.tile(np.array(sizes, np.float32), (n, 1)),
        batched_colors=colour, lod="off", flat_shading=flat,
    )  # fmt: skip


def _draw_markings(scene: Any, world: World, copies: Points) -> None:
    for k, marking in enumerate(world.markings):
        corners = marking.footprint()
        height = np.full(len(corners), world.floor_z + 0.01 + 0.002 * k)
        flat = np.column_stack([corners, height])
        fan = np.array([(0, j, j + 1) for j in range(1, len(corners) - 1)], np.uint32)
        vertices = (copies[:, None] + flat).reshape(-1, 3).astype(np.float32)
        faces = (fan[None] + len(corners) * np.arange(len(copies), dtype=np.uint32)[:, None, None]).reshape(-1, 3)
        scene.add_mesh_simple(
            f"/stage/world/marking{k}", vertices, faces, color=_named(marking.colour), side="double", cast_shadow=False
        )


def _named(colour: str) -> tuple[int, int, int]:
    known = {
        "black": (30, 30, 30), "white": (245, 245, 245), "grey": (140, 140, 140), "gray": (140, 140, 140),
        "red": (200, 60, 50), "green": (60, 160, 80), "blue": (50, 100, 190), "yellow": (240, 200, 40),
        "orange": (240, 140, 40),
    }  # fmt: skip
    return known.get(colour, (140, 140, 140))
