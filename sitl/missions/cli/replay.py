# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission replay``: fly a recording again without its client, or a log of a ground station."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from sitl.cli import recordings
from sitl.cli.options import add_vehicle_options, build_simulation, open_folder, seconds
from sitl.cli.progress import CompileProgress
from sitl.cli.recordings import new_file
from sitl.cli.status import StatusLine
from sitl.core import code_in_files
from sitl.errors import OptionError
from sitl.logs.tlog import TlogWriter
from sitl.physics.engines import NATIVE
from sitl.recording.blocks import is_recording
from sitl.recording.entries import EntryKind
from sitl.recording.recorder import LOG, Recorder
from sitl.recording.recording import Recording, read
from sitl.recording.replay import Replay
from sitl.run import runner
from sitl.run.pacing import Pacing, parse_speedup
from sitl.simulation import Simulation

from ..tlog_replay.extract import extract
from ..tlog_replay.fly_script import LogFlight
from ..tlog_replay.log import Log
from ..tlog_replay.steps import Upload

STEP_US = 200_000
"""Simulated time between two looks at the status line at --speedup max [us]."""
DECIDED = ("home", "start", "seed", "params")
"""Options of a vehicle that a recording decides."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("replay", help="fly a recording again without its clients, or a .tlog")
    parser.add_argument("file", type=Path, metavar="FILE", help="a recording (sitl run --rec), or a .tlog")
    parser.add_argument("--until", type=seconds, metavar="SIM_SECONDS", help="stop after this simulated time")
    parser.add_argument(
        "--snapshot", type=Path, metavar="FILE", help="write a snapshot of the end, for sitl run --from FILE"
    )
    parser.add_argument("--rec", type=Path, metavar="FILE", help="record the replay to this file")
    parser.add_argument("--speedup", default="max", metavar="K|max", help="simulated seconds a second (default max)")
    parser.add_argument(
        "--unfinished", action="store_true", help="accept an incomplete recording, and fly it to its end"
    )
    parser.add_argument(
        "--exact", action="store_true", help="exit code 1 for any difference, even with another version"
    )
    parser.add_argument("--quiet", action="store_true", help="no status line")
    parser.add_argument("--system", type=int, metavar="N", help="system id of the vehicle in a .tlog that has several")
    add_vehicle_options(parser)
    parser.set_defaults(function=replay, log_dir=None, vehicle=None)


def replay(options: argparse.Namespace) -> int:
    """Fly the file, say how it went; 0 when it went as it should."""
    if options.snapshot is not None and options.rec is not None:
        raise OptionError("--snapshot is a recording, too: give it or --rec")
    if is_recording(options.file) or options.file.suffix.lower() != ".tlog":
        return replay_recording(options)

    return replay_tlog(options)


def replay_recording(options: argparse.Namespace) -> int:
    """Fly a recording."""
    given = [f"--{name}" for name in DECIDED if getattr(options, name)]
    if given or options.estimator != "ekf":
        raise OptionError(f"{', '.join(given) or '--estimator'}: the recording decides that")
    recording = read(options.file, options.unfinished)
    if recording.fault:
        print(f"{options.file} {recording.fault}; it is flown up to {recording.end_us * 1e-6:.3f} s", file=sys.stderr)
    if options.terrain is not None:
        if options.terrain != recording.header.get("terrain"):
            raise OptionError("--terrain: the recording decides that")
        code_in_files.allow([f"terrain = {options.terrain!r}"])
    path = options.snapshot or options.rec
    log = ReplayLog(options.file.stem, open_folder(options.log_dir)) if options.log_dir is not None else None
    with CompileProgress() as progress:
        flown = Replay(
            recording,
            frame=options.frame,
            world=options.world,
            physics=options.physics if options.physics != NATIVE else None,
            progress=progress,
            record=new_file(path) if path is not None else None,
            log=log,
            bin_file=(lambda: log.path.with_suffix(".bin")) if log is not None else None,
        )
    simulation = flown.simulation
    if log is not None and not keeps_log(recording):
        log(simulation, everything=True)
    until_us = round(options.until * 1e6) if options.until else recording.end_us
    pace = Pacing(parse_speedup(options.speedup))
    status = StatusLine(simulation, not options.quiet)
    began = time.monotonic()
    try:
        while simulation.time_us < min(until_us, recording.end_us):
            step_us = STEP_US if pace.speedup is None else pace.slice_us
            flown.advance_to(min(simulation.time_us + step_us, until_us))
            status.refresh()
            pace.after_slice(simulation)
        flown.advance_to(until_us)
        took = time.monotonic() - began
        astray = flown.verify()
    finally:
        status.close()
        flown.close("--until" if until_us < recording.end_us else "")
        if log is not None:
            log.close()
    simulated = simulation.time_us * 1e-6
    print(f"flown {simulated:.3f} s in {took:.2f} s of wall time: {simulated / max(took, 1e-9):.0f}x real time")
    if options.until and until_us > recording.end_us:
        print(f"the recording ends at {recording.end_us * 1e-6:.3f} s, before --until")
    for kept in log.paths if log is not None else ():
        print(f"log: {kept}")
    if path is not None:
        print(f"{'snapshot' if options.snapshot else 'recording'}: {path}")
    return verdict(flown, astray, options.exact)


def verdict(flown: Replay, astray: list[str], exact: bool) -> int:
    """Say what is as it was and what is not; the exit code."""
    for text in flown.differences:
        print(f"changed since the recording: {text}")
    if astray:
        print("the flight differs: " + "; ".join(astray))
        if flown.other_version:
            print(
                "another version of the simulator made the recording: the same version flies it again byte for byte on "
                "every machine, another one may differ. How far, sitl mission compare says, with --rec of this replay"
            )
        return 1 if exact or not flown.differences else 0
    whole = flown.is_over and flown.recording.has_digests
    print("the same flight" + (": all telemetry is the same, byte for byte" if whole else " as far as digests tell"))
    return 1 if exact and flown.differences else 0


def keeps_log(recording: Recording) -> bool:
    """Whether the recorded run wrote a log of its own."""
    return any(entry.kind is EntryKind.LINK and f'"{LOG}"'.encode() in entry.data for entry in recording.entries)


class ReplayLog:
    """Opens the log of a replay where the recorded run opened its own: one more where it went on from a snapshot."""

    def __init__(self, name: str, folder: Path) -> None:
        self._folder, self._name = folder, f"{name}-replay"
        self.paths = [runner.new_file(folder, self._name)]
        self._writer: TlogWriter | None = None

    def __call__(self, simulation: Simulation, everything: bool = False) -> TlogWriter:
        """The writer; it also gets what clients send, or ``everything`` that is on any link."""
        bridge = simulation.bridge
        if self._writer is not None:
            self._writer.close()
            self.paths.append(runner.new_file(self._folder, self._name))
        writer = self._writer = TlogWriter(self.path, bridge.epoch_us)
        if everything:
            bridge.taps.append(writer)
        else:
            bridge.client_taps.append(runner.ClientFrames(writer, bridge.system))
        return writer

    @property
    def path(self) -> Path:
        """Path of the current recording."""
        return self.paths[-1]

    def close(self) -> None:
        """Write everything."""
        if self._writer is not None:
            self._writer.close()


def replay_tlog(options: argparse.Namespace) -> int:
    """Fly a log; 0 when this vehicle took all that the log's vehicle took."""
    if options.unfinished or options.exact:
        raise OptionError("--unfinished and --exact are for recordings; a log has no such thing")
    log = Log(options.file, options.system)
    script = extract(log)
    uploads = sum(isinstance(step, Upload) for step in script.steps)
    print(
        f"{options.file}: vehicle {log.system} is a {log.kind}, {log.duration:.1f} s, {len(script.steps)} steps, "
        f"{uploads} mission uploads"
    )
    options.vehicle = log.kind
    options.home = options.home or script.home
    simulation = build_simulation(options, script.parameters)
    path = options.snapshot or options.rec
    if path is not None:
        Recorder(simulation, recordings.new_file(path))
    kept = None
    if options.log_dir is not None:
        kept = runner.open_log(simulation, open_folder(options.log_dir), f"{options.file.stem}-replay")
    pace = Pacing(parse_speedup(options.speedup))
    status = StatusLine(simulation, not options.quiet)

    def advance(until_us: int) -> None:
        target = until_us if pace.speedup is None else min(until_us, simulation.time_us + pace.slice_us)
        simulation.advance_to(target)
        pace.after_slice(simulation)
        status.refresh()

    began = time.monotonic()
    try:
        report = LogFlight(simulation, script, advance).fly(round(options.until * 1e6) if options.until else None)
        recordings.say_why(simulation, "--until" if options.until else "end of the log")
    finally:
        status.close()
        simulation.close()
    simulated, took = simulation.time_us * 1e-6, time.monotonic() - began
    print(f"flown {simulated:.3f} s in {took:.2f} s of wall time: {simulated / max(took, 1e-9):.0f}x real time")
    for title, what in (("log", kept), ("snapshot" if options.snapshot else "recording", path)):
        if what is not None:
            print(f"{title}: {what}")
    if report.waited >= 0.05:
        print(f"{report.waited:.1f} s later than in the log: this vehicle had to get ready")
    for text in report.notes:
        print(f"note: {text}")
    for text in report.faults:
        print(f"otherwise than in the log: {text}")
    return 1 if report.faults else 0
