# SPDX-License-Identifier: BSD-3-Clause
"""``sitl demo copter`` and ``sitl demo rover``: a MAVSDK example drives the vehicle; values, log and picture."""

from __future__ import annotations

import argparse
import importlib.util
import socket
import sys
import time

from tqdm import tqdm

from ..errors import MissingExtra
from ..logs import plot
from ..logs import tlog_flight as flights
from ..run import runner
from ..simulation import OptionError, Simulation
from ..vehicle.kinds import KINDS
from . import execute, recordings
from .example_programs import FOLDER
from .fault_options import say_faults
from .options import add_vehicle_options, build_simulation, open_folder
from .view_options import add_view_options, check_view, default_speedup, shown

_SHOWN_US = 200_000


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("demo")
    parser.add_argument("vehicle", choices=sorted(KINDS))
    execute.add_speedup(parser, default=None)
    recordings.add_recording_option(parser)
    add_view_options(parser)
    add_vehicle_options(parser)
    parser.set_defaults(function=demo)


def demo(options: argparse.Namespace) -> int:
    """Run the example, print the values, draw."""
    check_view(options)
    options.speedup = options.speedup or default_speedup(options)
    name = KINDS[options.vehicle].demo_script
    if name is None:
        raise OptionError(f"there is no demo of a {options.vehicle}")
    script = FOLDER / name
    check_installed()
    reason = execute.can_warp()
    if reason:
        print(f"{reason}\nThe demo runs in real time instead.", file=sys.stderr)
        options.speedup = "1"
    folder = open_folder(options.log_dir)
    simulation = build_simulation(options)
    recordings.record(simulation, options)
    port = free_udp_port()
    runner.send_to_free_port(simulation, port)
    log = runner.open_log(simulation, folder, f"demo-{options.vehicle}")
    start = time.monotonic()
    command = [sys.executable, str(script), f"udpin://{runner.HOST}:{port}"]
    try:
        with (
            execute.terminable(),
            FlightProgress(simulation) as progress,
            shown(simulation, options, then=progress.refresh) as on_slice,
        ):
            code = execute.run_script(simulation, command, options.speedup, None, on_slice)
    finally:
        say_faults(simulation)
        simulation.close()
    wall = time.monotonic() - start
    if code:
        print(f"sitl demo: {script.name} ended with exit code {code}; log: {log}", file=sys.stderr)
        return code
    simulated = simulation.time_us * 1e-6
    print(f"simulated {simulated:.1f} s in {wall:.1f} s of wall time: {simulated / wall:.1f}x real time")
    flown = flights.read(log, simulation.bridge.system)
    armed = next((t for t, state in flown.armed if state), 0.0)
    for t, seq in flown.reached:
        print(f"  mission item {seq} reached {t - armed:6.1f} s after arming (t = {t:.1f} s)")
    if flown.armed and not flown.armed[-1][1]:
        disarmed = flown.armed[-1][0]
        print(f"  disarmed               {disarmed - armed:6.1f} s after arming (t = {disarmed:.1f} s)")
    picture = log.with_suffix(".png")
    title = f"{simulation.airframe.name}: {script.name}, {simulated / wall:.0f}x real time"
    plot.draw(flown, picture, title, simulation.kind.name)
    print(f"log:     {log}\npicture: {picture}")
    return 0


def check_installed() -> None:
    """Check that the libraries of the example and of the picture are installed, before anything is done.

    Raises:
        MissingExtra: some are not.
    """
    missing = [module for module in ("mavsdk", "matplotlib") if importlib.util.find_spec(module) is None]
    if missing:
        raise MissingExtra(f"the demo needs {' and '.join(missing)}: pip install 'gym-sitl[demo]'")


def free_udp_port() -> int:
    """A UDP port of this machine that nobody listens on."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((runner.HOST, 0))
        return int(probe.getsockname()[1])


class FlightProgress:
    """A bar over the flight's steps: boot, ready, armed, each mission item, disarmed."""

    _STEPS = 10

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._next_us = 0
        self._bar: tqdm[None] = tqdm(
            total=self._STEPS, file=sys.stderr, leave=False, bar_format="{desc:50s} {bar} {elapsed}",
            disable=None,  # where stderr is not a terminal
        )  # fmt: skip
        self._was_armed = False

    def refresh(self) -> None:
        """Redraw the bar when it is due."""
        if self._simulation.time_us < self._next_us:
            return
        self._next_us = self._simulation.time_us + _SHOWN_US
        ap = self._simulation.v.autopilot
        armed, reached = bool(ap.arming.armed), int(ap.modes.nav.mission_reached)
        if armed:
            self._was_armed = True
            step, text = 2 + reached, f"armed, item {int(ap.modes.nav.mission_current)}"
        elif self._was_armed:
            step, text = self._STEPS, "disarmed"
        else:
            step, text = (1, "ready to arm") if ap.arming.prearm_ok else (0, "starting, waiting for a position")
        self._bar.set_description_str(f"{self._simulation.time_us * 1e-6:6.1f} s  {text}", refresh=False)
        self._bar.n = min(step, self._STEPS)
        self._bar.refresh()

    def __enter__(self) -> FlightProgress:
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()
