# SPDX-License-Identifier: BSD-3-Clause
"""``sitl exec``: a vehicle, and an unmodified script whose clock follows the vehicle's.

The autopilot may be another program (``--autopilot``): its time is held by our physics.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator

from ..foreign.betaflight.betaflight_session import BetaflightSession
from ..foreign.choice import Choice, choose
from ..foreign.slices import SlicedSession
from ..run import runner
from ..run.pacing import Pacing, parse_speedup, whole_ticks
from ..run.swarm import SwarmPacing, serve_swarm
from ..simulation import OptionError, Simulation
from ..swarm import Swarm
from ..vehicle.kinds import DEFAULT, KINDS
from ..warp import CannotBuild, ClockPage, Pacer, preload_library, start_script
from ..warp.build import static_runtime
from . import foreign, recordings, run, swarm
from .fault_options import say_faults
from .status import StatusLine
from .view_options import DEFAULT_TEXT, check_view, shown

DEFAULT_SPEEDUP = "20"
LATE = 124
"""Exit code when the script has not ended within ``--duration``."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "exec",
        usage="sitl exec [options] -- COMMAND [ARGUMENT ...]",
        epilog="{tcp} in an argument of COMMAND is replaced by the first TCP port. The exit code is that "
        f"of COMMAND, or {LATE} when COMMAND has not ended within --duration.",
    )
    parser.add_argument("--vehicle", choices=sorted(KINDS), default=DEFAULT)
    add_speedup(parser)
    run.add_run_options(parser)
    foreign.add_autopilot_options(parser)
    parser.add_argument("script", nargs=argparse.REMAINDER, metavar="-- COMMAND", help="the script or program to run")
    parser.set_defaults(function=execute)


def add_speedup(parser: argparse.ArgumentParser, default: str | None = DEFAULT_SPEEDUP) -> None:
    """The option that says how fast a script's clock goes; None: as ``view_options.default_speedup`` says."""
    parser.add_argument(
        "--speedup",
        default=default,
        metavar="K|max",
        help=f"simulated seconds a second (default {default or DEFAULT_TEXT}); max: as fast as possible",
    )


def execute(options: argparse.Namespace) -> int:
    """Run the script to its end; returns its exit code."""
    command = options.script[1:] if options.script[:1] == ["--"] else options.script
    if not command:
        raise OptionError("no command given: sitl exec [options] -- python script.py")
    if shutil.which(command[0]) is None:
        raise OptionError(f"command {command[0]!r} is not found or not executable")
    factor = parse_speedup(options.speedup)
    check_view(options)
    choice = choose(options.autopilot, options.vehicle)
    if (factor != 1.0 or choice is not None) and (reason := can_warp()):
        raise CannotBuild(reason)  # before a vehicle is started
    with terminable():  # before anything is opened or said: whoever reads along may end it at once
        if choice is not None:
            return _execute_foreign(options, choice, command)
        if options.count > 1:
            return _execute_swarm(options, command)
        return _execute(options, command)


def _execute(options: argparse.Namespace, command: list[str]) -> int:
    """``execute`` with one vehicle of ours."""
    simulation, tcp_port, _ = run.start(options)
    command = [word.replace("{tcp}", str(tcp_port)) for word in command]
    status = StatusLine(simulation, not options.quiet)
    try:
        with shown(simulation, options, then=status.refresh) as on_slice:
            code = run_script(simulation, command, options.speedup, options.duration, on_slice)
        recordings.say_why(simulation, f"script ended with exit code {code}")
        return code
    finally:
        status.close()
        say_faults(simulation)
        simulation.close()


def _execute_swarm(options: argparse.Namespace, command: list[str]) -> int:
    """``execute`` with several vehicles in one world."""
    with swarm.opened(options) as (vehicles, tcp_port, status):
        command = [word.replace("{tcp}", str(tcp_port)) for word in command]
        with shown(vehicles, options, then=status.refresh) as on_slice:
            return run_script(vehicles, command, options.speedup, options.duration, on_slice)


