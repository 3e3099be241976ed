# SPDX-License-Identifier: BSD-3-Clause
"""Flights are the same on every machine, to the last bit: as their digests are kept in ``digests.json``."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest

from benchmarks.digests import __main__ as command
from benchmarks.digests import flights as scripts
from benchmarks.digests import kept, tree
from sitl.errors import MissingExtra
from sitl.simulation import Core

FILE = tree.root() / kept.FILE
QUICK = [name for name in command.chosen(None, quick=True) if command.is_kept(name)]
FLIGHT = "native/power_on/copter"
WHAT_TO_DO = f"""
If flights are meant to change, say so in CHANGELOG.md, and keep the new ones:
    {kept.RENEW} --jobs 2
If they are not, something depends on the machine, or a change of code changed them. What differs, and when:
docs/digests.md says how to find it."""


def check(names: list[str]) -> None:
    """They fly as they are kept, bit for bit."""
    found = command.check(FILE, names, jobs=1)
    assert not found, "\n".join([f"{len(found)} of {len(names)} flights differ from {kept.FILE}:", *found, WHAT_TO_DO])


def test_flights_are_the_same_as_on_other_machines(core: Core) -> None:
    check(QUICK)


@pytest.mark.slow
def test_all_flights_are_the_same_as_on_other_machines(core: Core) -> None:
    check([name for name in command.flights() if name not in QUICK])


def test_every_flight_is_kept_and_every_kept_one_is_flown() -> None:
    assert set(kept.load(FILE)) == {name for name in command.flights() if command.is_kept(name)}
    assert FILE.stat().st_size < 150_000


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    before = kept.load(FILE)
    kept.write(tmp_path / "again.json", before)
    assert (tmp_path / "again.json").read_bytes() == FILE.read_bytes()


def record(path: Path) -> dict[str, kept.Kept]:
    """Digests of the flight, by the command line."""
    assert command.main(["record", "--file", str(path), "--only", FLIGHT]) == 0
    return kept.load(path)


def test_a_change_is_named_with_its_time_and_field(
    core: Core, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "kept.json"
    record(path)
    arguments = ["check", "--file", str(path), "--only", FLIGHT]
    assert command.main(arguments) == 0
    changed = partial(scripts.power_on, "erle_copter", "copter", seed=2)
    monkeypatch.setattr(command, "flights", lambda: {FLIGHT: changed})
    capsys.readouterr()
    assert command.main(arguments) == 1
    said = capsys.readouterr().out
    assert f"{FLIGHT}: between 0 and 8 s: " in said and "rng.s" in said and "1 of 1 flights differ" in said


def test_a_flight_that_needs_what_is_not_installed_is_left_out_and_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Fails:
        def __init__(self, error: Exception) -> None:
            self.error = error

        def result(self) -> None:
            raise self.error

    missing, wrong = MissingExtra("it needs PettingZoo"), ValueError("it is wrong")
    monkeypatch.setattr(command, "flights", lambda: {"a": lambda: Fails(missing), "b": lambda: Fails(wrong)})
    (found,) = command.check(FILE, ["a", "b"], jobs=1)
    assert found.startswith("b: it cannot be flown: ValueError: it is wrong")
    printed = capsys.readouterr()
    assert "left out: a: it needs PettingZoo" in printed.err and "1 of 1 flights differ" in printed.out


def test_one_bit_of_one_field_is_a_difference_and_a_new_field_of_the_record_is_none() -> None:
    flight = kept.load(FILE)["native/copter/world"]
    title = "physics.body.pos"
    row = flight.rows[title]
    other = bytearray(row.steps)
    other[5] ^= 1
    changed = flight._replace(rows=flight.rows | {title: row._replace(steps=bytes(other), check_sum=1)})
    assert kept.difference(flight, changed) == "between 40 and 48 s: physics.body.pos"
    assert kept.difference(flight, flight._replace(end=1.0)) == f"it ends at 1 s, not at {flight.end:g}"
    assert kept.difference(flight, flight) == ""
    full = {"end": 1.0, "record": _tape("physics.body.pos"), "telemetry": _tape("STATUSTEXT")}
    more = {"end": 1.0, "record": _tape("physics.body.pos", "autopilot.new"), "telemetry": _tape("STATUSTEXT", "NEW")}
    assert kept.keep(json.loads(json.dumps(full))) == kept.keep(more)


def _tape(*names: str) -> dict[str, object]:
    from benchmarks.digests.tape import Tape

    taken = Tape()
    for name in names:
        taken.add(0.0, name, name.encode())
    return taken.result()
