# SPDX-License-Identifier: BSD-3-Clause
"""``--count``: several vehicles in one world, of ``sitl run`` and ``sitl exec``."""

from __future__ import annotations

import argparse
import contextlib
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import fields, replace

from ..autopilot.params import parm_files
from ..bridge.links import LinkAddressError, UdpInLink, UdpOutLink, open_link, parse
from ..errors import OptionError
from ..run import runner
from ..swarm import MOST, SPACING, Swarm
from .link_options import link_faults
from .options import open_folder, scenario_of
from .progress import CompileProgress
from .status import Line

PORT_STEP = 10
"""From the ports of one vehicle to those of the next."""


def count(text: str) -> int:
    """A whole number of vehicles."""
    if not text.isdigit() or not 1 <= int(text) <= MOST:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1 to {MOST}")
    return int(text)


def spacing(text: str) -> float:
    """A positive number of metres."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number of metres")
    return value


def add_swarm_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of several vehicles."""
    group = parser.add_argument_group("several vehicles in one world (sitl help swarm)")
    group.add_argument(
        "--count", type=count, default=1, metavar="N", help="how many, with system ids 1 to N (default 1)"
    )
    group.add_argument(
        "--spacing",
        type=spacing,
        default=SPACING,
        metavar="METRES",
        help=f"distance between starts (default {SPACING:g})",
    )
    links = group.add_mutually_exclusive_group()
    links.add_argument("--one-link", action="store_true", help="all vehicles on each link (default)")
    links.add_argument(
        "--own-links",
        action="store_true",
        help=f"separate links: {PORT_STEP} (k - 1) is added to the ports of vehicle k",
    )


@contextlib.contextmanager
def opened(
    options: argparse.Namespace, on_built: Callable[[], None] = lambda: None
) -> Iterator[tuple[Swarm, int, Line]]:
    """The vehicles, with links and logs by the options; the first TCP port; the status line. All is closed at the end.

    ``on_built`` is called when all is compiled, before anything is opened or said.

    Raises:
        OptionError: an option that is for one vehicle only.
    """
    for name, unwanted in (("--rec", options.rec), ("--from", getattr(options, "from_file", None))):
        if unwanted is not None:
            raise OptionError(f"{name} is of one vehicle, not of --count {options.count}")
    if options.instance:
        raise OptionError(f"--instance {options.instance}: vehicles of --count {options.count} have ids 1 and up")
    faults = link_faults(options)
    folder = open_folder(options.log_dir)
    scenario = scenario_of(options, parm_files.load_all(options.params))
    given = {field.name: getattr(scenario, field.name) for field in fields(scenario) if field.name != "frame"}
    with contextlib.ExitStack() as stack:
        with CompileProgress() as progress:
            swarm = Swarm(scenario.airframe, options.count, spacing=options.spacing, progress=progress, **given)
        on_built()
        stack.callback(swarm.close)
        for k, vehicle in enumerate(swarm.vehicles):
            vehicle.set_link_faults(replace(faults, seed=faults.seed + k) if faults is not None else None)
        groups = [[k] for k in range(len(swarm))] if options.own_links else [list(range(len(swarm)))]
        ports = [add_links(swarm, options, which, PORT_STEP * number) for number, which in enumerate(groups)]
        for k, vehicle in enumerate(swarm.vehicles):
            log = runner.open_log(vehicle, folder, f"{scenario.airframe.name}-{k + 1}")
            print(f"log: {log}", flush=True)
        status = SwarmStatus(swarm, not options.quiet)
        stack.callback(status.close)
        yield swarm, ports[0], status


def add_links(swarm: Swarm, options: argparse.Namespace, which: list[int], step: int) -> int:
    """Open links for some of the vehicles, at ports raised by ``step``; returns the first TCP port."""
    outputs = options.out or [f"udp:{runner.HOST}:{port}" for port in runner.OUTPUT_PORTS]
    links = [open_link(moved(text, step)) for text in outputs if text != "none"]
    servers = [
        runner.tcp_server(port + step if port else 0)
        for port in options.tcp or (runner.BASE_TCP_PORT, *runner.MORE_TCP_PORTS)
    ]
    ids = f"{which[0] + 1}" if len(which) == 1 else f"{which[0] + 1} to {which[-1] + 1}"
    for link in (*links, *servers):
        ends = swarm.router.add_link(link, which)
        if isinstance(link, UdpInLink | UdpOutLink) and options.streamrate >= 0:
            for k, end in zip(which, ends, strict=True):
                runner.stream_everything(swarm[k], end, options.streamrate)
        print(f"MAVLink on {link.name} (system {ids})")
    return servers[0].local_address[1]


def moved(text: str, step: int) -> str:
    """A link's text with another port.

    Raises:
        LinkAddressError: there is no such port.
    """
    kind, host, port = parse(text)
    if port + step > 65535:
        raise LinkAddressError(f"link {text!r}: port {port} + {step} of a later vehicle is above 65535")
    return f"{kind}:{host}:{port + step}"


class SwarmStatus(Line):
    """Time, speed and how many are armed, in one line; the messages are about lost clients."""

    def __init__(self, swarm: Swarm, enabled: bool) -> None:
        self._swarm = swarm
        self._lines: deque[str] = deque()

        def describe(factor: float) -> str:
            armed = sum(bool(vehicle.v.autopilot.arming.armed) for vehicle in swarm.vehicles)
            return f"{swarm.time_us * 1e-6:9.1f} s  {factor:6.1f}x  {armed} of {len(swarm)} armed"

        super().__init__(self._lines, lambda: swarm.time_us, describe, enabled)

    def refresh(self) -> None:
        for vehicle in self._swarm.vehicles:
            dropped = vehicle.bridge.dropped
            while dropped:
                self._lines.append(f"system {vehicle.bridge.system}: {dropped.popleft()}")
        super().refresh()
