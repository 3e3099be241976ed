# SPDX-License-Identifier: BSD-3-Clause
"""``sitl run``: a vehicle that any MAVLink client can connect to."""

from __future__ import annotations

import argparse
import signal

from .. import runner
from ..pacing import Pacing, parse_speedup
from ..simulation import Simulation
from .options import VEHICLES, add_vehicle_options, build_simulation, count, open_folder, seconds
from .status import StatusLine


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("run", help="run a vehicle and serve MAVLink")
    parser.add_argument("vehicle", choices=sorted(VEHICLES))
    parser.add_argument("--speedup", default="1", metavar="K|max", help="simulated seconds a second (default 1)")
    add_run_options(parser)
    parser.set_defaults(function=run)


def add_run_options(parser: argparse.ArgumentParser) -> None:
    """Options of everything that serves a vehicle."""
    parser.add_argument(
        "--instance", type=count, default=0, metavar="N", help="TCP port 5760 + 10 N, system id 1 + N"
    )
    parser.add_argument(
        "--out",
        action="append",
        metavar="udp:HOST:PORT",
        help=f"send there (repeatable; default {' and '.join(runner.DEFAULT_OUTPUTS)}; 'none' for no output)",
    )
    parser.add_argument("--tcp", type=int, metavar="PORT", help="TCP port to serve; 0 takes a free one")
    parser.add_argument("--duration", type=seconds, metavar="SIM_SECONDS", help="stop after this simulated time")
    parser.add_argument("--quiet", action="store_true", help="no status line")
    add_vehicle_options(parser)


def outputs(options: argparse.Namespace) -> list[str]:
    """The outputs asked for, or the default ones (14550 and 14540, plus 10 an instance)."""
    if options.out is None:
        step = 10 * options.instance
        return [f"udp:127.0.0.1:{port + step}" for port in (14550, 14540)]
    return [text for text in options.out if text != "none"]


def start(options: argparse.Namespace) -> tuple[Simulation, list[str], str]:
    """Build the simulation, open links and log; returns it with what it listens on and the log's path."""
    folder = open_folder(options.log_dir)
    simulation = build_simulation(options)
    if options.instance:
        simulation.set_system_id(1 + options.instance)
    port = runner.BASE_TCP_PORT + 10 * options.instance if options.tcp is None else options.tcp
    opened = runner.open_links(simulation, outputs(options), port)
    log = runner.open_log(simulation, folder, f"{simulation.airframe.name}-{options.instance}")
    return simulation, opened, str(log)


def run(options: argparse.Namespace) -> int:
    """Serve the vehicle until Ctrl-C, SIGTERM or the end of ``--duration``."""
    pacing_speed = parse_speedup(options.speedup)
    simulation, opened, log = start(options)
    for name in opened:
        print(f"MAVLink on {name}")
    print(f"log: {log}", flush=True)
    stopped: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda n, _: stopped.append(n))
    status = StatusLine(simulation, not options.quiet)
    until = int(options.duration * 1e6) if options.duration else None
    try:
        runner.serve(
            simulation,
            Pacing(pacing_speed),
            until_us=until,
            running=lambda: not stopped,
            after_slice=status.update,
        )
    finally:
        status.close()
        simulation.close()
    return 0
