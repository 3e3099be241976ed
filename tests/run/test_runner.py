# SPDX-License-Identifier: BSD-3-Clause
"""Logs of runs, and pacing against a clock that the test moves."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.logs.tlog import LogError, TlogWriter, read_tlog
from sitl.run.runner import ClientFrames, new_file, open_log
from sitl.simulation import Core, Simulation


def test_two_runs_never_share_a_log(tmp_path: Path) -> None:
    names = [new_file(tmp_path, "copter").name for _ in range(3)]
    assert names == ["copter.tlog", "copter-2.tlog", "copter-3.tlog"]
    with pytest.raises(LogError, match="cannot be written: No such file"):
        new_file(tmp_path / "absent", "copter")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs Linux's device without room")
def test_a_full_disk_is_named_once() -> None:
    writer = TlogWriter("/dev/full", 0)
    writer.frame(0, b"frame")
    with pytest.raises(LogError, match="'/dev/full' cannot be written: No space left"):
        writer.flush()
    writer.frame(1, b"frame")
    writer.close()


def test_a_log_has_what_a_companion_with_the_vehicles_system_id_says(tmp_path: Path) -> None:
    beat = message("HEARTBEAT")
    writer = TlogWriter(tmp_path / "a.tlog", 0)
    tap = ClientFrames(writer, 1)
    for system, component in ((1, 1), (1, 191), (255, 1)):
        tap.frame(0, encode_v2(beat, beat.payload(), 0, system, component))
    writer.close()
    assert [(raw[5], raw[6]) for _, raw in read_tlog(writer.path)] == [(1, 191), (255, 1)]


def test_a_log_of_a_run_that_is_killed_goes_nearly_to_its_end(core: Core, tmp_path: Path) -> None:
    simulation = Simulation(core=core)
    path = open_log(simulation, tmp_path, "run")
    simulation.advance(10.0)
    stamps = [stamp for stamp, _ in read_tlog(path)]
    assert stamps[-1] - stamps[0] > 6_000_000
    simulation.close()
