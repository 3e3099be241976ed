# SPDX-License-Identifier: BSD-3-Clause
"""``sitl view``: which flights are shown with which clock and curves, where the page goes, without a browser."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.errors import OptionError
from sitl.logs.track import Track
from sitl.missions import view
from sitl.missions.comparison.alignment import AlignmentError
from sitl.missions.comparison.flight import Flight
from sitl.recording.entries import RecordingError
from tests.missions.comparison.conftest import straight
from tests.missions.comparison.test_tracks import later, moved


@pytest.fixture(autouse=True)
def drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """What of a flight is drawn: its name, its track, the airframe that was asked for."""
    monkeypatch.setattr(view, "of_track", lambda name, track, frame: (name, track, frame))


def together(*flights: Flight, **given: Any) -> tuple[list[Any], dict[str, Any]]:
    found: Any = view.together(list(flights), **given)
    return found  # type: ignore[no-any-return]


def waiting() -> Track:
    """Armed after 3 s, in AUTO after 5."""
    return replace(straight(20.0, wait=5.0), armed=[(3.0, True)], modes=[(0.0, "GUIDED"), (5.0, "AUTO")])


@pytest.mark.parametrize(("align", "length"), [("auto", 25.0), ("start", 25.0), ("armed", 22.0), ("AUTO", 20.0)])
def test_one_flight_is_shown_as_it_was_logged_or_from_a_moment_on(align: str, length: float) -> None:
    ((name, track, frame),), curves = together(Flight("logs/my.flight.bin", waiting()), align=align, frame="quad")
    assert (name, frame, curves) == ("my.flight", "quad", {})
    assert (track.t[0], track.t[-1]) == pytest.approx((0.0, length))


def test_without_samples_or_the_moment_there_is_nothing_to_show() -> None:
    none = replace(straight(), data=np.zeros((1, 11)))
    with pytest.raises(OptionError, match=r"a\.bin: no samples: its estimator never had an origin"):
        together(Flight("a.bin", none))
    with pytest.raises(AlignmentError, match="'armed': there is no such moment"):
        together(Flight("a.bin", replace(straight(), armed=[])), align="armed")
    two = replace(straight(), data=straight().data[:2])
    assert len(together(Flight("a.bin", two))[0]) == 1
    with pytest.raises(AlignmentError, match=r"b\.bin has no samples"):
        together(Flight("a.bin", straight()), Flight("b.bin", none))


def test_several_flights_have_the_clock_of_the_first_and_curves_of_the_second() -> None:
    second, third = later(moved(straight(), slice(1, 3), (0.3, 0.4)), 7.0), later(straight(), 2.0)
    flights, curves = together(Flight("a.rec", straight()), Flight("b.tlog", second), Flight("c.bin", third))
    assert [name for name, *_ in flights] == ["a", "b", "c"]
    for _, track, frame in flights:
        assert (track.t[0], track.t[-1], frame) == (0.0, pytest.approx(20.0), None)
    assert flights[1][1]["north"][0] == pytest.approx(0.3)
    assert list(curves) == ["position at the same time [m]", "cross-track [m]"]
    times, sizes = curves["position at the same time [m]"]
    assert len(times) == len(sizes) == 201 and sizes == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("coarse", [(False, False), (True, False), (False, True)])
def test_clocks_of_a_ground_stations_log_are_brought_together(coarse: tuple[bool, bool]) -> None:
    track = straight(20.0, wait=5.0)
    late = replace(track, modes=[(0.0, "GUIDED"), (0.7, "AUTO")], armed=[(0.0, True)])
    _, curves = together(Flight("a", track, coarse=coarse[0]), Flight("b", late, coarse=coarse[1]))
    _, sizes = curves["position at the same time [m]"]
    assert sizes.max() == pytest.approx(0.0 if any(coarse) else 1.4, abs=0.05)


# ---------------------------------------------------------------- the command


class Page:
    def __init__(self, flights: Any, curves: Any, port: int) -> None:
        self.flights, self.curves, self.port, self.closed = flights, curves, port, False
        self.saved: Path | None = None
        self.address = "http://127.0.0.1:1234"
        Page.last = self

    last: Page

    def save(self, path: Path) -> None:
        self.saved = path

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Any:
    asked: list[Any] = []

    def read(path: Path, system: int | None, progress: Any) -> Flight:
        asked.append((path, system))
        if path.suffix == ".bad":
            raise RecordingError(f"{path} is cut off")
        return Flight(str(path), straight(), notes=("was flown again",) if path.suffix == ".rec" else ())

    monkeypatch.setattr(view.page_library, "require", lambda: None)
    monkeypatch.setattr(view.flight, "read", read)
    monkeypatch.setattr(view, "FlightPage", Page)
    opened: list[str] = []
    monkeypatch.setattr(view, "open_browser", opened.append)

    def made(*words: str) -> Any:
        parser = argparse.ArgumentParser()
        view.add_parser(parser.add_subparsers())
        options = parser.parse_args(["view", *words])
        return SimpleNamespace(code=options.function(options), asked=asked, opened=opened, page=Page.last)

    return made


def test_a_file_is_written_and_the_page_closed(run: Any, capsys: pytest.CaptureFixture[str]) -> None:
    found = run("a.rec", "b.tlog", "--save", "x.html", "--system", "3", "--frame", "quad", "--view-port", "8080")
    assert found.code == 0 and found.asked == [(Path("a.rec"), 3), (Path("b.tlog"), 3)] and found.opened == []
    assert (found.page.saved, found.page.closed, found.page.port) == (Path("x.html"), True, 8080)
    assert [name for name, *_ in found.page.flights] == ["a", "b"] and len(found.page.curves) == 2
    assert found.page.flights[0][2] == "quad"
    assert capsys.readouterr().out == "a.rec: was flown again\npage: x.html\n"


def test_a_page_is_shown_until_it_is_stopped(
    run: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Signals:
        def __init__(self, then: Any) -> None:
            self.then = then

        def __enter__(self) -> Signals:
            return self

        def __exit__(self, *_: Any) -> None: ...

        def catch(self) -> None:
            self.then()  # Ctrl-C, at once

    monkeypatch.setattr(view, "StopSignals", Signals)
    found = run("b.tlog")
    assert (found.code, found.opened, found.page.closed, found.page.saved) == (0, [Page.last.address], True, None)
    assert (found.page.port, found.page.curves) == (
        0,
        {},
    ) and capsys.readouterr().out == "page: http://127.0.0.1:1234\n"


def test_a_recording_that_cannot_be_read_is_named(run: Any) -> None:
    with pytest.raises(OptionError, match=r"x\.bad is cut off"):
        run("b.tlog", "x.bad")
