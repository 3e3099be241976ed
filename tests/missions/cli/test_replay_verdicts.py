# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission replay``: its exit codes, the logs that it opens, and a .tlog that is flown, without a vehicle."""

from __future__ import annotations

import argparse
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.errors import OptionError
from sitl.missions.cli import replay
from sitl.missions.tlog_replay.fly_script import Report
from sitl.missions.tlog_replay.steps import Send, Upload
from tests.missions.cli.test_replay_words import Flown


def flown(differences: Any = (), other_version: bool = False, is_over: bool = True, has_digests: bool = True) -> Any:
    recording = SimpleNamespace(has_digests=has_digests)
    return SimpleNamespace(differences=differences, other_version=other_version, is_over=is_over, recording=recording)


@pytest.mark.parametrize(
    ("differences", "astray", "exact", "code"),
    [
        ((), [], False, 0),
        ((), [], True, 0),
        (("version",), [], False, 0),
        (("version",), [], True, 1),
        ((), ["state"], False, 1),
        ((), ["state"], True, 1),
        (("version",), ["state"], False, 0),  # another version may fly otherwise
        (("version",), ["state"], True, 1),
    ],
)
def test_the_exit_code(differences: Any, astray: list[str], exact: bool, code: int, capsys: Any) -> None:
    assert replay.verdict(flown(differences), astray, exact) == code
    out = capsys.readouterr().out
    assert ("changed since the recording: version\n" in out) == bool(differences)
    assert ("the flight differs: state\n" in out) == bool(astray) and ("the same flight" in out) == (not astray)


@pytest.mark.parametrize(("is_over", "has_digests"), [(True, True), (True, False), (False, True)])
def test_all_telemetry_is_the_same_where_all_was_flown_and_kept(is_over: bool, has_digests: bool, capsys: Any) -> None:
    replay.verdict(flown(is_over=is_over, has_digests=has_digests), [], False)
    whole = is_over and has_digests
    told = "the same flight" + (": all telemetry is the same, byte for byte" if whole else " as far as digests tell")
    assert capsys.readouterr().out == told + "\n"


@pytest.mark.parametrize("other", [True, False])
def test_another_version_is_a_reason(other: bool, capsys: Any) -> None:
    replay.verdict(flown(other_version=other), ["a", "b"], False)
    out = capsys.readouterr().out.splitlines()
    assert out[0] == "the flight differs: a; b" and len(out) == 1 + other
    assert not other or out[1].startswith("another version of the simulator made the recording: the same version")


# ---------------------------------------------------------------- what is not taken


def options(tmp_path: Path, *words: str, name: str = "a.rec") -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    replay.add_parser(parser.add_subparsers())
    return parser.parse_args(["replay", str(tmp_path / name), "--quiet", *words])


@pytest.mark.parametrize(
    ("name", "words", "error"),
    [
        ("a.rec", ("--rec", "x", "--snapshot", "y"), "--snapshot is a recording, too: give it or --rec"),
        ("a.rec", ("--seed", "3"), "--seed: the recording decides that"),
        ("a.rec", ("--home", "1,2,3,4", "--start", "x"), "--home, --start: the recording decides that"),
        ("a.rec", ("--estimator", "truth"), "--estimator: the recording decides that"),
        ("a.tlog", ("--unfinished",), "--unfinished and --exact are for recordings; a log has no such thing"),
        ("A.TLOG", ("--exact",), "--unfinished and --exact are for recordings; a log has no such thing"),
    ],
)
def test_what_the_file_decides_is_named(tmp_path: Path, name: str, words: tuple[str, ...], error: str) -> None:
    with pytest.raises(OptionError) as told:
        replay.replay(options(tmp_path, *words, name=name))
    assert str(told.value) == error


