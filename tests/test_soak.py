# SPDX-License-Identifier: BSD-3-Clause
"""The fuzz and soak command: a short run, and that a failure is repeated, made short and kept."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.soak import __main__ as command
from benchmarks.soak.__main__ import Soak, main
from benchmarks.soak.deeds import Deed
from benchmarks.soak.episode import BrokenError, Episode, _limit
from benchmarks.soak.minimise import minimise
from sitl.bridge.frame import Splitter
from sitl.simulation import Core
from sitl.vehicle.kinds import KINDS


@pytest.fixture(scope="module", params=sorted(KINDS))
def soak(request: pytest.FixtureRequest, core: Core) -> Soak:
    return Soak(request.param, 40)


@pytest.mark.parametrize("seed", [0, 1, 5])
def test_an_episode(soak: Soak, seed: int) -> None:
    deeds = soak.deeds(seed)
    assert deeds == soak.deeds(seed) != soak.deeds(seed + 1) and len(deeds) == 40
    assert soak.run(seed, deeds) is None


def test_an_episode_repeats_to_the_bit(soak: Soak) -> None:
    ends = set()
    for _ in range(2):
        soak.run(7, soak.deeds(7))
        ends.add(soak.end)
    assert len(ends) == 1


def test_what_is_wrong_is_found_made_short_kept_and_repeated(
    core: Core, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A deed that is planted breaks the vehicle; nothing else is left of the episode."""
    whole = Episode._do

    def breaks(self: Episode, deed: command.Deed) -> None:
        whole(self, deed)
        if deed.what.startswith("command"):
            self.simulation.v.autopilot.estimate.pos = (float("nan"), 0.0, 0.0)

    monkeypatch.setattr(Episode, "_do", breaks)
    words = ["--vehicle", "rover", "--deeds", "40", "--keep", str(tmp_path)]
    assert main([*words, "--seed", "2", "--episodes", "1"]) == 1
    out = capsys.readouterr().out
    assert "rover, seed 2: not finite: autopilot.estimate.pos[0]" in out and out.count(", then ") == 1
    assert main(["--repeat", str(tmp_path / "rover-2.json")]) == 1
    assert "not finite: autopilot.estimate.pos[0]" in capsys.readouterr().out
    monkeypatch.setattr(Episode, "_do", whole)
    assert main(["--repeat", str(tmp_path / "rover-2.json")]) == 0


def test_a_deed_that_hangs_is_noticed() -> None:
    with pytest.raises(BrokenError, match="hangs"), _limit(0.01):
        while True:
            pass


@given(st.sets(st.integers(0, 60), min_size=1, max_size=3))
def test_only_what_matters_is_left(needed: set[int]) -> None:
    assert minimise(range(61), lambda fewer: needed <= set(fewer), most=1000) == sorted(needed)


def test_what_was_done_is_counted() -> None:
    tally = command.Tally()
    tally.add([
        Deed("bytes", "", 2.0, frames=3), Deed("forget", "", 1.0), Deed("bytes", "", 4.0, frames=1, is_fault=True),
        Deed("reboot", "", 8.0),
    ])  # fmt: skip
    assert tally == command.Tally(deeds=4, frames=4, clients=2, seconds=15.0, faulty_s=12.0)
    tally.add([Deed("bytes", "", 3585.0)])
    assert str(tally) == "5 deeds, 4 frames, 3 client sequences, 1.00 simulated hours, 0.00 of them after a fault"


def test_frames_are_counted_where_they_are_made(soak: Soak) -> None:
    """A frame with a bit turned over counts."""
    for deed in (deed for seed in range(5) for deed in soak.deeds(seed)):
        data = bytes.fromhex(deed.data) if deed.kind == "bytes" else b""
        frames = len(Splitter().feed(data))
        assert deed.frames == frames or (deed.what == "garbage" and deed.frames <= frames + 2), deed
