# SPDX-License-Identifier: BSD-3-Clause
"""The page's scene and widgets, asked through the server that holds them; no browser is needed."""

from __future__ import annotations

import socket
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from sitl import Simulation
from sitl.client import Client, Endpoint
from sitl.core.algebra import rotate_inverse
from sitl.core.vectors import Vec3
from sitl.errors import OptionError, SitlError
from sitl.physics.native.records import GROUND_AIRBORNE
from sitl.recording import Recorder
from sitl.run.pacing import StoppablePacing
from sitl.run.runner import serve
from sitl.run.watched import Watched
from sitl.simulation import Core
from sitl.view import page as pages
from sitl.view.axes import to_scene, turn
from sitl.view.controls import on_ground
from sitl.view.frame import Mark, Plan
from sitl.view.page import PageAddressError, free_port

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
from sitl.view.live_page import LivePage


class Event:
    """A click that nobody in particular made."""

    client = None
    ray_origin = ray_direction = (0.0, 0.0, 0.0)

    def __init__(self, target: object = None) -> None:
        self.target = target


@pytest.fixture
def page(core: Core) -> Iterator[LivePage]:
    page = LivePage(Simulation("erle_copter", core=core, seed=3), StoppablePacing(None))
    yield page
    page.close()


def fly(page: LivePage, seconds: float) -> None:
    """Let time go by as a run does, and let the page draw what is then."""
    simulation = page.simulation
    pace = StoppablePacing(None)
    serve(simulation, pace, until_us=simulation.time_us + round(seconds * 1e6), on_slice=page.attend)
    page.capture(1.0)
    page.wait_drawn()


def test_the_vehicle_in_the_scene_is_where_it_truly_is(page: LivePage) -> None:
    vehicle = Client(page.simulation)
    vehicle.wait_ready()
    vehicle.take_off(6.0)
    vehicle.set_velocity(2.0, 1.0)
    vehicle.delay(3.0)
    fly(page, 0.5)
    frame, body = page.frame, page.simulation.v.physics.body
    assert frame is not None
    assert tuple(page.scene.vehicle.body.position) == pytest.approx(to_scene(body.pos))
    assert tuple(page.scene.vehicle.body.wxyz) == pytest.approx(turn(body.q))
    assert page.scene.estimate.body.visible and page.scene.set_point.visible and page.scene.plan.home.visible
    assert frame.estimate_pos is not None
    assert tuple(page.scene.estimate.body.position) == pytest.approx(to_scene(frame.estimate_pos))
    page.show(frame)  # the state is renewed with every third frame
    page.show(frame)
    assert "GUIDED" in page.panel.state_html and "ARMED" in page.panel.state_html
    assert "Arming motors" in page.panel.texts


def test_buttons_arm_and_take_off_by_mavlink(page: LivePage) -> None:
    assert page.controls is not None
    taps: list[bytes] = []

    class Tap:
        def frame(self, time_us: int, raw: bytes) -> None:
            taps.append(raw)

    page.simulation.bridge.client_taps.append(Tap())
    fly(page, 60.0)
    page.controls.height.value = 7.0
    page.ask(lambda: page.pilot.take_off(page.controls.height.value))  # type: ignore[union-attr]
    fly(page, 15.0)
    v = page.simulation.v
    assert v.autopilot.arming.armed and -v.physics.body.pos.z == pytest.approx(7.0, abs=2.0)
    assert len(taps) == 3, "mode, arming, take-off: as any client's"
    page.ask(lambda: page.pilot.go_to(12.0, -8.0))
    fly(page, 15.0)
    assert v.physics.body.pos.x == pytest.approx(12.0, abs=2.5)
    assert v.physics.body.pos.y == pytest.approx(-8.0, abs=2.5)


def test_sticks_on_the_page_fly_it_and_are_given_back(page: LivePage) -> None:
    assert page.controls is not None
    sticks = page.controls.sticks
    fly(page, 60.0)
    v = page.simulation.v
    page.ask(lambda: page.pilot.set_mode("ALT_HOLD"))
    page.ask(page.pilot.arm)
    sticks.held.value = True
    fly(page, 4.0)
    assert v.autopilot.arming.armed and -v.physics.body.pos.z < 0.1
    sticks.sliders["Throttle"].value = 80.0
    fly(page, 6.0)
    assert -v.physics.body.pos.z > 4.0
    sticks.centre.value = True
    assert sticks.axes == (0, 0, 500, 0)
    sticks.sliders["Pitch"].value = 40.0
    fly(page, 5.0)
    ahead = rotate_inverse(v.physics.body.q, v.physics.body.vel)
    assert ahead.x > 2.0 and abs(ahead.y) < 1.0
    sticks.held.value = False
    fly(page, 0.2)
    assert not any(v.autopilot.rc.override), "the radio has them again"


