# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in the scene: its shape where it truly is, what turns on it, and what its lidar meets."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..axes import FLIP, about, to_scene, turn
from ..frame import Frame
from ..shape import ROTOR, WHEEL, Shape

_STEP = 0.8
"""A rotor is drawn turned by at most this much from one frame to the next [rad]: more would seem to turn back."""
_RAYS = 40
"""About so many rays are drawn as lines, all hits as points."""
_RAY, _HIT = (255, 190, 120), (226, 62, 36)


class VehicleNodes:
    """The nodes of one vehicle.

    Args:
        scene: of the page.
        name: of the node whose children these are.
        shape: of the vehicle.
    """

    def __init__(self, scene: Any, name: str, shape: Shape) -> None:
        self.body = scene.add_frame(name, show_axes=False)
        """The vehicle: its position and attitude are the truth."""
        self._pieces = {}
        for piece in shape.pieces:
            mesh = piece.mesh
            self._pieces[piece.name] = scene.add_mesh_simple(
                f"{name}/{piece.name}", mesh.vertices, mesh.faces, color=piece.colour, flat_shading=True,
                position=piece.at, opacity=None if piece.opacity == 1.0 else piece.opacity, side="double",
                cast_shadow=piece.opacity == 1.0,
            )  # fmt: skip
        self._rotors = [piece for piece in shape.pieces if piece.turns == ROTOR]
        self._wheels = [piece for piece in shape.pieces if piece.turns == WHEEL]
        self._angles = np.zeros(len(self._rotors))
        self._time_us: int | None = None
        self._wheel_state: tuple[float, ...] = ()
        none = np.zeros((0, 2, 3), np.float32)
        thickness = 0.012 * shape.size
        self._rays = scene.add_line_segments(f"{name}/rays", none, _RAY, thickness=0.15 * thickness)
        self._hits = scene.add_point_cloud(
            f"{name}/hits", none[:, 0], _HIT, point_size=2.0 * thickness, point_shape="circle", precision="float32"
        )
        self._scan: object = None

    def show(self, frame: Frame) -> None:
        """Draw a moment."""
        self.body.position, self.body.wxyz = to_scene(frame.pos), turn(frame.q)
        if self._rotors:
            self._turn_rotors(frame)
        if self._wheels:
            self._turn_wheels(frame)
        if frame.scan is not self._scan:
            self._scan = frame.scan
            self._draw_scan(frame)

    def _turn_rotors(self, frame: Frame) -> None:
        seconds = 0.0 if self._time_us is None else max(frame.time_us - self._time_us, 0) * 1e-6
        self._time_us = frame.time_us
        for k, piece in enumerate(self._rotors):
            step = frame.rotors[piece.number] * seconds if piece.number < len(frame.rotors) else 0.0
            if step != 0.0:
                self._angles[k] = (self._angles[k] + np.clip(step, -_STEP, _STEP)) % (2.0 * np.pi)
                self._pieces[piece.name].wxyz = about(2, float(self._angles[k]))

    def _turn_wheels(self, frame: Frame) -> None:
        state = (frame.steering, *frame.rolled)
        if state == self._wheel_state:
            return
        self._wheel_state = state
        for piece in self._wheels:
            rolled = about(1, frame.rolled[piece.number] / piece.radius % (2.0 * np.pi))
            if piece.steers:
                c, _, _, s = about(2, -frame.steering)
                w, _, y, _ = rolled
                rolled = (c * w, -s * y, c * y, s * w)  # steered, then rolled about its own axle
            self._pieces[piece.name].wxyz = rolled

    def _draw_scan(self, frame: Frame) -> None:
        points = np.zeros((0, 3)) if frame.scan is None else frame.scan * FLIP
        self._hits.points = points.astype(np.float32)
        start = np.zeros(3)
        if len(points):
            start = points.mean(axis=0) * (0.0, 0.0, 1.0)
        points = points[:: max(len(points) // _RAYS, 1)]
        self._rays.points = np.stack([np.broadcast_to(start, points.shape), points], axis=1).astype(np.float32)


class Ghost:
    """A see-through copy of a vehicle: where something believes it to be, or wants it to be."""

    def __init__(self, scene: Any, name: str, shape: Shape, colour: tuple[int, int, int], opacity: float) -> None:
        self.body = scene.add_frame(name, show_axes=False, visible=False)
        for piece in shape.pieces:
            if piece.opacity == 1.0 and not piece.turns:
                scene.add_mesh_simple(
                    f"{name}/{piece.name}", piece.mesh.vertices, piece.mesh.faces, color=colour, position=piece.at,
                    opacity=opacity, side="double", cast_shadow=False, receive_shadow=False,
                )  # fmt: skip

    def show(self, pos: Any, q: Any) -> None:
        """Draw it at a position and attitude (NED, body to NED), or not at all (None)."""
        self.body.visible = pos is not None
        if pos is not None:
            self.body.position = to_scene(pos)
            self.body.wxyz = turn(q)
