# SPDX-License-Identifier: BSD-3-Clause
"""A page of several vehicles: all are where they truly are, one is chosen, and nothing in them changes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from sitl.client import Endpoint
from sitl.run.pacing import StoppablePacing
from sitl.run.swarm import SwarmPacing, serve_swarm
from sitl.run.watched import Watched
from sitl.swarm import Swarm
from sitl.view.axes import to_scene, turn
from sitl.view.colours import css, of_ends, of_vehicle

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
from sitl.view.live_page import LivePage

FRAMES = ["erle_copter", "erle_copter", "erle_rover"]


def serve(swarm: Swarm, until_us: int, page: LivePage | None) -> None:
    ticks = iter(range(10**9))
    watched = (lambda: None) if page is None else Watched(page, lambda: swarm.time_us, clock=lambda: float(next(ticks)))
    serve_swarm(swarm, SwarmPacing(StoppablePacing(None)), until_us=until_us, on_slice=watched)


@pytest.fixture
def page() -> Iterator[LivePage]:
    swarm = Swarm(FRAMES, seed=3)
    page = LivePage(swarm.vehicles, StoppablePacing(None))
    serve(swarm, 2_000_000, page)
    page.capture(1.0)
    page.wait_drawn()
    yield page
    page.close()
    swarm.close()


def test_each_vehicle_is_drawn_where_it_truly_is(page: LivePage) -> None:
    assert page.scene.company is not None
    drawn = dict[int, tuple[float, ...]]()
    for node, which in page.scene.company.nodes:
        assert len(node.batched_positions) == len(node.batched_wxyzs) == len(which)
        drawn.update((int(k), tuple(at)) for k, at in zip(which, node.batched_positions, strict=True))
    bodies = [vehicle.v.physics.body for vehicle in page._vehicles]
    assert [drawn[k] for k in range(3)] == [pytest.approx(to_scene(body.pos), abs=1e-5) for body in bodies]
    assert np.linalg.norm(np.subtract(drawn[0], drawn[1])) == pytest.approx(4.0, abs=0.1)
    assert tuple(page.scene.vehicle.body.wxyz) == pytest.approx(turn(bodies[0].q))


def test_a_number_that_no_vehicle_has_is_said_and_changes_nothing(page: LivePage) -> None:
    said: list[str] = []
    page.notify = lambda text, client=None, title="": said.append(text)  # type: ignore[method-assign]
    for number in (9, 0):
        page.vehicle_number.value = number
    assert said == ["Vehicle: 9 is outside 1 .. 3", "Vehicle: 0 is outside 1 .. 3"]
    assert page.chosen == 0


def test_another_one_is_chosen_shown_and_commanded(page: LivePage) -> None:
    page.plots.add("physics.body.pos[0]")
    page.vehicle_number.value = 3
    page.capture(1.0)
    page.wait_drawn()
    rover = page._vehicles[2]
    assert page.simulation is rover and page.frame is not None and page.frame.company is not None
    assert page.frame.company.chosen == 2
    assert tuple(page.scene.vehicle.body.position) == pytest.approx(to_scene(rover.v.physics.body.pos))
    assert "chassis" in page.scene.vehicle._pieces, "its own shape"
    assert page.frame.signals["physics.body.pos[0]"] == rover.v.physics.body.pos.x
    page.ask(lambda: page.pilot.set_parameter("CRUISE_SPEED", 1.25))
    page.attend()
    rover.advance_to(rover.time_us)
    assert rover.parameters["CRUISE_SPEED"] == 1.25


def test_telemetry_and_records_are_the_same_bits_with_a_page() -> None:
    def run(with_page: bool) -> list[bytes]:
        swarm = Swarm(FRAMES, seed=5)
        station = Endpoint()
        swarm.router.add_link(station.link)
        page = LivePage(swarm.vehicles) if with_page else None
        for until_us in (4_000_000, 8_000_000):
            serve(swarm, until_us, page)
            if page is not None:
                page.wait_drawn()  # it takes the next moment when it is free, however fast the vehicles go
        if page is not None:
            assert page.frame is not None and page.frame.time_us > 4_000_000, "it was shown"
            page.close()
        bits = [*(vehicle.fleet.tobytes() for vehicle in swarm.vehicles), station.link.receive()]
        swarm.close()
        return bits

    assert run(True) == run(False)


def test_each_has_its_number_and_its_colour_in_the_scene_and_beside_it(page: LivePage) -> None:
    company = page.scene.company
    assert company is not None and page.frame is not None
    assert [label.text for label in company.labels] == ["1", "2", "3"]
    for label, vehicle in zip(company.labels, page._vehicles, strict=True):
        x, y, z = to_scene(vehicle.v.physics.body.pos)
        assert label.position[:2] == pytest.approx((x, y), abs=1e-4) and label.position[2] > z
    colours = [tuple(row) for row in of_ends([of_vehicle(k) for k in range(3)]).tolist()]
    drawn = {tuple(row) for node, which in company.nodes for row in np.atleast_2d(node.batched_colors).tolist()}
    assert len(set(colours)) == 3 and set(colours) <= drawn
    page.show(page.frame)
    page.show(page.frame)
    html = page.panel.company_html
    for k, vehicle in enumerate(page._vehicles):
        assert f'color:{css(of_vehicle(k))}">&#9632;</span> <b>{k + 1}</b> system {vehicle.bridge.system}, ' in html
    assert "STABILIZE, disarmed" in html and "MANUAL, disarmed" in html
