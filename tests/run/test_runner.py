# SPDX-License-Identifier: BSD-3-Clause
"""Logs of runs, and pacing against a clock that the test moves."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.logs.tlog import LogError, TlogWriter, read_tlog
from sitl.run.pacing import Pacing, SpeedupError, parse_speedup
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


class Clock:
    """A wall clock in the test's hand."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


def test_waits_make_the_speedup() -> None:
    clock = Clock()
    pacing = Pacing(5.0, clock)
    start, simulated = clock.now, 0
    for _ in range(1000):
        simulated += pacing.slice_us
        clock.now += pacing.wait_s()
    assert simulated * 1e-6 / (clock.now - start) == pytest.approx(5.0)


def test_a_short_delay_is_caught_up_and_a_long_one_is_not() -> None:
    for delay, lost in ((0.03, 0.0), (2.0, 1.95)):
        clock = Clock()
        pacing = Pacing(1.0, clock)
        start, simulated = clock.now, 0
        for k in range(1000):
            simulated += pacing.slice_us
            clock.now += pacing.wait_s() + (delay if k == 500 else 0.0)
        assert clock.now - start - simulated * 1e-6 == pytest.approx(lost, abs=0.01)


def test_max_never_waits() -> None:
    pacing = Pacing(None, Clock())
    assert [pacing.wait_s() for _ in range(5)] == [0.0] * 5


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "fast", "", "1e9"])
def test_refuses_what_is_not_a_speedup(text: str) -> None:
    with pytest.raises(SpeedupError, match="speed-up"):
        parse_speedup(text)


def test_reads_speedups() -> None:
    assert parse_speedup("20") == 20.0
    assert parse_speedup("0.5") == 0.5
    assert parse_speedup("max") is None


def test_a_busy_client_is_answered_and_does_not_hurry_the_clock() -> None:
    clock = Clock()

    class Busy:
        """A bridge whose sockets always have something to read, after a tenth of a millisecond."""

        answered = heard = 0

        def wait(self, seconds: float) -> bool:
            clock.now += min(1e-4, seconds)
            return True

        def receive(self) -> None:
            self.answered += 1

    class Vehicle:
        bridge = Busy()

    pacing, vehicle = Pacing(1.0, clock), Vehicle()
    start = clock.now
    for _ in range(100):
        pacing.after_slice(vehicle)  # type: ignore[arg-type]
    assert clock.now - start == pytest.approx(100 * pacing.slice_us * 1e-6, rel=0.01)
    assert vehicle.bridge.answered > 1000
