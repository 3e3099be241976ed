# SPDX-License-Identifier: BSD-3-Clause
"""Where a viewer looks from: free, along with the vehicle, from its seat, from above. Each browser has its own."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np

from .axes import place, turn
from .frame import Frame

FREE, FOLLOW, FIRST_PERSON, TOP = "free", "follow", "first person", "top"
VIEWS = (FREE, FOLLOW, FIRST_PERSON, TOP)


class Cameras:
    """The views of all browsers.

    Args:
        size: of the vehicle [m].
    """

    def __init__(self, size: float) -> None:
        self._size = size
        self.view = FOLLOW
        """One of VIEWS."""
        self._fresh: set[int] = set()

    def choose(self, view: str) -> None:
        """Look from there from now on."""
        self.view = view
        self._fresh.clear()

    def show(self, clients: dict[int, Any], frame: Frame) -> None:
        """Move the cameras of all browsers to where they are at this moment."""
        for number, client in clients.items():
            with contextlib.suppress(AssertionError, ValueError):  # it has not told yet where its camera is
                is_new = number not in self._fresh
                with client.atomic():
                    self._move(client.camera, frame, is_new)
                self._fresh.add(number)
        self._fresh &= set(clients)

    def _move(self, camera: Any, frame: Frame, is_new: bool) -> None:
        at = np.array(place(frame.pos))
        if self.view == FIRST_PERSON:
            ahead, up = rotated(frame, (1.0, 0.0, 0.0)), rotated(frame, (0.0, 0.0, 1.0))
            _put(camera, at + 0.9 * self._size * ahead + 0.35 * self._size * up, ahead, up)
        elif self.view == TOP:
            height = max(30.0 * self._size, 1.5 * at[2])
            if is_new or not np.allclose(camera.look_at[:2], at[:2], atol=0.3 * height):
                above, ahead = at + (-0.02 * height, 0.0, height), np.array([0.02, 0.0, -1.0])
                _put(camera, above, ahead, (0.0, 0.0, 1.0), height)
        elif self.view == FOLLOW:
            away = np.asarray(camera.position) - np.asarray(camera.look_at)
            if is_new:
                away = self._size * np.array([-2.6, 1.3, 1.3])
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = at + away
            camera.look_at = at
        elif is_new:  # free: it stays where it is, upright
            camera.up_direction = (0.0, 0.0, 1.0)


def rotated(frame: Frame, axis: tuple[float, float, float]) -> Any:
    """An axis of the vehicle (forward, left, up) in the scene."""
    w, x, y, z = turn(frame.q)
    v, u = np.array(axis), np.array([x, y, z])
    return v + 2.0 * np.cross(u, np.cross(u, v) + w * v)


def _put(camera: Any, position: Any, ahead: Any, up: Any, distance: float = 5.0) -> None:
    camera.up_direction = tuple(up)
    camera.position = position
    camera.look_at = position + distance * ahead
