# SPDX-License-Identifier: BSD-3-Clause
"""``--autopilot`` of ``sitl run`` and ``sitl exec``: a foreign autopilot in our physics and world."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ..autopilot.params import parm_files
from ..bridge.bridge import EPOCH_US
from ..bridge.links import Link, TcpServerLink, open_link
from ..errors import OptionError
from ..foreign.ardupilot import FASTEST
from ..foreign.betaflight import configuration
from ..foreign.betaflight.betaflight_session import BetaflightSession
from ..foreign.choice import ARDUPILOT, BETAFLIGHT, FORMS, NATIVE, PX4, Choice
from ..foreign.px4 import STATIONS_PORT, programs_port
from ..foreign.px4_session import Px4Session
from ..foreign.session import ArduPilotSession, Session
from ..logs.tlog import TlogWriter
from ..physics.engines import BACKENDS
from ..plants.local import LocalPlant, stand_alone
from ..run import runner
from ..run.pacing import parse_speedup
from ..run.stop_signals import StopSignals
from .link_options import link_faults
from .options import open_folder, scenario_of
from .progress import CompileProgress
from .status import PlantStatus
from .view_options import shown


def add_autopilot_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that choose the autopilot."""
    parser.add_argument("--autopilot", default=NATIVE, metavar="NAME[:PROGRAM|:CONNECTION]", help=f"autopilot: {FORMS}")
    parser.add_argument(
        "--autopilot-dir",
        type=Path,
        metavar="DIR",
        help="folder for the files of another autopilot (default: a temporary one)",
    )


@dataclass
class Flown:
    """A foreign autopilot that flies our physics for a command."""

    session: Session
    plant: LocalPlant
    status: PlantStatus
    tcp_port: int
    """First TCP port on which clients reach it; 0: it has links of its own."""


@contextlib.contextmanager
def opened(
    options: argparse.Namespace,
    choice: Choice,
    speedup: float | None,
    is_relayed_by_slice: bool = False,
    on_built: Callable[[], None] = lambda: None,
) -> Iterator[Flown]:
    """Physics, links, log and autopilot by the options, said on the terminal; all is closed at the end.

    Args:
        options: of the command.
        choice: the autopilot.
        speedup: times real time; None: as fast as it goes.
        is_relayed_by_slice: see ``ArduPilotSession``.
        on_built: called when all is compiled, before anything is opened or started.
    """
    with contextlib.ExitStack() as undo, contextlib.ExitStack() as unless_opened:
        plant = build_plant(options, choice)
        on_built()
        unless_opened.callback(plant.close)
        links: list[Link] = []
        log: TlogWriter | None = None
        messages: deque[str] = deque()
        if choice.program is not None:
            links = open_links(options, choice)
            for link in links:
                unless_opened.callback(link.close)
            folder = open_folder(options.log_dir)
            name = f"{choice.kind}-{plant.vehicle.airframe.name}-{options.instance}"
            log = TlogWriter(runner.new_file(folder, name), EPOCH_US)
            undo.callback(log.close)
        session = build_session(options, choice, plant, links, speedup, log, messages.append, is_relayed_by_slice)
        unless_opened.pop_all()  # the session closes them
        undo.callback(session.close)
        print(f"{choice.name} flies {plant.vehicle.airframe.name}; physics: {plant.backend}")
        for link in links:
            print(f"MAVLink on {link.name}")
        if choice.kind == BETAFLIGHT:
            print(session.clients)
        print(f"log: {log.path}" if log is not None else f"MAVLink of the autopilot: {session.clients}", flush=True)
        status = PlantStatus(plant, messages, not options.quiet)
        undo.callback(status.close)
        ports = [link.local_address[1] for link in links if isinstance(link, TcpServerLink)]
        yield Flown(session, plant, status, ports[0] if ports else 0)


def fly(options: argparse.Namespace, choice: Choice) -> int:
    """Serve until Ctrl-C, SIGTERM, the end of ``--duration`` or of the autopilot."""
    check(options, choice)
    until_us = int(options.duration * 1e6) if options.duration else math.inf
    speedup = parse_speedup(options.speedup)
    with StopSignals() as signals, opened(options, choice, speedup, on_built=signals.catch) as flown:
        clock = flown.plant.vehicle.reader.field("time_us")
        with shown(flown.plant, options, then=flown.status.refresh) as on_turn:
            flown.session.serve(lambda: signals.go_on() and clock() < until_us, on_turn)
    return 0


