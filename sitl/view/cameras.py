# SPDX-License-Identifier: BSD-3-Clause
"""Where viewers look from: free, along with the vehicle, from its seat, from above.

A camera that is moved thirty times a second cannot be turned by a mouse meanwhile, and browsers move it with a lag. So
to follow a vehicle it is the *stage*, with everything on it, that is moved, such that the vehicle stays at the origin,
and cameras are left to who looks.
"""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np

from ..core.vectors import Vec3
from .axes import to_scene, turn
from .frame import Frame

FREE, FOLLOW, FIRST_PERSON, TOP = "free", "follow", "first person", "top"
VIEWS = (FREE, FOLLOW, FIRST_PERSON, TOP)
NARROW = 600
"""Width below which the panel lies over the lower part of the scene [pixels]: the vehicle is shown above it."""
_LOWER = 0.4
"""By how much of its distance a camera then looks below the vehicle."""
_UP = (0.0, 0.0, 1.0)


class Cameras:
    """The view of a page, and the cameras of all browsers that have it open.

    Args:
        stage: node that everything is on.
        size: of the vehicle [m].
        view: one of VIEWS.
    """

    def __init__(self, stage: Any, size: float, view: str = FOLLOW) -> None:
        self._stage, self._size = stage, size
        self.view = view
        self._ready: set[int] = set()

    def choose(self, view: str) -> None:
        """Look from there from now on; FREE: the stage and all cameras stay where they are."""
        self.view = view
        self._ready.clear()

    def shift(self) -> tuple[float, float, float]:
        """How far the stage is moved [m]."""
        x, y, z = self._stage.position
        return (float(x), float(y), float(z))

    def span(self, frame: Frame) -> float:
        """How much is seen around the vehicle at least [m]."""
        return 0.3 * self._height(frame) if self.view == TOP else 1.5 * self._size

    def show(self, clients: dict[int, Any], frame: Frame) -> None:
        """Look at a moment."""
        if self.view == FREE:
            return
        self._stage.position = -np.array(to_scene(frame.pos))
        for number, client in clients.items():
            if self.view == FIRST_PERSON or number not in self._ready:
                with contextlib.suppress(AssertionError, ValueError), client.atomic():  # it may not have a camera yet
                    self._place(client.camera, frame)
                    self._ready.add(number)
        self._ready &= set(clients)

    def _place(self, camera: Any, frame: Frame) -> None:
        """Put a camera where this view begins."""
        size = self._size
        if self.view == FIRST_PERSON:
            ahead, up = rotated(frame, (1.0, 0.0, 0.0)), rotated(frame, (0.0, 0.0, 1.0))
            eye = size * (0.9 * ahead + 0.35 * up)
            _put(camera, eye, eye + 5.0 * ahead, tuple(up))
        elif self.view == TOP:
            middle = np.zeros(3)
            if frame.company is not None:  # all of them
                low, high = frame.company.pos.min(axis=0), frame.company.pos.max(axis=0)
                middle = np.array(to_scene(Vec3(*(0.5 * (low + high)).tolist()))) - to_scene(frame.pos)
            height = self._height(frame)
            middle = middle - (is_narrow(camera) * _LOWER * height, 0.0, 0.0)
            _put(camera, middle + np.array([-0.02 * height, 0.0, height]), middle, _UP)
        else:
            eye = size * np.array([-2.6, 1.3, 1.3])
            below = np.array([0.0, 0.0, is_narrow(camera) * _LOWER * float(np.linalg.norm(eye))])
            _put(camera, eye, -below, _UP)

    def _height(self, frame: Frame) -> float:
        """Of the camera above the vehicle, in the view from above [m]."""
        wide = 0.0 if frame.company is None else float(np.ptp(frame.company.pos, axis=0).max())
        return max(30.0 * self._size, 1.5 * to_scene(frame.pos)[2], 0.9 * wide)


def is_narrow(camera: Any) -> bool:
    """Whether a browser's window is."""
    return int(camera.image_width) < NARROW


def rotated(frame: Frame, axis: tuple[float, float, float]) -> Any:
    """An axis of the vehicle (forward, left, up) in the scene."""
    w, x, y, z = turn(frame.q)
    v, u = np.array(axis), np.array([x, y, z])
    return v + 2.0 * np.cross(u, np.cross(u, v) + w * v)


def _put(camera: Any, eye: Any, look_at: Any, up: tuple[float, float, float]) -> None:
    camera.up_direction = up
    camera.position = eye
    camera.look_at = look_at