def _execute_foreign(options: argparse.Namespace, choice: Choice, command: list[str]) -> int:
    """``execute`` with the program of another autopilot."""
    foreign.check(options, choice)
    if choice.program is None:
        raise OptionError(f"sitl exec: {choice.name} cannot run in simulated time; use {choice.kind}:PROGRAM")
    with foreign.opened(options, choice, None, is_relayed_by_slice=True) as flown:
        assert isinstance(flown.session, SlicedSession | BetaflightSession)
        command = [word.replace("{tcp}", str(flown.tcp_port)) for word in command]
        with shown(flown.plant, options, then=flown.status.refresh) as on_slice:
            return run_script(flown.session, command, options.speedup, options.duration, on_slice)


class ScriptPace:
    """Publishes the script's clock after each slice and waits until the next is due."""

    def __init__(self, pacer: Pacer) -> None:
        pacer.slice_us = whole_ticks(pacer.slice_us)
        self._pacer = pacer
        self.slice_us = pacer.slice_us

    def after_slice(self, simulation: Simulation | Swarm | SlicedSession | BetaflightSession) -> None:
        """Advance the script's clock."""
        self._pacer.pace(simulation.time_us)


def can_warp() -> str:
    """Empty when scripts can run in simulated time here, else why not. Compiles the clock library on first use."""
    try:
        preload_library()
        static_runtime()
    except CannotBuild as error:
        return str(error)
    return ""


def run_script(
    vehicle: Simulation | Swarm | SlicedSession | BetaflightSession,
    command: list[str],
    speedup: str,
    duration_s: float | None = None,
    on_slice: Callable[[], None] = lambda: None,
) -> int:
    """Run ``command`` on the vehicle's clock until it ends; its exit code (128 + n for signal n).

    After ``duration_s`` simulated seconds it is ended, which is a failure: 124, as of timeout(1).
    At ``speedup`` "1" a script of our autopilot needs no clock of its own where none can be had.

    Raises:
        CannotBuild: this machine cannot run scripts in simulated time, and ``speedup`` is not 1.
        OptionError: the command cannot be started.
        AutopilotEndedError: the program of another autopilot has ended.
    """
    factor = parse_speedup(speedup)
    until = vehicle.time_us + int(duration_s * 1e6) if duration_s else None
    reason = can_warp()
    if reason and (factor != 1.0 or isinstance(vehicle, SlicedSession | BetaflightSession)):
        raise CannotBuild(reason)
    with contextlib.ExitStack() as stack:
        page = None if reason else stack.enter_context(ClockPage())
        pace = ScriptPace(Pacer(page, "max" if factor is None else factor)) if page is not None else None
        try:
            script = subprocess.Popen(command) if page is None else start_script(command, page, ends_with_us=True)
        except OSError as error:
            raise OptionError(f"command {command[0]!r} cannot be started: {error.strerror or error}") from None
        stack.callback(end, script, page)

        def running() -> bool:
            return script.poll() is None

        if isinstance(vehicle, Simulation):
            runner.serve(vehicle, pace or Pacing(1.0), until_us=until, running=running, on_slice=on_slice)
        elif isinstance(vehicle, Swarm):
            serve_swarm(vehicle, pace or SwarmPacing(1.0), until_us=until, running=running, on_slice=on_slice)
        elif pace is not None:
            vehicle.serve_slices(pace, until_us=until, running=running, on_slice=on_slice)
        if script.poll() is None:
            print(f"sitl: {command[0]} has not ended within --duration {duration_s:g} s", file=sys.stderr, flush=True)
            return LATE
    code = script.returncode
    return code if code >= 0 else 128 - code


def end(script: subprocess.Popen[bytes], page: ClockPage | None) -> None:
    """End a script that is still running: ask it, and wait 10 s or until a second interrupt.

    What it has started and left on the simulation's clock is ended too: its vehicle is gone.
    """
    if page is not None:
        page.release()  # or a script that sleeps before it ends would wait for ever
    if script.poll() is None:
        script.terminate()
    try:
        with contextlib.suppress(subprocess.TimeoutExpired):
            script.wait(timeout=10.0)
    finally:
        if script.poll() is None:
            script.kill()
            script.wait()
        for pid in page.clients() if page is not None else ():
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGTERM)


@contextlib.contextmanager
def terminable() -> Iterator[None]:
    """A context in which SIGTERM ends the command as Ctrl-C does."""

    def leave(number: int, _: object) -> None:
        raise SystemExit(128 + number)

    before = signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
