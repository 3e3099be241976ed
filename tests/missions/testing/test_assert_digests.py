# SPDX-License-Identifier: BSD-3-Clause
"""``assert_flies_like`` with a golden flight that is digests: whose flights they are of, when one is written."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.envs.mavlink.foreign import Foreign
from sitl.errors import OptionError
from sitl.missions.testing import digests
from sitl.missions.testing.golden import Golden, GoldenStore


class Flight(Foreign):
    """As much of a flight with a foreign autopilot as digests need."""

    def __init__(self, program: Path, *found: str, repeats: bool = True) -> None:
        vehicle: Any = SimpleNamespace(airframe=SimpleNamespace(name="erle_copter"))
        self.process = SimpleNamespace(command=[str(program)])  # type: ignore[assignment]
        self.plant = SimpleNamespace(vehicle=vehicle)  # type: ignore[assignment]
        self.digests, self.repeats = list(found), repeats


def vehicle(tmp_path: Path, connection: Any, **store: Any) -> Any:
    made: Any = object.__new__(Golden)
    made.golden = GoldenStore(folder=tmp_path, how="write it", test="test_hop", **store)
    made.connection = connection
    return made


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "arducopter"
    path.write_bytes(b"a program")
    return path


def test_digests_are_of_flights_that_repeat(tmp_path: Path, program: Path) -> None:
    for connection in (Flight(program, "a", repeats=False), SimpleNamespace(repeats=True)):
        with pytest.raises(OptionError, match=r"\.digests is of flights with an ArduPilot that was started here"):
            vehicle(tmp_path, connection).assert_flies_like("hop.digests")


@pytest.mark.parametrize("tolerance", ["same", "0.5 m", {"base": "exact"}])
def test_digests_have_no_tolerance(tmp_path: Path, program: Path, tolerance: Any) -> None:
    with pytest.raises(OptionError, match="digests are compared exactly"):
        vehicle(tmp_path, Flight(program, "a")).assert_flies_like("hop.digests", tolerance)


def test_without_golden_it_says_how_to_make_one(tmp_path: Path, program: Path) -> None:
    with pytest.raises(AssertionError, match=r"there is no golden flight .*to write it from this flight: write it"):
        vehicle(tmp_path, Flight(program, "a")).assert_flies_like("hop.digests")
    assert not (tmp_path / "hop.digests").exists()


@pytest.mark.parametrize("tolerance", [None, "exact"])
def test_another_flight_is_told(tmp_path: Path, program: Path, tolerance: Any) -> None:
    digests.write(tmp_path / "hop.digests", Flight(program, "a", "b", "c"))
    vehicle(tmp_path, Flight(program, "a", "b", "c")).assert_flies_like("hop.digests", tolerance)
    with pytest.raises(
        AssertionError, match=r"between 1 and 2 s of simulated time\n  if the change is intended: write"
    ):
        vehicle(tmp_path, Flight(program, "a", "x", "c")).assert_flies_like("hop.digests", tolerance)


def test_golden_is_written_when_that_is_asked_for(tmp_path: Path, program: Path) -> None:
    made = vehicle(tmp_path, Flight(program, "a"), update=True)
    made.assert_flies_like("hop.digests")
    assert made.golden.written == [tmp_path / "hop.digests"]
    with pytest.raises(
        AssertionError, match="is already used by another flight of test_hop; each flight needs its own"
    ):
        made.assert_flies_like("hop.digests")
    again = vehicle(tmp_path, Flight(program, "a"), update=True)
    again.assert_flies_like("hop.digests")
    assert again.golden.written == [], "it was this flight already"
