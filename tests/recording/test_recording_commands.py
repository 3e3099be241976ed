# SPDX-License-Identifier: BSD-3-Clause
"""``--rec``, ``--from`` and ``sitl mission replay``, as a user types them."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path

import pytest

import sitl.cli
from sitl.cli import run
from sitl.cli.recordings import resume
from sitl.client.endpoint import Endpoint
from sitl.errors import SitlError
from sitl.missions.cli import replay
from sitl.recording.entries import RecordingError
from sitl.recording.recorder import Recorder
from sitl.recording.recording import read
from sitl.recording.replay import Replay
from sitl.run.standstill import serve_lockstep
from sitl.simulation import Core, Simulation
from tests.recording.conftest import Recorded, hop


def typed(text: str) -> int:
    """Exit code of ``replay ...`` or ``run ...``."""
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers()
    replay.add_parser(commands)
    run.add_parser(commands)
    options = parser.parse_args(shlex.split(text))
    return int(options.function(options))


def test_a_flight_again(hopped: Recorded, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert typed(f"replay {hopped.path} --log-dir {tmp_path} --rec {tmp_path}/new.rec") == 0
    said = capsys.readouterr().out
    assert "flown 62.000 s" in said and "the same flight: all telemetry is the same, byte for byte" in said
    assert read(tmp_path / "new.rec").end == read(hopped.path).end
    assert (tmp_path / "hop-replay.tlog").stat().st_size > 50_000


def test_a_snapshot_goes_on_live(hopped: Recorded, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    snapshot, live = tmp_path / "at50.rec", tmp_path / "live.rec"
    assert typed(f"replay {hopped.path} --until 50 --snapshot {snapshot}") == 0
    recording = read(snapshot)
    assert recording.end_us == 50_000_000
    assert recording.end is not None and recording.end["stopped"] == "--until"
    where = f"--log-dir {tmp_path} --tcp 0 --out none --quiet --speedup max"
    assert typed(f"run copter --from {snapshot} --rec {live} --duration 4 {where}") == 0
    whole = read(live)
    assert whole.end_us == 54_000_000 and len(whole.entries) > len(recording.entries)
    assert typed(f"replay {live} --exact") == 0
    assert "byte for byte" in capsys.readouterr().out


def test_a_run_that_goes_on_has_two_logs_in_its_replay(hopped: Recorded, tmp_path: Path) -> None:
    words = f"run copter --rec {tmp_path}/first.rec --duration 3 --tcp 0 --out none --quiet --speedup max"
    assert typed(f"{words} --log-dir {tmp_path}/first") == 0
    words = f"run copter --from {tmp_path}/first.rec --rec {tmp_path}/whole.rec --duration 2 --tcp 0 --out none --quiet"
    assert typed(f"{words} --speedup max --log-dir {tmp_path}/second") == 0
    assert typed(f"replay {tmp_path}/whole.rec --exact --log-dir {tmp_path}/again") == 0
    for folder, name in (("first", "whole-replay"), ("second", "whole-replay-2")):
        log = tmp_path / folder / "erle_copter-0.tlog"
        assert log.read_bytes() == (tmp_path / "again" / f"{name}.tlog").read_bytes()


def test_lockstep_goes_on_from_a_snapshot(hopped: Recorded, tmp_path: Path) -> None:
    options = argparse.Namespace(
        from_file=hopped.path, rec=tmp_path / "live.rec", frame=None, world=None, vehicle="copter", home=None,
        start=None,
        seed=None, params=None, physics="native", estimator="ekf", lockstep=True,
    )  # fmt: skip
    simulation = resume(options)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    reached: list[int] = []

    def step() -> None:
        reached.extend(f.fields.result_param2 for f in client.receive() if f.name == "COMMAND_ACK")
        if not reached:
            client.send("COMMAND_INT", target_system=1, target_component=1, command=31010, x=63_000)

    step()
    serve_lockstep(simulation, running=lambda: not reached, on_slice=step)
    simulation.close()
    assert simulation.time_us == 63_000_000 and reached[0] == 63_000
    assert typed(f"replay {tmp_path}/live.rec --exact") == 0


def test_who_goes_on_from_lockstep_without_it_has_no_grants(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    Recorder(simulation, tmp_path / "lockstep.rec")
    simulation.bridge.push_clock()
    simulation.advance(1.0)
    simulation.close()
    replay = Replay(read(tmp_path / "lockstep.rec"), core=core, record=tmp_path / "live.rec")
    assert replay.run() == [] and replay.simulation.bridge.grants is not None
    live = replay.go_live()
    assert live.bridge.grants is None
    client = Endpoint()
    live.bridge.add_link(client.link)
    client.send("COMMAND_INT", target_system=1, target_component=1, command=31010, x=9_000)
    live.advance(1.0)
    assert [f.fields.result for f in client.receive() if f.name == "COMMAND_ACK"] == [3]  # UNSUPPORTED
    live.close()
    assert Replay(read(tmp_path / "live.rec"), core=core).run() == []


def test_what_from_does_not_take(hopped: Recorded, tmp_path: Path) -> None:
    with pytest.raises(SitlError, match="--seed: with --from the recording decides"):
        typed(f"run copter --from {hopped.path} --seed 3 --tcp 0 --out none --log-dir {tmp_path}")
    with pytest.raises(SitlError, match="is of a copter, not of a rover"):
        typed(f"run rover --from {hopped.path} --tcp 0 --out none --log-dir {tmp_path}")
    with pytest.raises(SitlError, match="exists already"):
        typed(f"run copter --rec {hopped.path} --tcp 0 --out none --log-dir {tmp_path}")
    with pytest.raises(SitlError, match="--home: the recording decides that"):
        typed(f"replay {hopped.path} --home 1,2,3,4")


def test_a_snapshot_that_leads_elsewhere_is_refused(core: Core, tmp_path: Path) -> None:
    path, new = tmp_path / "hop.rec", tmp_path / "new.rec"
    hop(path, core)
    with pytest.raises(
        RecordingError, match=r"does not lead to the same place.*\(airframe erle_copter -> ardupilot_quad"
    ):
        typed(f"run copter --from {path} --frame ardupilot_quad --tcp 0 --out none --log-dir {tmp_path} --rec {new}")
    assert not new.exists()


def test_a_cut_recording(hopped: Recorded, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cut = tmp_path / "cut.rec"
    cut.write_bytes(hopped.path.read_bytes()[:-20])
    assert issubclass(RecordingError, SitlError)
    with pytest.raises(RecordingError, match="sitl mission replay --unfinished"):
        typed(f"replay {cut}")
    assert typed(f"replay {cut} --unfinished") == 0
    assert "it is flown up to 60.000 s" in capsys.readouterr().err


def test_a_run_keeps_a_recording(tmp_path: Path) -> None:
    words = f"run rover --rec {tmp_path}/r.rec --duration 3 --tcp 0 --out none --quiet --speedup max"
    assert sitl.cli.main([*shlex.split(words), "--log-dir", str(tmp_path)]) == 0
    recording = read(tmp_path / "r.rec")
    assert recording.end is not None and recording.end["stopped"] == "--duration"
    assert typed(f"replay {tmp_path}/r.rec --exact --log-dir {tmp_path}/again") == 0
    first, second = (tmp_path / "erle_rover-0.tlog"), (tmp_path / "again" / "r-replay.tlog")
    assert first.read_bytes() == second.read_bytes()
