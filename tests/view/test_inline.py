# SPDX-License-Identifier: BSD-3-Clause
"""``simulation.view()``: the page follows while somebody else advances the vehicle, and changes nothing."""

from __future__ import annotations

import pytest

from sitl import Simulation
from sitl.client import Endpoint
from sitl.simulation import Core
from sitl.view.axes import to_scene

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")


def test_a_notebook_gets_a_frame_with_the_page_which_shows_the_newest(core: Core) -> None:
    simulation = Simulation("erle_copter", core=core, seed=3)
    view = simulation.view(height=300)
    try:
        simulation.advance(5.0)
        html = view._repr_html_()
        view.page.wait_drawn()
        assert f'src="{view.page.address}"' in html and 'height="300"' in html
        assert view.page.frame is not None and view.page.frame.time_us == 5_000_000
        at = tuple(view.page.scene.vehicle.body.position)
        assert at == pytest.approx(to_scene(simulation.v.physics.body.pos))
    finally:
        view.close()
    assert simulation.observers == []


def test_telemetry_and_record_are_the_same_bits_with_it(core: Core) -> None:
    def run(shown: bool) -> tuple[bytes, bytes]:
        simulation = Simulation("erle_copter", core=core, seed=5)
        station = Endpoint()
        simulation.bridge.add_link(station.link)
        simulation.bridge.stream_to(station.link, {"EXTRA1": 10})
        view = simulation.view() if shown else None
        simulation.advance(20.0)
        if view is not None:
            view.close()
        return simulation.fleet.tobytes(), station.link.receive()

    assert run(True) == run(False)
