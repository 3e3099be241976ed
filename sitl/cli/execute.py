# SPDX-License-Identifier: BSD-3-Clause
"""``sitl exec``: a vehicle, and an unmodified script whose clock follows the vehicle's."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from .. import runner
from ..pacing import SpeedupError, parse_speedup
from ..simulation import Simulation
from ..warp import ClockPage, Pacer, start_script
from . import run
from .options import VEHICLES
from .status import StatusLine

DEFAULT_SPEEDUP = "20"


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "exec",
        help="run a script in simulated time against a vehicle of its own",
        usage="sitl exec [options] -- COMMAND [ARGUMENT ...]",
    )
    parser.add_argument("--vehicle", choices=sorted(VEHICLES), default="copter")
    parser.add_argument(
        "--speedup", default=DEFAULT_SPEEDUP, metavar="K", help=f"simulated seconds a second (default {DEFAULT_SPEEDUP})"
    )
    run.add_run_options(parser)
    parser.add_argument("script", nargs=argparse.REMAINDER, metavar="-- COMMAND", help="what to run")
    parser.set_defaults(function=execute)


def execute(options: argparse.Namespace) -> int:
    """Run the script to its end; returns its exit code."""
    command = options.script[1:] if options.script[:1] == ["--"] else options.script
    if not command:
        raise SpeedupError("no command given: sitl exec [options] -- python script.py")
    simulation, opened, log = run.start(options)
    print(f"MAVLink on {', '.join(opened)}\nlog: {log}", flush=True)
    status = StatusLine(simulation, not options.quiet)
    try:
        return run_script(simulation, command, options.speedup, options.duration, status.update)
    finally:
        status.close()
        simulation.close()


def run_script(
    simulation: Simulation,
    command: list[str],
    speedup: str,
    duration_s: float | None = None,
    after_slice: Callable[[], None] = lambda: None,
) -> int:
    """Run ``command`` on the simulation's clock until it ends; its exit code (128 + n for signal n)."""
    factor = parse_speedup(speedup)
    if factor is None:
        raise SpeedupError("sitl exec takes a number as speed-up: the script has to keep up")
    until = int(duration_s * 1e6) if duration_s else None
    with ClockPage() as page:
        pacer = Pacer(page, factor)
        script = start_script(command, page)
        try:
            runner.serve(
                simulation,
                pacer_as_pacing(pacer, simulation),
                until_us=until,
                running=lambda: script.poll() is None,
                after_slice=after_slice,
            )
        finally:
            page.release()
            if script.poll() is None:
                script.terminate()
            code = script.wait()
    return code if code >= 0 else 128 - code