def test_what_is_refused_is_said(page: LivePage) -> None:
    said: list[str] = []
    page.notify = lambda text, client=None, title="": said.append(text)  # type: ignore[method-assign]
    page.pilot._report = said.append
    fly(page, 1.0)
    page.ask(page.pilot.arm)
    page.ask(lambda: page.pilot.go_to(1.0, 1.0))
    page.ask(lambda: page.pilot.set_parameter("RTL_ATL", 1.0))
    page.ask(page.pilot.go_back)
    fly(page, 1.0)
    assert any(text.startswith("COMPONENT_ARM_DISARM: ") for text in said)
    assert any("not armed" in text for text in said)
    assert any("no parameter 'RTL_ATL'; did you mean 'RTL_ALT'" in text for text in said)
    assert "no moment was kept" in said


def test_parameters_are_found_by_name_and_meaning_and_set(page: LivePage) -> None:
    widgets = page.parameters
    widgets.search.value = "rtl_alt"
    assert widgets.choice.options[0] == "RTL_ALT"
    widgets.search.value = "wind comes"
    assert "SIM_WIND_DIR" in widgets.choice.options
    widgets.search.value = "SIM_WIND_SPD"
    page.attend()
    widgets.choice.value = "SIM_WIND_SPD"
    page.ask(widgets._read)
    fly(page, 0.1)
    assert "SIM_WIND_SPD" in widgets.about.content and "range 0 .. " in widgets.about.content
    widgets.value.value = 6.0
    page.ask(widgets._set)
    fly(page, 30.0)
    assert page.simulation.v.physics.wind.speed == 6.0
    assert page.frame is not None and len(page.scene._arrow.points) == 1, "the arrow shows it"


def test_back_to_a_moment_that_was_kept(page: LivePage) -> None:
    fly(page, 10.0)
    page.ask(page.pilot.keep)
    page.attend()
    kept = page.simulation.fleet.tobytes()
    fly(page, 5.0)
    assert page.simulation.fleet.tobytes() != kept
    page.ask(page.pilot.go_back)
    page.attend()
    assert page.simulation.fleet.tobytes() == kept


def test_no_moment_is_kept_in_a_run_that_is_recorded(page: LivePage, tmp_path: Path) -> None:
    Recorder(page.simulation, tmp_path / "a.rec")
    for deed in (page.pilot.keep, page.pilot.go_back):
        with pytest.raises(OptionError, match=r"recorded \(--rec\)"):
            deed()


def test_a_plan_that_changes_is_drawn_anew_without_a_warning(page: LivePage) -> None:
    nodes = page.scene.plan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for heights in ((5.0, 0.0), (7.0,), ()):
            marks = tuple(Mark(f"item {k}", Vec3(k, 0.0, -height)) for k, height in enumerate(heights))
            nodes._draw(Plan(items=marks))
            balls_and_labels, heights_above = 2 * len(marks), sum(height > 1.0 for height in heights)
            assert len(nodes._nodes) == balls_and_labels + heights_above + (len(marks) > 1)


def test_plots_take_signals_by_name(page: LivePage) -> None:
    page.plots.add("ATTITUDE.yaw")
    for _ in range(4):
        fly(page, 2.0)
    times, values = page.plots.find("ATTITUDE.yaw").samples
    assert np.allclose(np.diff(times), 2.0, atol=0.01) and np.all(np.isfinite(values))
    page.plots.add("ATTITUDE.roll", beside="ATTITUDE.yaw")
    for _ in range(3):
        fly(page, 2.0)
    plot = page.plots.find("ATTITUDE.roll")
    times, yaws, rolls = plot.samples
    assert plot is page.plots.find("ATTITUDE.yaw") and len(times) == 7
    assert np.all(np.isfinite(yaws)) and np.all(np.isnan(rolls[:4])) and np.all(np.isfinite(rolls[4:]))
    for name in ("ATTITUDE.pitch", "ATTITUDE.rollspeed"):
        page.plots.add(name, beside="ATTITUDE.yaw")
    assert [each.get("scale") for each in plot._node.series] == [None, "y", "y", "y", "y"], "one message, one axis"
    with pytest.raises(SitlError, match="4 signals in a plot are the most"):
        page.plots.add("ATTITUDE.yawspeed", beside="ATTITUDE.yaw")
    page.plots.add("physics.body.pos[2]")
    page.plots.add("VFR_HUD.alt", beside="physics.body.pos[2]")
    assert page.plots.find("VFR_HUD.alt")._node.series[2]["scale"] == "right"
    page.plots.clear()
    assert page.plots.names == () and page.frame is not None
    fly(page, 0.1)
    assert page.frame.signals == {}


