# SPDX-License-Identifier: BSD-3-Clause
"""What stands still in the scene: ground with a scale, solids of the world, what is painted on its floor."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...worlds import World
from ...worlds.shapes import Box, Cylinder
from ..axes import about
from ..shape import box, cylinder

_WALL = (186, 158, 122)
_POST = (128, 148, 160)
_PLAIN_GROUND, _FLOOR = (214, 219, 208), (222, 222, 226)


def draw(scene: Any, world: World | None) -> None:
    """Draw the ground and a world below "/stage". A cell of the ground is 1 m wide, a section 10 m."""
    floor = 0.0 if world is None else world.floor_z
    scene.add_grid(
        "/stage/ground", plane="xy", infinite_grid=True, cell_size=1.0, section_size=10.0, cell_thickness=0.6,
        section_thickness=1.0, cell_color=(176, 184, 172), section_color=(150, 158, 148), fade_distance=250.0,
        position=(0.0, 0.0, floor - 0.005), plane_color=_PLAIN_GROUND if world is None else _FLOOR, plane_opacity=1.0,
        shadow_opacity=0.2,
    )  # fmt: skip
    if world is not None:
        _draw_boxes(scene, [solid for solid in world.solids if isinstance(solid, Box)])
        _draw_cylinders(scene, [solid for solid in world.solids if isinstance(solid, Cylinder)])
        _draw_markings(scene, world)


def _draw_boxes(scene: Any, solids: list[Box]) -> None:
    if not solids:
        return
    unit = box((1.0, 1.0, 1.0))
    scene.add_batched_meshes_simple(
        "/stage/world/boxes", unit.vertices, unit.faces,
        batched_wxyzs=np.array([about(2, solid.yaw) for solid in solids]),
        batched_positions=np.array([solid.centre for solid in solids]),
        batched_scales=np.array([solid.size for solid in solids], np.float32),
        batched_colors=_WALL, lod="off", flat_shading=True,
    )  # fmt: skip


def _draw_cylinders(scene: Any, solids: list[Cylinder]) -> None:
    if not solids:
        return
    unit = cylinder(1.0, 1.0, corners=32)
    scene.add_batched_meshes_simple(
        "/stage/world/cylinders", unit.vertices, unit.faces,
        batched_wxyzs=np.tile([1.0, 0.0, 0.0, 0.0], (len(solids), 1)),
        batched_positions=np.array([solid.centre for solid in solids]),
        batched_scales=np.array([(solid.radius, solid.radius, solid.height) for solid in solids], np.float32),
        batched_colors=_POST, lod="off",
    )  # fmt: skip


def _draw_markings(scene: Any, world: World) -> None:
    for k, marking in enumerate(world.markings):
        corners = marking.footprint()
        height = np.full(len(corners), world.floor_z + 0.01 + 0.002 * k)
        vertices = np.column_stack([corners, height]).astype(np.float32)
        fan = np.array([(0, j, j + 1) for j in range(1, len(corners) - 1)], np.uint32)
        scene.add_mesh_simple(
            f"/stage/world/marking{k}", vertices, fan, color=_named(marking.colour), side="double", cast_shadow=False
        )


def _named(colour: str) -> tuple[int, int, int]:
    known = {
        "black": (30, 30, 30), "white": (245, 245, 245), "grey": (140, 140, 140), "gray": (140, 140, 140),
        "red": (200, 60, 50), "green": (60, 160, 80), "blue": (50, 100, 190), "yellow": (240, 200, 40),
        "orange": (240, 140, 40),
    }  # fmt: skip
    return known.get(colour, (140, 140, 140))
