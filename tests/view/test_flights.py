# SPDX-License-Identifier: BSD-3-Clause
"""Flights that were kept: the state of any moment, events, several together, and a page in one file."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import numpy as np
import pytest

from sitl.errors import OptionError
from sitl.logs.track import Track
from sitl.logs.track_columns import NAMES
from sitl.missions.comparison import flight
from sitl.missions.comparison.alignment import AlignmentError
from sitl.missions.view import together
from sitl.run.playback import Player
from sitl.view.flights import of_track

GOLDEN = Path(__file__).parents[1] / "golden" / "golden"
CIRCLES, WINDY = GOLDEN / "copter-circles.rec", GOLDEN / "copter-circles-wind.rec"


def track(kind: str = "copter", side: float = 0.0) -> Track:
    """Ten seconds north at 2 m/s, three metres high."""
    t = np.arange(0.0, 10.01, 0.1)
    data = np.zeros((len(t), len(NAMES)))
    data[:, 0], data[:, 1], data[:, 2], data[:, 3], data[:, 4] = t, 2.0 * t, side, -3.0, 2.0
    data[:, NAMES.index("yaw")] = np.where(t < 5.0, math.pi - 0.1, -math.pi + 0.1)
    return Track(
        kind, data, modes=[(0.0, "GUIDED"), (4.0, "AUTO")], items=[(6.0, 2)], texts=[(7.0, 3, "Crash"), (8.0, 6, "hm")],
        armed=[(0.0, False), (1.0, True)],
    )  # fmt: skip


def test_the_state_of_any_moment() -> None:
    shown = of_track("one", track())
    frame = shown.frame(3.25)
    assert tuple(frame.pos) == pytest.approx((6.5, 0.0, -3.0)) and frame.vel.x == pytest.approx(2.0)
    assert frame.mode == "GUIDED" and frame.armed and any(frame.rotors)
    assert shown.frame(0.5).armed is False and not any(shown.frame(0.5).rotors)
    assert shown.frame(4.0).mode == "AUTO"
    back = shown.frame(4.95).q  # half way from 180 - 6 to 180 + 6 degrees: south, not north
    assert abs(back.z) > 0.99


def test_events_in_their_order() -> None:
    texts = [(event.time, event.text) for event in of_track("one", track()).events()]
    assert texts == [
        (0.0, "disarmed"), (0.0, "mode GUIDED"), (1.0, "armed"), (4.0, "mode AUTO"), (6.0, "item 2 reached"),
        (7.0, "Crash"),
    ]  # fmt: skip


def test_wheels_roll_with_the_way() -> None:
    assert of_track("one", track("rover")).frame(10.0).rolled == pytest.approx((20.0, 20.0), abs=0.1)


def test_goldens_are_aligned_and_their_distance_measured() -> None:
    flights, curves = together([flight.read(CIRCLES), flight.read(WINDY)])
    assert [each.name for each in flights] == ["copter-circles", "copter-circles-wind"]
    times, apart = next(iter(curves.values()))
    k = len(times) // 2
    one, two = (each.frame(float(times[k])).pos for each in flights)
    assert apart[k] == pytest.approx(math.dist(one, two), abs=0.02)


def test_one_flight_can_begin_at_its_arming() -> None:
    shown, _ = together([flight.Flight("one.rec", track())], "armed")
    assert shown[0].length == pytest.approx(9.0) and tuple(shown[0].frame(0.0).pos) == pytest.approx((2.0, 0.0, -3.0))
    with pytest.raises(AlignmentError, match="align = 'AUTO': there is no such moment"):
        together([flight.Flight("never.rec", Track("copter", track().data))], "AUTO")


def test_what_cannot_be_shown_together_is_said() -> None:
    rover = next(GOLDEN.glob("rover-*.rec"))
    with pytest.raises(AlignmentError, match=r"is of a copter, .* of a rover"):
        together([flight.read(CIRCLES), flight.read(rover)])
    empty = flight.Flight("nothing.rec", Track("copter", np.zeros((0, len(NAMES)))))
    with pytest.raises(OptionError, match=r"nothing\.rec: no samples"):
        together([empty])


def test_a_player_follows_its_clock_and_stops_at_the_end() -> None:
    now, seen = [0.0], list[float]()
    player = Player(10.0, seen.append, clock=lambda: now[0])
    try:
        player.go_to(4.0)
        assert seen == [4.0]
        player.speed = 2.0
        player.play()
        now[0] = 1.0
        player.advance()
        assert player.time == pytest.approx(6.0) and player.is_playing
        now[0] = 9.0
        player.advance()
        assert player.time == 10.0 and not player.is_playing and seen[-1] == 10.0
        player.go_to(99.0)
        assert player.time == 10.0
    finally:
        player.close()


def test_a_player_goes_back_to_where_what_it_plays_begins() -> None:
    player = Player(50.0, lambda moment: None, begin=43.5)
    try:
        assert player.time == 43.5
        player.go_to(0.0)
        assert player.time == 43.5
        player.go_to(50.0)
        player.play()
        assert player.time == 43.5
    finally:
        player.close()


class TestPage:
    """Of flights, asked through its server."""

    def test_scrubbing_shows_the_state_of_that_time(self) -> None:
        pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
        from sitl.view.flight_page import FlightPage

        page = FlightPage([of_track("one", track()), of_track("two", track(side=1.5))])
        try:
            page.bar.value = 5.0
            assert tuple(page.scene.vehicles[0].body.position) == pytest.approx((10.0, 0.0, 3.0))
            assert tuple(page.scene.vehicles[1].body.position) == pytest.approx((10.0, -1.5, 3.0))
            assert np.linalg.norm(np.diff(page.scene._gap.points[0], axis=0)) == pytest.approx(1.5)
            assert "1.50 m apart" in page._state.content and "AUTO" in page._state.content
            page.jump(next(k for k, (_, text) in enumerate(page.events) if "item 2" in text))
            assert page.player.time == page.bar.value == 6.0
            assert tuple(page.scene.vehicles[0].body.position) == pytest.approx((12.0, 0.0, 3.0))
        finally:
            page.close()

    def test_it_begins_with_the_first_sample(self) -> None:
        pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
        from sitl.view.flight_page import FlightPage, band

        late = track()
        late.data[:, 0] += 300.0
        late.modes[:] = [(0.0, "GUIDED"), (305.0, "AUTO")]
        page = FlightPage([of_track("late", late)])
        try:
            assert page.bar.min == page.bar.value == 300.0 and page.bar.max == pytest.approx(310.0)
            page.bar.value = 305.0
            assert tuple(page.scene.vehicles[0].body.position) == pytest.approx((10.0, 0.0, 3.0))
            drawn = band(page.flights, page.begin, page.length)
            assert drawn.count('width="50.00%"') == 2 and 'x="0.00%"' in drawn and 'x="50.00%"' in drawn
        finally:
            page.close()

    def test_a_saved_page_is_one_file_that_needs_no_network(self, tmp_path: Path) -> None:
        pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
        from sitl.cli import main

        shutil.copy(CIRCLES, tmp_path / "circles.rec")
        file = tmp_path / "circles.html"
        assert main(["view", str(tmp_path / "circles.rec"), "--save", str(file)]) == 0
        text = file.read_text(encoding="utf-8")
        assert "__VISER_EMBED_DATA__" in text and 300_000 < len(text) < 10_000_000
        assert 'src="http' not in text and 'href="http' not in text
        assert main(["view", str(tmp_path / "none.rec")]) == 2
