# SPDX-License-Identifier: BSD-3-Clause
"""A fleet on the page: each vehicle is where it truly is, in its own world or in one, and nothing in it changes."""

from __future__ import annotations

import numpy as np
import pytest

from sitl import Fleet, Move
from sitl.view.axes import to_scene
from sitl.view.layout import GRID, ONE, side_by_side

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
COUNT = 70
"""More than are drawn with all of their pieces."""


@pytest.fixture(scope="module")
def fleet() -> Fleet:
    fleet = Fleet("erle_copter", COUNT, seed=3)
    fleet.move(range(COUNT), [Move(north=0.1 * k, east=-0.2 * k) for k in range(COUNT)])
    return fleet


def test_each_is_drawn_where_it_is_in_its_own_world_or_in_one(fleet: Fleet) -> None:
    view = fleet.page()
    page = view.page
    try:

        def drawn() -> np.ndarray:
            page.wait_drawn()
            view.refresh()
            page.wait_drawn()
            assert page.scene.company is not None
            nodes = page.scene.company.nodes
            assert all(which.tolist() == list(range(COUNT)) for _, which in nodes)
            return np.array(nodes[0][0].batched_positions)

        true = np.array([to_scene(fleet.view(k).physics.body.pos) for k in range(COUNT)])
        apart = drawn() - true
        assert page.layout.value == GRID and len(np.unique(apart.round(2), axis=0)) == COUNT
        page.vehicle_number.value = 40
        apart = drawn() - true
        frame = page.frame
        assert frame is not None and frame.company is not None and frame.company.chosen == 39
        assert tuple(page.scene.vehicle.body.position) == pytest.approx(tuple(true[39] + apart[39]), abs=1e-4)
        page.show(frame)  # the state is renewed with every third frame
        page.show(frame)
        assert "3.9 N, -7.8 E" in page.panel.state_html, "its place in its own world"
        page.layout.value = ONE
        assert np.allclose(drawn(), true, atol=1e-4)
        assert f'src="{page.address}"' in view._repr_html_()
    finally:
        view.close()
    assert fleet.observers == []


def test_records_and_telemetry_are_the_same_bits_with_it() -> None:
    def run(shown: bool) -> list[bytes]:
        fleet = Fleet("erle_copter", 3, seed=5)
        view = fleet.page() if shown else None
        said = []
        for _ in range(20):
            fleet.advance(1.0)
            said.append(fleet.receive(1))
        if view is not None:
            view.refresh()
            view.page.wait_drawn()
            assert view.page.frame is not None and view.page.frame.time_us == 20_000_000
            view.close()
        return [fleet.records.tobytes(), *said]

    assert run(True) == run(False)


def test_worlds_side_by_side_do_not_overlap() -> None:
    places = side_by_side(5, (-2.0, -1.0), (2.0, 1.0))
    assert places.shape == (5, 3) and tuple(places[0]) == (0.0, 0.0, 0.0)
    for k in range(5):
        for other in places[:k]:
            north, west, _ = np.abs(places[k] - other)
            assert north >= 5.0 or west >= 3.0
