# SPDX-License-Identifier: BSD-3-Clause
"""The mission with the leg under way, home, fences and rally points in the scene."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..axes import to_scene
from ..frame import Frame, Mark, Plan, Points
from ..shape import cylinder

_PATH, _LEG, _FENCE, _RALLY, _HOME = (120, 120, 130), (240, 150, 20), (214, 48, 49), (22, 160, 133), (40, 40, 48)


class PlanNodes:
    """The nodes of what a vehicle is to do.

    Args:
        scene: of the page.
        size: of the vehicle [m].
    """

    def __init__(self, scene: Any, size: float) -> None:
        self._scene, self._size = scene, size
        self._nodes: list[Any] = []
        self._shown: Plan = Plan()
        none = np.zeros((0, 2, 3), np.float32)
        self.leg = scene.add_line_segments("/stage/plan/leg", none, _LEG, thickness=0.06 * size)
        self._leg: object = None
        disc = cylinder(0.35 * size, 0.01 * size, corners=32)
        self.home = scene.add_mesh_simple(
            "/stage/plan/home", disc.vertices, disc.faces, color=_HOME, opacity=0.6, visible=False
        )
        self._home_label = scene.add_label("/stage/plan/home/label", "home", anchor="top-center", font_screen_scale=0.8)

    def show(self, frame: Frame) -> None:
        """Draw a moment."""
        self.home.visible = frame.home is not None
        if frame.home is not None:
            x, y, _ = to_scene(frame.home)
            self.home.position = (x, y, 0.01 * self._size)  # on the ground, whatever the estimator thinks of its height
        if frame.leg != self._leg:
            self._leg = frame.leg
            ends = np.array([to_scene(end) for end in frame.leg or ()], np.float32)
            self.leg.points = ends.reshape(-1, 2, 3)
        if frame.plan is not self._shown:
            self._shown = frame.plan
            self._draw(frame.plan)

    def _draw(self, plan: Plan) -> None:
        for node in reversed(self._nodes):  # a label goes before the ball that it belongs to
            node.remove()
        self._nodes = []
        if plan.items:
            positions = np.array([to_scene(mark.position) for mark in plan.items], np.float32)
            if len(positions) > 1:
                self._lines("/stage/plan/path", np.stack([positions[:-1], positions[1:]], axis=1), _PATH, 0.02)
            self._marks("/stage/plan/item", plan.items, _LEG)
        self._marks("/stage/plan/rally", plan.rally, _RALLY)
        for k, outline in enumerate(plan.fences):
            self._lines(f"/stage/plan/fence{k}", curtain(outline, plan.fence_top), _FENCE, 0.05)

    def _marks(self, name: str, marks: tuple[Mark, ...], colour: tuple[int, int, int]) -> None:
        scene, size = self._scene, self._size
        for k, mark in enumerate(marks):
            at = to_scene(mark.position)
            self._nodes += [
                scene.add_icosphere(f"{name}{k}", radius=0.14 * size, color=colour, position=at),
                scene.add_label(f"{name}{k}/label", mark.name, anchor="bottom-center", font_screen_scale=0.75),
            ]
            if at[2] > size:  # how high it is
                foot = np.array([[at, (at[0], at[1], 0.0)]], np.float32)
                self._lines(f"{name}{k}_height", foot, _PATH, 0.015)

    def _lines(self, name: str, lines: Any, colour: tuple[int, int, int], thickness: float) -> None:
        self._nodes.append(self._scene.add_line_segments(name, lines, colour, thickness=thickness * self._size))


def curtain(outline: Points, top: float) -> Points:
    """Lines of a closed outline on the ground and at a height [m], and posts between; shape (n, 2, 3)."""
    flat = np.column_stack([outline[:, 0], -outline[:, 1], np.zeros(len(outline))])
    after = np.roll(flat, -1, axis=0)
    up = np.array([0.0, 0.0, top])
    low, high = np.stack([flat, after], axis=1), np.stack([flat + up, after + up], axis=1)
    posts = np.stack([flat, flat + up], axis=1)
    every = max(len(flat) // 12, 1)
    return np.concatenate([low, high, posts[::every]]).astype(np.float32)
