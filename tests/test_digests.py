# SPDX-License-Identifier: BSD-3-Clause
"""Digests of flights: they repeat, they tell what changed, and they do not depend on how a record is laid out."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.digests import __main__ as command
from benchmarks.digests import flights as scripts
from benchmarks.digests import tree
from benchmarks.digests.compare import compare
from benchmarks.digests.leaves import leaves
from benchmarks.digests.pilot import KINDS, MODES
from benchmarks.digests.tape import Tape, packed, read, unpacked
from sitl.simulation import Core
from sitl.vehicle.copter import COPTER
from sitl.vehicle.rover import ROVER

FLIGHT = "native/power_on/copter"


def values(dtype: np.dtype[Any], value: Any) -> dict[str, bytes]:
    """Value of each leaf of a record."""
    record = np.array(value, dtype).tobytes()
    return {leaf.path: leaf.wide(record) for leaf in leaves(dtype)}


def test_leaves_do_not_depend_on_layout() -> None:
    params = np.dtype([("RC1_MIN", "f8"), ("RC2_MIN", "f8"), ("ATC_RAT_P", "f8")])
    flat = np.dtype([("vel", "f8", (3,)), ("armed", "i4"), ("thrust", "f8", (2,)), ("autopilot", [("params", params)])])
    vector = np.dtype([("x", "f8"), ("y", "f8"), ("z", "f8")])
    nested = np.dtype([("RC", [("MIN", "f8")], (2,)), ("ATC_RAT", [("P", "f8")])])
    deep = np.dtype(
        [("armed", "i8"), ("autopilot", [("params", nested)]), ("rotors", [("thrust", "f8")], (2,)), ("vel", vector)]
    )
    first = values(flat, ((1.0, 2.0, 3.0), 1, (4.0, 5.0), ((1100.0, 1200.0, 0.1),)))
    second = values(deep, (1, (([(1100.0,), (1200.0,)], (0.1,)),), [(4.0,), (5.0,)], (1.0, 2.0, 3.0)))
    second["thrust"] = second.pop("rotors.thrust")
    assert first == second
    assert len(set(first.values())) == len(first)


def tape(*values: tuple[float, str, bytes]) -> dict[str, Any]:
    """Digests of a flight that gave these values."""
    taken = Tape()
    for time, name, value in values:
        taken.add(time, name, value)
    return {"flight": {"given": taken.result()}}


def test_a_tape_tells_where_a_difference_begins() -> None:
    first = tape((0, "a", b"1"), (0, "b", b"2"), (3, "a", b"3"), (7, "b", b"4"))
    assert list(read(first["flight"]["given"])) == ["a", "b"]
    assert compare(first, first).same == ["flight"]
    other = tape((0, "a", b"1"), (0, "b", b"2"), (3, "a", b"x"), (7, "b", b"y"))
    assert compare(first, other).differing == {"flight": ["values from 3 on: a; 1 more"]}
    shorter = tape((0, "a", b"1"), (0, "b", b"2"), (3, "a", b"3"))
    assert compare(first, shorter).differing == {"flight": ["values from 7 on: b"]}
    turned = tape((0, "b", b"2"), (0, "a", b"1"), (3, "a", b"3"), (7, "b", b"4"))
    assert compare(first, turned).differing == {"flight": ["values in another order"]}


def write(path: Path) -> Path:
    """Digests of the flight, by the command line."""
    assert command.main(["write", str(path), "--only", FLIGHT]) == 0
    return path


def test_a_flight_repeats_and_a_change_is_named(
    core: Core, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    first, again = write(tmp_path / "first.json"), write(tmp_path / "again.json")
    assert first.read_bytes() == again.read_bytes()
    assert command.main(["compare", str(first), str(again)]) == 0
    changed = partial(scripts.power_on, "erle_copter", "copter", params={"ATC_RAT_RLL_P": 0.2})
    monkeypatch.setattr(command, "flights", lambda: {FLIGHT: changed})
    other = write(tmp_path / "other.json")
    capsys.readouterr()
    assert command.main(["compare", str(first), str(other)]) == 1
    assert (
        "leaves from 0.1 on: autopilot.params.ATC_RAT_RLL_P, autopilot.control.motors.roll\n" in capsys.readouterr().out
    )
    monkeypatch.setattr(
        command, "flights", lambda: {FLIGHT: partial(scripts.power_on, "erle_copter", "copter", seed=2)}
    )
    other = write(tmp_path / "other.json")
    capsys.readouterr()
    assert command.main(["compare", str(first), str(other)]) == 1
    assert "messages from 0 on: " in capsys.readouterr().out


def test_renamed_leaves_are_found_again(core: Core, tmp_path: Path) -> None:
    first = json.loads(write(tmp_path / "first.json").read_text())
    second = json.loads(json.dumps(first))
    record = second[FLIGHT]["record"]
    paths = unpacked(record["names"]).decode().replace("autopilot.estimate.", "autopilot.navigation.estimate.")
    record["names"] = packed(paths.encode())
    found = compare(first, second)
    assert found.same == [FLIGHT]
    assert "autopilot.estimate.vel" in found.leaves_only_first
    assert "autopilot.navigation.estimate.vel" in found.leaves_only_second
    names = tmp_path / "names.txt"
    names.write_text("# moved\nautopilot.estimate = autopilot.navigation.estimate\n")
    found = compare(first, second, command.read_names(names))
    assert not found.leaves_only_first and not found.leaves_only_second


def test_a_flight_that_cannot_be_flown_is_a_difference(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> None:
        raise ValueError("no engine")

    monkeypatch.setattr(command, "flights", lambda: {FLIGHT: broken})
    path = tmp_path / "broken.json"
    assert command.main(["write", str(path)]) == 1
    assert "ValueError: no engine" in path.read_text()
    assert command.main(["compare", str(path), str(path)]) == 1


def test_every_mode_and_only_real_flights_are_in_the_set() -> None:
    names = command.flights()
    for kind, firmware in (("copter", COPTER.firmware), ("rover", ROVER.firmware)):
        modes = {name: number for number, name in firmware.mode_names.items() if name != "INITIALISING"}
        assert modes == MODES[kind]
        assert all(any(f"/{kind}/{mode}-" in name for name in names) for mode in modes if mode != "AUTO")
    quick = command.chosen(None, quick=True)
    assert 0 < len(quick) < len(names) / 3
    assert all(any(command.fnmatch.fnmatch(name, each) for name in names) for each in command.QUICK)
    assert "HEARTBEAT" in KINDS


def test_what_the_tree_has_is_found_wherever_it_is() -> None:
    from sitl.turtlebots.native import Turtlebots

    assert tree.locate("Turtlebots", "sitl.robots.nowhere") is Turtlebots
    with pytest.raises(tree.TreeError, match="defines NoSuchThing"):
        tree.locate("NoSuchThing", "sitl.simulation")


def test_flights_on_other_engines_are_named_where_none_are_kept(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        command.main(["check", "--only", "jsbsim/copter/guided"])
    told = capsys.readouterr().err
    assert "left out, because no digests of other engines are kept: jsbsim/copter/guided\n" in told
    assert "none is left" in told
