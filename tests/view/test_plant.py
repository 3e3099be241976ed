# SPDX-License-Identifier: BSD-3-Clause
"""A page of physics whose autopilot is another program."""

from __future__ import annotations

import pytest

from sitl.plants.local import stand_alone
from sitl.view.axes import to_scene
from sitl.view.plant import ELSEWHERE, PlantSource

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
from sitl.view.page import Page


def test_a_copter_falls_while_nobody_drives_its_motors() -> None:
    plant = stand_alone("erle_copter", world="maze", seed=1)
    page = Page(PlantSource(plant))
    try:
        plant.vehicle.v.actuators.controls[:4] = [0.9] * 4
        for _ in range(400):
            plant.tick()
        before = plant.vehicle.fleet.tobytes()
        page.capture(1.0)
        page.wait_drawn()
        frame, body = page.frame, plant.vehicle.v.physics.body
        assert frame is not None and frame.mode == ELSEWHERE and frame.time_us == 1_000_000
        assert frame.pos == body.pos and frame.estimate_pos is None and any(frame.rotors)
        assert tuple(page.scene.vehicle.body.position) == pytest.approx(to_scene(body.pos))
        assert not page.scene.estimate.body.visible
        assert not [name for name in page.source.signal_names() if name.startswith(("ATTITUDE", "autopilot"))]
        assert plant.vehicle.fleet.tobytes() == before
    finally:
        page.close()
        plant.close()