def test_to_follow_the_vehicle_the_stage_is_moved(page: LivePage) -> None:
    vehicle = Client(page.simulation)
    vehicle.wait_ready()
    vehicle.take_off(6.0)
    fly(page, 0.1)
    assert page.frame is not None
    assert page.cameras.shift() == pytest.approx([-each for each in to_scene(page.frame.pos)])
    page.cameras.choose("free")
    there = page.cameras.shift()
    vehicle.set_velocity(3.0, 0.0)
    vehicle.delay(2.0)
    fly(page, 0.1)
    assert page.cameras.shift() == there
    assert page.controls is not None
    asked: list[tuple[float, float]] = []
    page.pilot.go_to = lambda *at: asked.append(at)  # type: ignore[method-assign]
    click = Event()
    click.ray_origin, click.ray_direction = (there[0] + 4.0, there[1] + 2.0, there[2] + 9.0), (0.0, 0.0, -1.0)
    page.controls._clicked(click)
    page.attend()
    assert asked == [pytest.approx((4.0, -2.0))], "a click means a place on the moved ground"


def test_who_may_only_look_has_no_controls(core: Core) -> None:
    page = LivePage(Simulation("erle_copter", core=core), controls=False)
    try:
        assert page.controls is None and page.weather is None
        assert not hasattr(page.parameters, "set") and page.parameters.value.disabled
    finally:
        page.close()


def test_telemetry_and_record_are_the_same_bits_with_a_page(core: Core, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "SHARE", 1.0)  # it draws all that it gets

    def run(with_page: bool) -> tuple[bytes, bytes]:
        simulation = Simulation("erle_copter", core=core, seed=5, world="maze")
        station = Endpoint()
        simulation.bridge.add_link(station.link)
        simulation.bridge.stream_to(station.link, {"EXTRA1": 10, "POSITION": 5})
        ticks = iter(range(10**9))
        page = LivePage(simulation) if with_page else None
        watched = Watched(page, lambda: simulation.time_us, clock=lambda: float(next(ticks))) if page else lambda: None
        shown = set()

        def look() -> None:
            watched()
            second = simulation.time_us // 1_000_000
            if page is not None and second % 5 == 0 and second not in shown:
                page.wait_drawn()  # the vehicle is far faster than the page
                shown.add(second)

        if page is not None:
            page.plots.add("ATTITUDE.roll")
        serve(simulation, StoppablePacing(None), until_us=50_000_000, on_slice=look)
        if page is not None:
            page.wait_drawn()
            assert page.frame is not None and page.frame.time_us > 10_000_000, "it was shown"
            page.close()
        return simulation.fleet.tobytes(), station.link.receive()

    assert run(True) == run(False)


def test_impacts_are_marked_where_they_were(core: Core) -> None:
    page = LivePage(Simulation("erle_copter", core=core, world="maze"), StoppablePacing(None))
    try:
        fly(page, 0.1)
        v = page.simulation.v
        assert page.scene.contacts.positions == [] and page.frame is not None and page.frame.hits == 0
        v.physics.body.pos, v.physics.body.vel = v.physics.body.pos - Vec3(0.0, 0.0, 3.0), Vec3(0.0, 0.0, 0.0)
        v.physics.ground.state = GROUND_AIRBORNE
        fly(page, 3.0)
        hits, speed = int(v.physics.ground.hit_count), float(v.physics.ground.hit_speed)
        assert hits == 1 and speed > 5.0, "it fell three metres"
        assert page.scene.contacts.positions == [pytest.approx(to_scene(page.frame.pos))]
        assert page.frame.hits == 1 and page.frame.hit_speed == pytest.approx(speed)
        page.show(page.frame)
        page.show(page.frame)
        page.show(page.frame)
        assert f"1, last {speed:.1f} m/s" in page.panel.state_html and len(page.scene.contacts.positions) == 1
    finally:
        page.close()


def test_the_trails_memory_is_limited(page: LivePage, monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import replace

    from sitl.view.scene import trail

    monkeypatch.setattr(trail, "_PIECES", 5)
    monkeypatch.setattr(trail, "_PIECE", 40)
    fly(page, 0.1)
    frame = page.frame
    assert frame is not None
    for k in range(1000):
        page.scene.trail.show(replace(frame, time_us=frame.time_us + k, pos=Vec3(0.2 * k, 0.0, 0.0)))
    lines = [len(piece.points) for piece in page.scene.trail._pieces]
    assert len(lines) == 5 and 150 < sum(lines) <= 200


def test_a_port_that_is_taken_is_named() -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(PageAddressError, match=str(port)):
            free_port(port)


def test_where_a_click_meets_the_ground() -> None:
    assert on_ground((0.0, 0.0, 10.0), (0.6, 0.0, -0.8)) == pytest.approx((7.5, 0.0))
    assert on_ground((0.0, 0.0, 10.0), (0.0, 0.6, -0.8)) == pytest.approx((0.0, -7.5)), "west is left"
    assert on_ground((0.0, 0.0, 10.0), (1.0, 0.0, 0.1)) is None
