# SPDX-License-Identifier: BSD-3-Clause
"""Options of commands that can show their vehicle on a page in the browser, and what they mean."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
import webbrowser
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from ..plants.local import LocalPlant
from ..run.pacing import MAX, StoppablePacing
from ..run.watched import Watched
from ..simulation import OptionError, Simulation
from ..swarm import Swarm
from ..view import page_library
from .options import port

if TYPE_CHECKING:
    from ..view.page import Page


def add_view_options(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument(
        "--view", action="store_true", help="show the vehicle on a page in the browser (sitl help view)"
    )
    parser.add_argument("--view-only", action="store_true", help="the same, without controls")
    parser.add_argument(
        "--view-port", type=port, default=0, metavar="PORT", help="port of the page (default: a free one)"
    )
    parser.add_argument(
        "--view-address",
        metavar="HOST",
        help="address of the page, for other machines (default 127.0.0.1; needs --view-token)",
    )
    parser.add_argument("--view-token", metavar="TOKEN", help="token in the address of the page; nothing is encrypted")


DEFAULT_TEXT = f"{MAX}, with --view 1"


def default_speedup(options: argparse.Namespace) -> str:
    """Of commands that go as fast as they can: somebody who looks wants to see it.

    Raises:
        OptionError, MissingExtra: as of ``wants_view``.
    """
    return "1" if wants_view(options) else MAX


def check_view(options: argparse.Namespace) -> None:
    """Refuse what cannot be before anything is compiled or written.

    Raises:
        OptionError, MissingExtra: as of ``wants_view``.
        sitl.view.page.PageAddressError, sitl.view.gate.GateError: as of ``shown``.
    """
    if not wants_view(options):
        return
    from ..view import gate
    from ..view.page import free_port

    if options.view_address is None:
        free_port(options.view_port)
    else:
        gate.check(options.view_address, options.view_port, options.view_token)


def wants_view(options: argparse.Namespace) -> bool:
    """Whether a page is asked for.

    Raises:
        OptionError: an address for other machines without a token, or without a page.
        MissingExtra: what draws it is not installed.
    """
    wanted = bool(options.view or options.view_only)
    if (options.view_address is None) != (options.view_token is None):
        raise OptionError("--view-address and --view-token go together: without a token anybody could fly the vehicle")
    for name, given in (("address", options.view_address is not None), ("port", options.view_port)):
        if given and not wanted:
            raise OptionError(f"--view-{name} needs --view or --view-only")
    if wanted:
        page_library.require()
    return wanted


@contextlib.contextmanager
def shown(
    subject: Simulation | Swarm | LocalPlant,
    options: argparse.Namespace,
    pace: StoppablePacing | None = None,
    then: Callable[[], None] = lambda: None,
) -> Iterator[Callable[[], None]]:
    """The page that the options ask for, while the block runs; gives what is to be called after each slice.

    Args:
        subject: a vehicle, several, or the physics of one whose autopilot is elsewhere: that one has no controls.
        options: of the command.
        pace: lets its time pass; None: nobody can stop it on the page.
        then: called after each slice, too.

    Raises:
        MissingExtra: what draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
        sitl.view.gate.GateError: the address or the token cannot be used.
    """
    if not wants_view(options):
        yield then
        return
    from ..view.live_page import LivePage
    from ..view.page import Page
    from ..view.plant import PlantSource

    port_inside = 0 if options.view_address is not None else options.view_port
    clock: Callable[[], int]
    page: Page
    if isinstance(subject, LocalPlant):
        clock = subject.vehicle.reader.field("time_us")
        page = Page(PlantSource(subject), port_inside)
    else:
        vehicles = subject if isinstance(subject, Simulation) else subject.vehicles
        page = LivePage(vehicles, pace, port_inside, controls=not options.view_only)
        clock = partial(getattr, subject, "time_us")
    with offered(page, options):
        yield Watched(page, clock, then)


@contextlib.contextmanager
def offered(page: Page, options: argparse.Namespace) -> Iterator[None]:
    """Say where a page is, and open a browser; it is closed at the end."""
    from ..view.gate import Gate

    with contextlib.ExitStack() as stack:
        stack.callback(page.close)
        address = page.address
        if options.view_address is not None:
            gate = Gate(options.view_address, options.view_port, options.view_token, page.port)
            stack.callback(gate.close)
            address = gate.address
        print(f"page: {address}", flush=True)
        open_browser(page.address)
        yield


def open_browser(address: str) -> None:
    """Open a page where there is a display."""
    has_display = sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if has_display:
        webbrowser.open(address)
