# SPDX-License-Identifier: BSD-3-Clause
"""``--rec`` and ``--from``: record a run; continue from a recording."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ..errors import OptionError
from ..physics.engines import NATIVE
from ..recording.entries import RecordingError
from ..recording.recorder import Recorder
from ..recording.recording import read
from ..recording.replay import Replay
from ..simulation import Simulation
from .progress import CompileProgress

FLUSH_US = 1_000_000
"""Longest part of a recording that is lost when a run is killed [simulated us]."""


def add_recording_option(parser: argparse.ArgumentParser) -> None:
    """The option that keeps a recording."""
    parser.add_argument("--rec", type=Path, metavar="FILE", help="record the run to this file, for sitl mission replay")


def add_from_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that continues from a recording."""
    parser.add_argument(
        "--from", dest="from_file", type=Path, metavar="FILE", help="continue from the end of a recording or snapshot"
    )


def new_file(path: Path) -> Path:
    """``path``; OptionError when there is such a file already: a recording is never overwritten by a run."""
    if path.exists():
        raise OptionError(f"--rec {str(path)!r} exists already; give another name or delete it")
    return path


def record(simulation: Simulation, options: argparse.Namespace) -> Recorder | None:
    """Start the recording that the options request."""
    if getattr(options, "rec", None) is None:
        return None
    return Recorder(simulation, new_file(options.rec), FLUSH_US)


def say_why(simulation: Simulation, why: str) -> None:
    """Store the reason for the end of a run in its recording, if there is one."""
    journal = simulation.bridge.board.journal
    if isinstance(journal, Recorder):
        journal.stopped = why


def resume(options: argparse.Namespace) -> Simulation:
    """The vehicle of a recording, at its end.

    Raises:
        OptionError: options that the recording decides, or another kind of vehicle.
        RecordingError: it cannot be flown, or does not end where it did.
    """
    given = [f"--{name}" for name in ("home", "start", "seed", "params") if getattr(options, name)]
    given += ["--physics"] if options.physics != NATIVE else []
    given += ["--estimator"] if options.estimator != "ekf" else []
    if given:
        raise OptionError(f"{', '.join(given)}: with --from the recording decides")
    recording = read(options.from_file)
    if recording.header["vehicle"] != options.vehicle:
        raise OptionError(
            f"--from {options.from_file} is of a {recording.header['vehicle']}, not of a {options.vehicle}"
        )
    path = new_file(options.rec) if options.rec is not None else None
    with CompileProgress() as progress:
        replay = Replay(recording, frame=options.frame, world=options.world, progress=progress, record=path)
    astray = replay.run()
    if astray:
        replay.close()
        if path is not None:
            path.unlink(missing_ok=True)  # of a flight that nobody asked for
        changed = "; ".join(replay.differences)
        raise RecordingError(
            f"recording {str(options.from_file)!r} does not lead to the same place: {'; '.join(astray)}"
            + (f" ({changed})" if changed else "")
            + ". sitl mission replay --until T --snapshot FILE makes a snapshot as this version flies"
        )
    for text in replay.differences:
        print(f"sitl: the recording was made with {text}", file=sys.stderr)
    replay.recorder.flush_us = FLUSH_US
    return replay.go_live()
