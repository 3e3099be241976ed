# SPDX-License-Identifier: BSD-3-Clause
"""Golden flights of foreign autopilots as digests: written, compared second by second, damaged."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.missions.testing import digests


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "arducopter"
    path.write_bytes(b"a program")
    return path


def flight(program: Path, *found: str, frame: str = "erle_copter") -> Any:
    """As much of a flight as digests are of."""
    vehicle = SimpleNamespace(airframe=SimpleNamespace(name=frame))
    process, plant = SimpleNamespace(command=[str(program), "-S"]), SimpleNamespace(vehicle=vehicle)
    return SimpleNamespace(process=process, plant=plant, digests=list(found))


def test_a_flight_is_written_once(program: Path, tmp_path: Path) -> None:
    path = tmp_path / "golden" / "hop.digests"
    assert digests.write(path, flight(program, "a", "b")) is True
    assert digests.write(path, flight(program, "a", "b")) is False
    assert digests.write(path, flight(program, "a", "c")) is True
    values = json.loads(path.read_text())
    sha256 = "d69ea8cda2433733c1ce02de65da8f48e6a3dbba6bb18876a2062908e54ef7cb"
    assert values == {
        "format": "gym-sitl digests 1", "program": "arducopter", "program_sha256": sha256, "frame": "erle_copter",
        "digests": ["a", "c"],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("now", "told"),
    [
        (("a", "b", "c"), []),
        (("x", "b", "c"), ["DIFFERS: true states are other ones between 0 and 1 s of simulated time"]),
        (("a", "x", "y"), ["DIFFERS: true states are other ones between 1 and 2 s of simulated time"]),
        (("a", "b", "x"), ["DIFFERS: true states are other ones between 2 and 3 s of simulated time"]),
        (("a", "b"), ["DIFFERS: the flight has 2 s of simulated time, golden 3"]),
        (("a", "x"), ["DIFFERS: the flight has 2 s of simulated time, golden 3"]),  # its last is of no whole second
        (("a", "b", "x", "d"), ["DIFFERS: the flight has 4 s of simulated time, golden 3"]),
        (("a", "x", "c", "d"), ["DIFFERS: true states are other ones between 1 and 2 s of simulated time"]),
    ],
)
def test_the_first_second_that_differs_is_named(
    program: Path, tmp_path: Path, now: tuple[str, ...], told: list[str]
) -> None:
    path = tmp_path / "hop.digests"
    digests.write(path, flight(program, "a", "b", "c"))
    found = digests.differences(path, flight(program, *now))
    assert found == ([f"golden flight {path}", *told] if told else [])


def test_another_program_or_frame_is_told_where_the_flight_differs(program: Path, tmp_path: Path) -> None:
    path = tmp_path / "hop.digests"
    digests.write(path, flight(program, "a", "b", "c"))
    other = tmp_path / "ardurover"
    other.write_bytes(b"another")
    found = digests.differences(path, flight(other, "x", "b", "c", frame="erle_rover"))
    assert [line.split(":")[1].split(" is ")[0].strip() for line in found[2:]] == ["program", "program_sha256", "frame"]
    assert found[2] == "  note: program is another one: arducopter -> ardurover"
    assert digests.differences(path, flight(other, "a", "b", "c")) == [], "it flies the same: nothing is wrong"


@pytest.mark.parametrize(
    "data", [b"", b"[]", b"{}", b'{"digests": []}', b'{"format": "x", "digests": []}', b"[" * 100_000, b"\xff\xfe"]
)
def test_a_file_that_is_none_says_so(program: Path, tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "hop.digests"
    path.write_bytes(data)
    (text,) = digests.differences(path, flight(program, "a"))
    assert text == f"golden flight {path} cannot be used: it is no file of 'gym-sitl digests 1'"
