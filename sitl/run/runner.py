# SPDX-License-Identifier: BSD-3-Clause
"""Runs a simulation with clients on sockets: advance a slice, look at the wall clock, serve the sockets, again."""

from __future__ import annotations

import errno
from collections.abc import Callable
from pathlib import Path
from typing import Protocol, TypeVar

from ..bridge.channel import COMPONENT
from ..bridge.links import Link, LinkAddressError, LogLink
from ..bridge.links.tcp import TcpServerLink
from ..bridge.links.udp import UdpOutLink
from ..logs.dataflash.log import DataFlash, attach
from ..logs.tlog import LogError, TlogWriter
from ..simulation import Simulation
from .standstill import Patience

HOST = "127.0.0.1"
BASE_TCP_PORT = 5760
MORE_TCP_PORTS = (5762, 5763)
"""Where ArduPilot's simulator listens, too."""
OUTPUT_PORTS = (14550, 14551, 14540)
"""Where QGroundControl, MAVProxy and MAVSDK listen by default; scripts listen on 14551 beside a ground station."""
STREAM_RATE_HZ = 4
"""Of all stream groups to UDP clients by default, as MAVProxy asks for."""
LOG_STREAMS = {
    "EXTRA1": 10,
    "POSITION": 10,
    "RC_CHAN": 10,
    "EXTRA2": 4,
    "EXTRA3": 2,
    "EXT_STAT": 2,
    "RAW_SENS": 2,
}
"""Rates [Hz] of the stream groups in a run's own log."""


Paced = TypeVar("Paced", contravariant=True)
"""What is paced."""


class Pace(Protocol[Paced]):
    """Decides how much simulated time goes by between two looks at the wall clock."""

    slice_us: int

    def after_slice(self, simulation: Paced) -> None:
        """Called after each slice: wait as long as need be."""
        ...


def tcp_server(port: int) -> TcpServerLink:
    """Listen for MAVLink on a TCP port of this machine; 0 takes a free one.

    Raises:
        LinkAddressError: the port is taken or not allowed.
    """
    try:
        return TcpServerLink(port, HOST)
    except OSError as error:
        hint = "; --instance N uses other ports, --tcp 0 a free one" if error.errno == errno.EADDRINUSE else ""
        raise LinkAddressError(f"link tcp:{HOST}:{port} cannot be opened: {error.strerror}{hint}") from None


def send_to_free_port(simulation: Simulation, port: int) -> None:
    """Send telemetry to a local UDP port that a script of ours will listen on."""
    simulation.bridge.add_link(UdpOutLink(HOST, port))


def stream_everything(simulation: Simulation, link: Link, rate_hz: int) -> None:
    """Send all stream groups to every client of a link at a rate, until it asks otherwise."""
    bridge = simulation.bridge
    bridge.stream_to(link, {ending: rate_hz for ending, _ in bridge.profile.groups.values()})


class ClientFrames:
    """A tap that writes down what clients sent."""

    def __init__(self, writer: TlogWriter, system: int) -> None:
        self._writer, self._system = writer, system

    def frame(self, time_us: int, raw: bytes) -> None:
        """Keep the frame unless the autopilot sent it; a companion may have the vehicle's system id."""
        at = 5 if raw[0] == 0xFD else 3
        if raw[at] != self._system or raw[at + 1] != COMPONENT:
            self._writer.frame(time_us, raw)


def new_file(folder: Path, name: str) -> Path:
    """Make an empty .tlog under a name that nobody else has, not even a run that begins at the same moment."""
    number = 1
    while True:
        path = folder / (f"{name}.tlog" if number == 1 else f"{name}-{number}.tlog")
        try:
            path.open("xb").close()
        except FileExistsError:
            number += 1
        except OSError as error:
            raise LogError(f"log {str(path)!r} cannot be written: {error.strerror or error}") from None
        else:
            return path


def open_log(simulation: Simulation, folder: Path, name: str) -> Path:
    """Start a .tlog: telemetry at rates of its own, and all that clients send. A name that is taken gets a number.

    Raises:
        LogError: the folder cannot be written to.
    """
    path = new_file(folder, name)
    bridge = simulation.bridge
    writer = TlogWriter(path, bridge.epoch_us)
    link = LogLink(writer, simulation)
    bridge.add_link(link)
    bridge.stream_to(link, LOG_STREAMS)
    bridge.client_taps.append(ClientFrames(writer, bridge.system))
    open_dataflash(simulation, path.with_suffix(".bin"))
    return path


def open_dataflash(simulation: Simulation, path: Path) -> DataFlash:
    """Keep on-board logs (.bin) at ``path``, as LOG_BACKEND_TYPE and LOG_DISARMED say; clients can download them."""
    return attach(simulation, path)


def serve(
    simulation: Simulation,
    pace: Pace[Simulation],
    *,
    until_us: int | None = None,
    running: Callable[[], bool] = lambda: True,
    on_slice: Callable[[], None] = lambda: None,
) -> None:
    """Advance until simulated time ``until_us`` (None: without end) or until ``running()`` is false.

    Physics at the other end of a link may go and come back: time stands meanwhile.
    """
    patience = Patience(simulation)
    while running() and (until_us is None or simulation.time_us < until_us):
        target = simulation.time_us + pace.slice_us
        patience.advance_to(target if until_us is None else min(target, until_us))
        on_slice()
        pace.after_slice(simulation)
