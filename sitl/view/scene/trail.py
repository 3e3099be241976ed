# SPDX-License-Identifier: BSD-3-Clause
"""The path that a vehicle has come, coloured by its mode or by its speed; its memory is limited."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from ...core.algebra import norm
from ..axes import to_scene
from ..colours import of_ends, of_mode, of_speed
from ..frame import Frame

BY_MODE, BY_SPEED = "mode", "speed"
_PIECE = 240
"""Lines of a node: only the last node is sent anew as the trail grows."""
_PIECES = 50
"""Nodes; then the oldest goes."""


class Trail:
    """Lines behind a vehicle.

    Args:
        scene: of the page.
        name: of the node whose children these are.
        size: of the vehicle [m].
    """

    def __init__(self, scene: Any, name: str, size: float) -> None:
        self._scene, self._name = scene, name
        self._step, self._thickness = 0.15 * size, 0.03 * size
        self._lift = 0.02 * size  # out of the ground
        self._pieces: deque[Any] = deque()
        self._count = 0
        self._points: list[tuple[float, float, float]] = []
        self._modes: list[str] = []
        self._speeds: list[float] = []
        self._time_us = 0
        self.colours = BY_MODE
        """BY_MODE or BY_SPEED: of lines from now on."""

    def show(self, frame: Frame) -> None:
        """Go on to a moment; time that has gone back begins a new trail."""
        if frame.time_us < self._time_us:
            self.clear()
        self._time_us = frame.time_us
        x, y, z = to_scene(frame.pos)
        here = (x, y, z + self._lift)
        if self._points:
            moved = float(np.linalg.norm(np.subtract(here, self._points[-1])))
            if moved < self._step:
                return
            if moved > 1e3 * self._step and moved > 5.0 + 2.0 * norm(frame.vel):  # it was put there
                self._begin()
        self._points.append(here)
        self._modes.append(frame.mode)
        self._speeds.append(norm(frame.vel))
        if len(self._points) >= 2:
            self._draw()
        if len(self._points) > _PIECE:
            self._begin(keep=1)

    def clear(self) -> None:
        """Forget it all."""
        for piece in self._pieces:
            piece.remove()
        self._pieces.clear()
        self._points, self._modes, self._speeds = [], [], []

    def _begin(self, keep: int = 0) -> None:
        at = len(self._points) - keep
        self._points, self._modes, self._speeds = self._points[at:], self._modes[at:], self._speeds[at:]

    def _draw(self) -> None:
        points = np.array(self._points, np.float32)
        lines = np.stack([points[:-1], points[1:]], axis=1)
        if self.colours == BY_SPEED:
            ends = of_ends([of_speed(speed) for speed in self._speeds])
        else:
            ends = of_ends([of_mode(mode) for mode in self._modes])
        colours = np.stack([ends[1:], ends[1:]], axis=1)
        if len(self._points) > 2:
            self._pieces[-1].points, self._pieces[-1].colors = lines, colours
            return
        self._count += 1
        name = f"{self._name}/{self._count % (_PIECES + 1)}"  # names come again: the server keeps something for each
        self._pieces.append(self._scene.add_line_segments(name, lines, colours, thickness=self._thickness))
        if len(self._pieces) > _PIECES:
            self._pieces.popleft().remove()