def check(options: argparse.Namespace, choice: Choice) -> None:
    """OptionError for an option that a foreign autopilot cannot have."""
    for name in ("rec", "from_file"):
        if getattr(options, name, None) is not None:
            raise OptionError(
                f"--{name.removesuffix('_file')}: a run with {choice.kind} cannot be recorded or continued"
            )
    if getattr(options, "lockstep", False):
        raise OptionError(f"--lockstep: not with {choice.kind}; environments control its time (autopilot=)")
    if link_faults(options) is not None:
        raise OptionError(
            f"--link-...: not with {choice.kind}, which has its own links; only those of our autopilot can have faults"
        )
    if getattr(options, "fail", ()):
        own = "set SIM_ parameters, by --params or MAVLink" if choice.kind == PX4 else "set its own SIM_ parameters"
        raise OptionError(f"--fail: not with {choice.kind}; {own}")
    if options.estimator != "ekf":
        raise OptionError(f"--estimator {options.estimator}: not with {choice.kind}, which has its own estimators")
    if options.physics not in BACKENDS:
        raise OptionError(f"--physics {options.physics}: {choice.kind} needs one of {', '.join(BACKENDS)}")
    if choice.program is None and options.params:
        raise OptionError(f"--params: {choice.name} runs already; set its parameters by MAVLink")


def build_plant(options: argparse.Namespace, choice: Choice) -> LocalPlant:
    """Physics and world by the options, and by those of the parameter files that act on them."""
    if choice.kind == BETAFLIGHT:
        acting: dict[str, float] = configuration.read(options.params)[1]
    else:
        values = parm_files.load_all(options.params)
        for text in parm_files.not_read(values):
            print(f"sitl: {text}", file=sys.stderr)
        acting = choice.for_physics(values)
    scenario = scenario_of(options, acting)
    with CompileProgress() as progress:
        return stand_alone(scenario, progress=progress)


def open_links(options: argparse.Namespace, choice: Choice) -> list[Link]:
    """Open the links on which clients reach the autopilot, as for our own; PX4's clients expect it at other UDP ports
    from the second instance on."""
    step = 10 * options.instance
    numbers = [p + step for p in runner.OUTPUT_PORTS]
    if choice.kind == PX4:
        numbers = [STATIONS_PORT, programs_port(options.instance)]
    outputs = [f"udp:{runner.HOST}:{p}" for p in numbers] if options.out is None else options.out
    links: list[Link] = [open_link(text) for text in outputs if text != "none"]
    ports = options.tcp or [runner.BASE_TCP_PORT + step]  # the autopilot's own program has the others
    links += [runner.tcp_server(port) for port in ports]
    return links


def build_session(
    options: argparse.Namespace,
    choice: Choice,
    plant: LocalPlant,
    links: list[Link],
    speedup: float | None,
    log: TlogWriter | None,
    say: Callable[[str], None],
    is_relayed_by_slice: bool = False,
) -> Session:
    """The session of the autopilot on its plant; ``speedup``: times real time, None: as fast as it goes."""
    clock = plant.vehicle.reader.field("time_us")

    def tap(frame: bytes) -> None:
        if log is not None:
            log.frame(clock(), frame)

    if choice.kind == ARDUPILOT:
        return ArduPilotSession(
            choice, plant, links, instance=options.instance, speedup=speedup or FASTEST,
            params=parm_files.load_all(options.params), folder=options.autopilot_dir, say=say, tap=tap,
            is_relayed_by_slice=is_relayed_by_slice,
        )  # fmt: skip
    if choice.kind == BETAFLIGHT:
        return BetaflightSession(
            choice, plant, links, instance=options.instance, speedup=speedup,
            lines=configuration.read(options.params)[0], folder=options.autopilot_dir, say=say, tap=tap,
        )  # fmt: skip
    theirs = choice.for_autopilot(parm_files.load_all(options.params))
    return Px4Session(
        choice, plant, links, instance=options.instance, speedup=speedup, params=theirs,
        folder=options.autopilot_dir, say=say, tap=tap, is_relayed_by_slice=is_relayed_by_slice,
    )  # fmt: skip
