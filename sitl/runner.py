# SPDX-License-Identifier: BSD-3-Clause
"""Runs a simulation with clients on sockets: advance a slice, look at the wall clock, serve the sockets, again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .bridge.links.address import open_link
from .bridge.links.tcp import TcpServerLink
from .logs.tlog import TlogWriter
from .pacing import Pacing
from .simulation import Simulation

HOST = "127.0.0.1"
BASE_TCP_PORT = 5760
DEFAULT_OUTPUTS = ("udp:127.0.0.1:14550", "udp:127.0.0.1:14540")
"""Where QGroundControl, MAVProxy and MAVSDK listen by default."""
LOG_EPOCH_US = 1_577_836_800_000_000
"""Time stamp of power-on in a .tlog: 2020-01-01, whatever the wall clock says, so that equal flights give equal logs."""


def open_links(simulation: Simulation, outputs: list[str], tcp_port: int) -> list[str]:
    """Open the outputs and the TCP server; returns what is open, as text.

    Raises:
        LinkAddressError: an address that cannot be understood or opened.
    """
    opened = []
    tcp = open_link(f"tcp:{HOST}:{tcp_port}") if tcp_port else TcpServerLink(0, HOST)
    for link in [tcp, *(open_link(text) for text in outputs)]:
        simulation.bridge.add_link(link)
        opened.append(link.name)
    return opened


def open_log(simulation: Simulation, folder: Path, name: str) -> Path:
    """Start a .tlog of everything sent and received; the name gets a number when it is taken."""
    path = folder / f"{name}.tlog"
    number = 1
    while path.exists():
        number += 1
        path = folder / f"{name}-{number}.tlog"
    simulation.bridge.set_tlog(TlogWriter(path, epoch_us=LOG_EPOCH_US))
    return path


def serve(
    simulation: Simulation,
    pacing: Pacing,
    *,
    until_us: int | None = None,
    running: Callable[[], bool] = lambda: True,
    after_slice: Callable[[], None] = lambda: None,
) -> None:
    """Advance until simulated time ``until_us`` (None: without end) or until ``running()`` is false."""
    while running() and (until_us is None or simulation.time_us < until_us):
        target = simulation.time_us + pacing.slice_us
        simulation.advance_to(target if until_us is None else min(target, until_us))
        after_slice()
        simulation.bridge.wait(pacing.after_slice())
