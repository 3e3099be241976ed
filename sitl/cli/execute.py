# SPDX-License-Identifier: BSD-3-Clause
"""``sitl exec``: a vehicle, and an unmodified script whose clock follows the vehicle's."""

from __future__ import annotations

import argparse
import shutil
from collections.abc import Callable

from .. import runner
from ..pacing import parse_speedup
from ..simulation import OptionError, Simulation
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
    add_speedup(parser)
    run.add_run_options(parser)
    parser.add_argument("script", nargs=argparse.REMAINDER, metavar="-- COMMAND", help="what to run")
    parser.set_defaults(function=execute)


def add_speedup(parser: argparse.ArgumentParser) -> None:
    """The option that says how fast a script's clock goes."""
    parser.add_argument(
        "--speedup",
        default=DEFAULT_SPEEDUP,
        metavar="K|max",
        help=f"simulated seconds a second (default {DEFAULT_SPEEDUP}); max: as fast as stays faithful",
    )


def execute(options: argparse.Namespace) -> int:
    """Run the script to its end; returns its exit code."""
    command = options.script[1:] if options.script[:1] == ["--"] else options.script
    if not command:
        raise OptionError("no command given: sitl exec [options] -- python script.py")
    if shutil.which(command[0]) is None:
        raise OptionError(f"command {command[0]!r} is not found or cannot be run")
    parse_speedup(options.speedup)
    simulation, _ = run.start(options)
    status = StatusLine(simulation, not options.quiet)
    try:
        return run_script(simulation, command, options.speedup, options.duration, status.update)
    finally:
        status.close()
        simulation.close()


class ScriptPace:
    """Publishes the script's clock after each slice and waits until the next is due."""

    def __init__(self, pacer: Pacer) -> None:
        self._pacer = pacer
        self.slice_us = pacer.slice_us

    def after_slice(self, simulation: Simulation) -> None:
        """Let the script's clock go on."""
        self._pacer.pace(simulation.time_us)


def run_script(
    simulation: Simulation,
    command: list[str],
    speedup: str,
    duration_s: float | None = None,
    on_slice: Callable[[], None] = lambda: None,
) -> int:
    """Run ``command`` on the simulation's clock until it ends; its exit code (128 + n for signal n)."""
    factor = parse_speedup(speedup)
    until = simulation.time_us + int(duration_s * 1e6) if duration_s else None
    with ClockPage() as page:
        pacer = Pacer(page, "max" if factor is None else factor)
        script = start_script(command, page)
        try:
            runner.serve(
                simulation,
                ScriptPace(pacer),
                until_us=until,
                running=lambda: script.poll() is None,
                on_slice=on_slice,
            )
        finally:
            page.release()
            if script.poll() is None:
                script.terminate()
            code = script.wait()
    return code if code >= 0 else 128 - code