@pytest.mark.parametrize("terrain", [None, "other"])
def test_terrain_is_the_recordings(tmp_path: Path, terrain: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    recording = SimpleNamespace(fault="", header={} if terrain is None else {"terrain": terrain})
    monkeypatch.setattr(replay, "read", lambda path, unfinished: recording)
    given = options(tmp_path)
    given.terrain = "srtm"
    with pytest.raises(OptionError, match="--terrain: the recording decides that"):
        replay.replay(given)


# ---------------------------------------------------------------- logs


class Writer:
    def __init__(self, path: Path, epoch_us: int) -> None:
        self.path, self.epoch_us, self.closed = path, epoch_us, False

    def close(self) -> None:
        self.closed = True


def test_a_replay_opens_a_log_for_each_that_the_recorded_run_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(replay, "TlogWriter", Writer)
    bridge = SimpleNamespace(epoch_us=5, system=7, taps=[], client_taps=[])
    simulation: Any = SimpleNamespace(bridge=bridge)
    kept = replay.ReplayLog("a", tmp_path)
    assert kept.paths == [tmp_path / "a-replay.tlog"] and kept.path.exists()
    kept.close()
    first: Any = kept(simulation)
    assert (first.path, first.epoch_us, first.closed) == (tmp_path / "a-replay.tlog", 5, False)
    assert bridge.taps == [] and len(bridge.client_taps) == 1
    second: Any = kept(simulation, everything=True)
    assert first.closed and not second.closed and second.path == kept.path == tmp_path / "a-replay-2.tlog"
    assert bridge.taps == [second] and len(bridge.client_taps) == 1
    kept.close()
    assert second.closed and kept.paths == [tmp_path / "a-replay.tlog", tmp_path / "a-replay-2.tlog"]


# ---------------------------------------------------------------- a recording


@pytest.mark.parametrize(("slice_us", "steps"), [(None, 6), (50_000, 21)])
def test_a_recording_is_flown_by_steps_with_a_status_after_each(
    slice_us: int | None, steps: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    done: list[str] = []
    recording = SimpleNamespace(fault="ends within an entry", end_us=1_000_000, header={}, entries=[], has_digests=True)
    monkeypatch.setattr(replay, "read", lambda path, unfinished: recording)
    monkeypatch.setattr(replay, "Replay", Flown)
    status = SimpleNamespace(refresh=lambda: done.append("status"), close=lambda: done.append("closed"))
    monkeypatch.setattr(replay, "StatusLine", lambda simulation, enabled: done.append(f"on: {enabled}") or status)
    pace = SimpleNamespace(speedup=slice_us, slice_us=slice_us, after_slice=lambda simulation: done.append("paced"))
    monkeypatch.setattr(replay, "Pacing", lambda speedup: pace)
    given = options(tmp_path, "--snapshot", str(tmp_path / "s.rec"))
    assert replay.replay(given) == 0
    assert len(Flown.last.steps) == steps and done == ["on: False", *["status", "paced"] * (steps - 1), "closed"]
    out, err = capsys.readouterr()
    assert err == f"{tmp_path / 'a.rec'} ends within an entry; it is flown up to 1.000 s\n"
    assert out.splitlines()[1] == f"snapshot: {tmp_path / 's.rec'}"
    given.quiet = False
    done.clear()
    replay.replay(given)
    assert done[0] == "on: True"


# ---------------------------------------------------------------- a .tlog


class Vehicle:
    """A simulation whose time passes, and that is closed."""

    def __init__(self) -> None:
        self.time_us, self.closed, self.targets = 0, False, []

    targets: list[int]

    def advance_to(self, time_us: int) -> None:
        self.time_us = time_us
        self.targets.append(time_us)

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def fly(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Flies a log of 12.34 s with a message and an upload; gives the exit code and what was asked for."""

    def run(*words: str, report: Report | None = None, slice_us: int | None = None) -> tuple[int, Any]:
        made = SimpleNamespace(vehicle=Vehicle(), refreshed=0, paced=0, until="?", why="")
        steps = [Send(1.0, (255, 190), "HEARTBEAT", {}), Upload(2.0, (255, 190), ())]
        script = SimpleNamespace(steps=steps, home=(1.0, 2.0, 3.0, 4.0), parameters={"RTL_ALT": 900.0})
        monkeypatch.setattr(replay, "Log", lambda file, system: SimpleNamespace(system=system or 1, kind="rover",
                                                                                duration=12.34))  # fmt: skip
        monkeypatch.setattr(replay, "extract", lambda log: script)

        def build(given: Any, parameters: Any) -> Vehicle:
            made.built = (given.vehicle, given.home, parameters)
            return made.vehicle  # type: ignore[no-any-return]

        class Flight:
            def __init__(self, simulation: Any, found: Any, advance: Any) -> None:
                assert simulation is made.vehicle and found is script
                self.advance = advance

            def fly(self, until_us: int | None) -> Report:
                made.until = until_us
                self.advance(400_000)
                return report or Report()

        def refresh() -> None:
            made.refreshed += 1

        def after(simulation: Any) -> None:
            made.paced += 1

        monkeypatch.setattr(replay, "build_simulation", build)
        monkeypatch.setattr(replay, "LogFlight", Flight)
        monkeypatch.setattr(replay.recordings, "say_why", lambda simulation, why: setattr(made, "why", why))
        monkeypatch.setattr(replay, "Recorder", lambda simulation, path: setattr(made, "recorded", path))
        monkeypatch.setattr(replay.runner, "open_log", lambda simulation, folder, name: folder / f"{name}.tlog")
        monkeypatch.setattr(replay, "StatusLine", lambda *_: SimpleNamespace(refresh=refresh, close=lambda: None))
        pace = SimpleNamespace(speedup=None if slice_us is None else 1.0, slice_us=slice_us, after_slice=after)
        monkeypatch.setattr(replay, "Pacing", lambda speedup: pace)
        given = options(tmp_path, *words, name="f.tlog")
        return replay.replay(given), made

    return run


def test_a_log_is_flown_by_its_own_kind_of_vehicle_from_its_home(fly: Any, tmp_path: Path, capsys: Any) -> None:
    code, made = fly()
    assert code == 0 and made.built == ("rover", (1.0, 2.0, 3.0, 4.0), {"RTL_ALT": 900.0})
    assert (made.until, made.why, made.vehicle.closed) == (None, "end of the log", True)
    assert made.vehicle.targets == [400_000] and made.refreshed == made.paced == 1
    out = capsys.readouterr().out.splitlines()
    assert out[0] == f"{tmp_path / 'f.tlog'}: vehicle 1 is a rover, 12.3 s, 2 steps, 1 mission uploads"
    assert out[1].startswith("flown 0.400 s in ") and out[1].endswith("x real time") and len(out) == 2
    code, made = fly("--until", "5", "--home", "5,6,7,8", slice_us=50_000)
    assert (made.until, made.why) == (5_000_000, "--until") and made.built[1] == (5.0, 6.0, 7.0, 8.0)
    assert made.vehicle.targets == [50_000], "as the pace has it"


@pytest.mark.parametrize(
    ("waited", "lines"),
    [(0.049, []), (0.05, ["0.1 s later than in the log: this vehicle had to get ready"]),
     (3.0, ["3.0 s later than in the log: this vehicle had to get ready"])],
)  # fmt: skip
def test_how_long_it_waited_is_told(waited: float, lines: list[str], fly: Any, capsys: Any) -> None:
    assert fly(report=Report(waited=waited))[0] == 0
    assert capsys.readouterr().out.splitlines()[2:] == lines


def test_notes_are_no_fault_and_faults_are_code_1(fly: Any, capsys: Any) -> None:
    assert fly(report=Report(notes=["n"]))[0] == 0
    assert capsys.readouterr().out.splitlines()[2:] == ["note: n"]
    assert fly(report=Report(notes=["n"], faults=["f", "g"]))[0] == 1
    assert capsys.readouterr().out.splitlines()[2:] == [
        "note: n", "otherwise than in the log: f", "otherwise than in the log: g",
    ]  # fmt: skip


def test_files_that_were_written_are_named(fly: Any, tmp_path: Path, capsys: Any) -> None:
    rec = tmp_path / "x.rec"
    _, made = fly("--rec", str(rec))
    assert made.recorded == rec
    assert capsys.readouterr().out.splitlines()[2:] == [f"recording: {rec}"]
    fly("--snapshot", str(tmp_path / "y.rec"))
    assert capsys.readouterr().out.splitlines()[2:] == [f"snapshot: {tmp_path / 'y.rec'}"]
