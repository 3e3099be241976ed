# SPDX-License-Identifier: BSD-3-Clause
"""The same flights on every engine stay close to native's, within what docs/physics.md states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.engines import COLUMNS, FLIGHTS, Flown, difference, fly, plot, table

BOUNDS = {  # greatest absolute difference
    "erle_copter": {
        "path_rms": 0.10, "path_max": 0.20, "lean_rms": 0.3, "heading_rms": 0.5, "output_mean": 0.002,
        "energy": 0.5, "duration": 0.3, "items": 0.2,
    },
    "erle_rover": {
        "path_rms": 0.10, "path_max": 0.20, "lean_rms": 0.3, "heading_rms": 1.0, "output_mean": 0.005,
        "energy": 4.0, "duration": 0.5, "items": 0.3,
    },
}  # fmt: skip
_native: dict[tuple[str, str], Flown] = {}


def native(frame: str, flight: str) -> Flown:
    """Flown once."""
    if (frame, flight) not in _native:
        _native[frame, flight] = fly(frame, FLIGHTS[frame][flight], "native")
    return _native[frame, flight]


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["pybullet", "jsbsim"])
@pytest.mark.parametrize("frame, flight", [(frame, flight) for frame in FLIGHTS for flight in FLIGHTS[frame]])
def test_an_engine_flies_as_native(frame: str, flight: str, engine: str) -> None:
    pytest.importorskip(engine)
    flown = fly(frame, FLIGHTS[frame][flight], engine)
    found = difference(flown, native(frame, flight))
    assert np.ptp(flown.rows[:, 1:3]) > 10.0
    assert [item for _, item in flown.reached] == [item for _, item in native(frame, flight).reached]
    beyond = {name: getattr(found, name) for name, most in BOUNDS[frame].items() if abs(getattr(found, name)) > most}
    assert not beyond, found


def straight(speed: float, ends: float = 10.0) -> Flown:
    """A flight north at a speed, in two phases."""
    t = np.arange(0.0, ends + 1e-9, 0.04)
    rows = np.zeros((len(t), len(COLUMNS)))
    rows[:, 0], rows[:, 1], rows[:, 4], rows[:, 11] = t, speed * t, speed, 0.1 * speed * t
    return Flown(rows, {"out": 1.0, "on": 5.0}, [(ends - 1.0, 1)], ends)


def test_difference_of_a_slower_flight() -> None:
    found = difference(straight(1.9, 10.5), straight(2.0))
    assert found.path_max == pytest.approx(0.1 * 9.96, abs=0.02)
    assert found.energy == pytest.approx(100.0 * (0.19 * 9.48 / (0.2 * 9.0) - 1.0), abs=0.5)
    assert found.duration == pytest.approx(0.5)
    assert found.items == pytest.approx(0.5)


def test_headings_are_compared_the_short_way_round() -> None:
    one, other = straight(1.0), straight(1.0)
    one.rows[:, 9], other.rows[:, 9] = np.pi - 0.01, -np.pi + 0.01
    assert difference(one, other).heading_rms == pytest.approx(np.degrees(0.02), abs=1e-6)


def test_table_and_picture(tmp_path: Path) -> None:
    flown = {"AUTO": {"native": straight(2.0), "other": straight(1.9)}}
    assert "| path, greatest distance | m | 1.00 |" in table(flown)
    pytest.importorskip("matplotlib")
    plot(flown, "a title", tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")
