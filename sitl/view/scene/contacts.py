# SPDX-License-Identifier: BSD-3-Clause
"""Where a vehicle has hit something, with the speed of the impact."""

from __future__ import annotations

from collections import deque
from typing import Any

from ..axes import to_scene
from ..frame import Frame

_COLOUR = (192, 57, 43)
_KEPT = 30
"""Marks; then the oldest goes."""


class Contacts:
    """Red balls at the positions of impacts.

    Args:
        scene: of the page.
        size: of the vehicle [m].
    """

    def __init__(self, scene: Any, size: float) -> None:
        self._scene, self._radius = scene, 0.12 * size
        self._marks: deque[Any] = deque()
        self._hits: int | None = None
        self._number = 0

    @property
    def positions(self) -> list[tuple[float, float, float]]:
        """Of the marks, in the scene's axes [m], oldest first."""
        return [(float(x), float(y), float(z)) for x, y, z in (mark.position for mark in self._marks)]

    def show(self, frame: Frame) -> None:
        """Mark an impact since the moment before; a count that has gone back begins anew."""
        before, self._hits = self._hits, frame.hits
        if before is not None and frame.hits < before:
            self.clear()
        elif before is not None and frame.hits > before:
            self._mark(frame)

    def clear(self) -> None:
        """Forget them, and count from the next moment on."""
        for mark in self._marks:
            mark.remove()
        self._marks.clear()
        self._hits = None

    def _mark(self, frame: Frame) -> None:
        self._number += 1
        name = f"/stage/contacts/{self._number % (_KEPT + 1)}"
        ball = self._scene.add_icosphere(
            name, radius=self._radius, color=_COLOUR, opacity=0.7, position=to_scene(frame.pos)
        )
        text = f"{frame.hit_speed:.1f} m/s"
        self._scene.add_label(f"{name}/label", text, anchor="bottom-center", font_screen_scale=0.75)
        self._marks.append(ball)
        if len(self._marks) > _KEPT:
            self._marks.popleft().remove()
