# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission replay FILE.tlog``: flies what a ground station's log tells."""

from __future__ import annotations

import argparse
import time

from sitl.cli import recordings
from sitl.cli.options import build_simulation, open_folder
from sitl.cli.status import StatusLine
from sitl.errors import OptionError
from sitl.recording.recorder import Recorder
from sitl.run import runner
from sitl.run.pacing import Pacing, parse_speedup

from ..tlog_replay.extract import extract
from ..tlog_replay.fly import LogFlight
from ..tlog_replay.log import Log
from ..tlog_replay.steps import Upload


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
