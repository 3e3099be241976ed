# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission replay`` of a recording, without one: how far it goes, and what it says of the end."""

from __future__ import annotations

import argparse
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.missions.cli import replay
from sitl.recording.entries import EntryKind
from sitl.recording.recorder import LOG


class Flown:
    """A recording that is flown again in no time."""

    differences = ()
    other_version, is_over = False, True

    def __init__(self, recording: Any, **options: Any) -> None:
        self.recording, self.steps, self.why = recording, [], "?"
        self.simulation = SimpleNamespace(time_us=0)
        Flown.last = self

    last: Flown
    steps: list[int]

    def advance_to(self, time_us: int) -> None:
        assert len(self.steps) < 100, "it goes on for ever"
        self.steps.append(time_us)
        self.simulation.time_us = min(time_us, self.recording.end_us)

    def verify(self) -> list[str]:
        return []

    def close(self, why: str) -> None:
        self.why = why


@pytest.mark.parametrize(
    ("until", "last_us", "why", "said"),
    [
        (None, 1_000_000, "", ""),
        ("0.5", 500_000, "--until", ""),
        ("1", 1_000_000, "", ""),
        ("2", 2_000_000, "", "the recording ends at 1.000 s, before --until"),
    ],
)
def test_it_ends_where_the_recording_does_or_before(
    until: str | None,
    last_us: int,
    why: str,
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    recording = SimpleNamespace(fault="", end_us=1_000_000, header={}, entries=[], has_digests=True)
    monkeypatch.setattr(replay, "read", lambda path, unfinished: recording)
    monkeypatch.setattr(replay, "Replay", Flown)
    monkeypatch.setattr(replay, "StatusLine", lambda *_: SimpleNamespace(refresh=lambda: None, close=lambda: None))
    monkeypatch.setattr(replay, "Pacing", lambda k: SimpleNamespace(speedup=None, after_slice=lambda simulation: None))
    parser = argparse.ArgumentParser()
    replay.add_parser(parser.add_subparsers())
    given = ["replay", str(tmp_path / "a.rec"), "--quiet", *(["--until", until] if until else [])]
    assert replay.replay_recording(parser.parse_args(given)) == 0
    steps = Flown.last.steps
    assert steps[:2] == [200_000, 400_000] and steps[-1] == last_us and max(steps) == last_us
    assert Flown.last.why == why
    out = capsys.readouterr().out
    assert f"flown {min(last_us, 1_000_000) * 1e-6:.3f} s in" in out and said in out
    assert ("before --until" in out) == bool(said)
    assert "the same flight: all telemetry is the same, byte for byte" in out


@pytest.mark.parametrize("kept", [True, False])
def test_the_log_begins_where_the_recorded_runs_did_else_at_once(
    kept: bool, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    opened: list[bool] = []

    class Kept:
        paths: tuple[Path, ...] = ()

        def __init__(self, name: str, folder: Path) -> None:
            assert (name, folder) == ("a", tmp_path)

        def __call__(self, simulation: Any, everything: bool = False) -> None:
            opened.append(everything)

        def close(self) -> None:
            opened.append(False)

    entries = [SimpleNamespace(kind=EntryKind.LINK, data=f'{{"{LOG}": 1}}'.encode())] if kept else []
    recording = SimpleNamespace(fault="", end_us=1_000_000, header={}, entries=entries, has_digests=True)
    monkeypatch.setattr(replay, "read", lambda path, unfinished: recording)
    monkeypatch.setattr(replay, "Replay", Flown)
    monkeypatch.setattr(replay, "ReplayLog", Kept)
    monkeypatch.setattr(replay, "Pacing", lambda k: SimpleNamespace(speedup=None, after_slice=lambda simulation: None))
    monkeypatch.setattr(replay, "StatusLine", lambda *_: SimpleNamespace(refresh=lambda: None, close=lambda: None))
    parser = argparse.ArgumentParser()
    replay.add_parser(parser.add_subparsers())
    options = parser.parse_args(["replay", str(tmp_path / "a.rec"), "--quiet"])
    options.log_dir = tmp_path
    assert replay.replay_recording(options) == 0
    assert opened == ([False] if kept else [True, False])


def test_other_links_and_entries_are_no_log() -> None:
    def keeps(kind: EntryKind, data: bytes) -> bool:
        return replay.keeps_log(SimpleNamespace(entries=[SimpleNamespace(kind=kind, data=data)]))  # type: ignore[arg-type]

    name = f'"{LOG}"'.encode()
    assert keeps(EntryKind.LINK, b"{" + name + b"}")
    assert not keeps(EntryKind.LINK, b'"tcp"')
    assert not any(keeps(kind, name) for kind in EntryKind if kind is not EntryKind.LINK)
