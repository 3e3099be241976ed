# SPDX-License-Identifier: BSD-3-Clause
"""All of the scene for one vehicle: the truth, estimate and set-point beside it, plan, trail, wind."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...core.algebra import norm
from ...core.vectors import Quat, Vec3
from ...worlds import World
from ..axes import to_scene
from ..colours import of_vehicle
from ..frame import Frame, Points, Stage
from ..shape import tinted
from . import surroundings
from .bearings import Bearings
from .company import CompanyNodes
from .contacts import Contacts
from .mission_scene import PlanNodes
from .trail import Trail
from .vehicle import Ghost, VehicleNodes

_ESTIMATE, _WANTED, _WIND = (52, 152, 219), (39, 174, 96), (90, 170, 230)
_LEVEL = Quat(1.0, 0.0, 0.0, 0.0)


class Scene:
    """The nodes of a vehicle and of what is around it."""

    def __init__(self, server: Any, stage: Stage) -> None:
        scene = server.scene
        size = stage.shape.size
        scene.set_up_direction("+z")
        self.stage = scene.add_frame("/stage", show_axes=False)
        """All of it; ``cameras`` moves it below the eyes of who follows the vehicle."""
        scene.configure_default_lights(cast_shadow=True)
        self._world, self._surroundings = stage.world, surroundings.draw(scene, stage.world, stage.copies)
        self._scene, self._shapes, self._chosen = scene, stage.company, 0
        self._entered: World | None = None
        """The world that a frame had last, which is drawn in place of the stage's."""
        self.company = CompanyNodes(scene, stage.company) if stage.company else None
        """All vehicles, where there are several."""
        shape = tinted(stage.shape, of_vehicle(0)) if stage.company else stage.shape
        self.vehicle = VehicleNodes(scene, "/stage/vehicle", shape)
        self.trail = Trail(scene, "/stage/trail", size)
        self.contacts = Contacts(scene, size)
        self.plan = PlanNodes(scene, size)
        self.bearings = Bearings(scene)
        self.estimate = Ghost(scene, "/stage/estimate", stage.shape, _ESTIMATE, 0.35)
        self.set_point = scene.add_icosphere(
            "/stage/set_point", radius=0.07 * size, color=_WANTED, opacity=0.9, visible=False
        )
        self._wind_node = scene.add_frame("/stage/wind", show_axes=False)
        self._size, self._wind = size, Vec3(0.0, 0.0, 0.0)
        self._arrow = scene.add_arrows(
            "/stage/wind/arrow", np.zeros((0, 2, 3), np.float32), _WIND, shaft_radius=0.03 * size,
            head_radius=0.09 * size, head_length=0.2 * size,
        )  # fmt: skip

    def show(self, frame: Frame, span: float) -> None:
        """Draw a moment; ``span``: metres that are seen around the vehicle."""
        if frame.world is not None and frame.world is not self._entered:
            self._enter(frame.world)
        if self.company is not None and frame.company is not None:
            self._choose(frame.company.chosen)
            self.company.show(frame.company)
        self.vehicle.show(frame)
        self.trail.show(frame)
        self.contacts.show(frame)
        self.plan.show(frame)
        self.estimate.show(frame.estimate_pos, frame.estimate_q or _LEVEL)
        self.set_point.visible = frame.set_point is not None
        if frame.set_point is not None:
            self.set_point.position = to_scene(frame.set_point)
        self._show_wind(frame)
        self.bearings.show(to_scene(frame.pos), span)

    def place_world(self, copies: Points | None) -> None:
        """Draw the world at other positions, shape (n, 3) [m]; None: once, at the origin."""
        if self._entered is None:  # else frames say what is around
            self._surroundings.remove()
            self._surroundings = surroundings.draw(self._scene, self._world, copies)
        self.trail.clear()
        self.contacts.clear()

    def _enter(self, world: World) -> None:
        """Draw another world in place of the stage's."""
        self._entered = world
        self._surroundings.remove()
        self._surroundings = surroundings.draw(self._scene, world)
        self.trail.clear()
        self.contacts.clear()

    def _choose(self, number: int) -> None:
        """Show this vehicle in full from now on."""
        if number == self._chosen:
            return
        self._chosen = number
        self.trail.clear()
        self.contacts.clear()
        shape = self._shapes[number]
        self.vehicle.body.remove()
        self.estimate.body.remove()
        self.vehicle = VehicleNodes(self._scene, "/stage/vehicle", tinted(shape, of_vehicle(number)))
        self.estimate = Ghost(self._scene, "/stage/estimate", shape, _ESTIMATE, 0.35)

    def _show_wind(self, frame: Frame) -> None:
        x, y, z = to_scene(frame.pos)
        self._wind_node.position = (x, y, z + 1.2 * self._size)
        if norm(frame.wind - self._wind) > 0.05:
            self._wind = frame.wind
            tip = np.array(to_scene(frame.wind)) * 0.35 * self._size  # a metre a second is about a third of the vehicle
            self._arrow.points = np.array([[-0.5 * tip, 0.5 * tip]], np.float32)
