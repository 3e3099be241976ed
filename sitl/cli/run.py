# SPDX-License-Identifier: BSD-3-Clause
"""``sitl run``: a vehicle that any MAVLink client can connect to."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path

from ..bridge.links import Link, TcpServerLink, UdpInLink, UdpOutLink, open_link
from ..foreign.choice import choose
from ..run import runner
from ..run.pacing import StoppablePacing, parse_speedup
from ..run.standstill import serve_lockstep
from ..run.stop_signals import StopSignals
from ..run.swarm import SwarmPacing, serve_swarm, serve_swarm_lockstep
from ..simulation import Simulation
from ..vehicle.kinds import KINDS
from . import foreign, recordings, swarm
from .fault_options import say_faults
from .link_options import add_link_options, link_faults
from .options import add_vehicle_options, build_simulation, instance, open_folder, port, seconds, stream_rate
from .status import StatusLine
from .view_options import add_view_options, check_view, shown


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("run")
    parser.add_argument("vehicle", choices=sorted(KINDS))
    clock = parser.add_mutually_exclusive_group()
    clock.add_argument("--speedup", default="1", metavar="K|max", help="simulated seconds a second (default 1)")
    clock.add_argument("--lockstep", action="store_true", help="a MAVLink client controls the time (sitl help mavlink)")
    add_run_options(parser)
    foreign.add_autopilot_options(parser)
    recordings.add_from_option(parser)
    parser.set_defaults(function=run)


def add_run_options(parser: argparse.ArgumentParser) -> None:
    """Options of everything that serves a vehicle."""
    ports = ", ".join(f"udp:127.0.0.1:{p}" for p in runner.OUTPUT_PORTS)
    more = ", ".join(map(str, (runner.BASE_TCP_PORT, *runner.MORE_TCP_PORTS)))
    parser.add_argument(
        "--instance", type=instance, default=0, metavar="N", help="add 10 N to all default ports, and N to MAV_SYSID"
    )
    parser.add_argument(
        "--out",
        action="append",
        metavar="udp:HOST:PORT",
        help=f"send MAVLink to this address; tcp:PORT and udpin:PORT listen (repeatable; default {ports}; "
        "'none' for no UDP)",
    )
    parser.add_argument(
        "--tcp",
        action="append",
        type=port,
        metavar="PORT",
        help=f"listen on this TCP port (repeatable; default {more}; 0: a free port)",
    )
    parser.add_argument(
        "--streamrate",
        type=stream_rate,
        default=runner.STREAM_RATE_HZ,
        metavar="N",
        help=f"stream rate for UDP clients until they request another [Hz] (default {runner.STREAM_RATE_HZ}; "
        "-1: use the MAV1_ parameters)",
    )
    parser.add_argument("--duration", type=seconds, metavar="SIM_SECONDS", help="stop after this simulated time [s]")
    parser.add_argument("--quiet", action="store_true", help="no status line")
    recordings.add_recording_option(parser)
    add_vehicle_options(parser)
    swarm.add_swarm_options(parser)
    add_view_options(parser)
    add_link_options(parser)


def start(options: argparse.Namespace, on_built: Callable[[], None] = lambda: None) -> tuple[Simulation, int, Path]:
    """Build the simulation, open its links and its log, and say where they are; also gives the first TCP port.

    ``on_built`` is called when all is compiled, before anything is written or said.
    """
    step = 10 * options.instance
    if options.out is None:
        outputs = [f"udp:{runner.HOST}:{p + step}" for p in runner.OUTPUT_PORTS]
    else:
        outputs = [text for text in options.out if text != "none"]
    faults = link_faults(options)
    folder = open_folder(options.log_dir)
    links: list[Link] = [open_link(text) for text in outputs]
    servers = open_servers(options)
    links += servers
    if getattr(options, "from_file", None) is not None:
        simulation = recordings.resume(options)
        on_built()
    else:
        simulation = build_simulation(options, {"MAV_SYSID": 1.0 + options.instance} if options.instance else {})
        on_built()
        recordings.record(simulation, options)
    simulation.set_link_faults(faults)
    for link in links:
        simulation.bridge.add_link(link)
        if isinstance(link, (UdpInLink, UdpOutLink)) and options.streamrate >= 0:
            runner.stream_everything(simulation, link, options.streamrate)
        print(f"MAVLink on {link.name}{_role(link, servers)}")
    log = runner.open_log(simulation, folder, f"{simulation.airframe.name}-{options.instance}")
    print(f"log: {log}", flush=True)
    return simulation, servers[0].local_address[1], log


def _role(link: Link, servers: list[TcpServerLink]) -> str:
    """What a link of ``--out`` does that its name may not tell: some expect it to connect."""
    if isinstance(link, TcpServerLink) and link not in servers:
        return " (listens: clients connect to it)"
    return " (listens for datagrams)" if isinstance(link, UdpInLink) else ""


def open_servers(options: argparse.Namespace) -> list[TcpServerLink]:
    """Listen on the TCP ports of the options, or on those of the instance."""
    ports = options.tcp or [10 * options.instance + p for p in (runner.BASE_TCP_PORT, *runner.MORE_TCP_PORTS)]
    return [runner.tcp_server(number) for number in ports]


def run(options: argparse.Namespace) -> int:
    """Serve the vehicle until Ctrl-C, SIGTERM or the end of ``--duration``."""
    check_view(options)
    choice = choose(options.autopilot, options.vehicle)
    if choice is not None:
        return foreign.fly(options, choice)
    speedup = parse_speedup(options.speedup)
    if options.count > 1:
        return run_swarm(options, speedup)
    with StopSignals() as signals:
        simulation, _, _ = start(options, signals.catch)
        status = StatusLine(simulation, not options.quiet)
        until_us = simulation.time_us + int(options.duration * 1e6) if options.duration else None
        pace = None if options.lockstep else StoppablePacing(speedup)
        serve = serve_lockstep if pace is None else partial(runner.serve, pace=pace)
        try:
            with shown(simulation, options, pace, status.refresh) as on_slice:
                serve(simulation, until_us=until_us, running=signals.go_on, on_slice=on_slice)
            recordings.say_why(simulation, next(iter(signals.received), "--duration"))
        finally:
            status.close()
            say_faults(simulation)
            simulation.close()
    return 0


def run_swarm(options: argparse.Namespace, speedup: float | None) -> int:
    """The same with several vehicles in one world."""
    with StopSignals() as signals, swarm.opened(options, signals.catch) as (vehicles, _, status):
        until_us = int(options.duration * 1e6) if options.duration else None
        pace = None if options.lockstep else StoppablePacing(speedup)
        serve = serve_swarm_lockstep if pace is None else partial(serve_swarm, pace=SwarmPacing(pace))
        with shown(vehicles, options, pace, status.refresh) as on_slice:
            serve(vehicles, until_us=until_us, running=signals.go_on, on_slice=on_slice)
    return 0
