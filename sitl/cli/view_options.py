# SPDX-License-Identifier: BSD-3-Clause
"""Options of commands that can show their vehicle on a page in the browser, and what they mean."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
import webbrowser
from collections.abc import Callable, Iterator

from ..run.pacing import StoppablePacing
from ..run.watched import Watched
from ..simulation import OptionError, Simulation
from .options import port


def add_view_options(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("--view", action="store_true", help="show the vehicle on a page in the browser (docs/view.md)")
    parser.add_argument("--view-only", action="store_true", help="the same; the page can do nothing to the vehicle")
    parser.add_argument(
        "--view-port", type=port, default=0, metavar="PORT", help="of the page on this machine (default: a free one)"
    )


    parser.add_argument(
        "--view-address", metavar="HOST", help="offer the page to other machines: an address of this one, or 0.0.0.0"
    )
    parser.add_argument("--view-token", metavar="TOKEN", help="what they must know for that; nothing is encrypted")


def wants_view(options: argparse.Namespace) -> bool:
    """Whether a page is asked for.

    Raises:
        OptionError: an address for other machines without a token, or without a page.
    """
    wanted = bool(options.view or options.view_only)
    if (options.view_address is None) != (options.view_token is None):
        raise OptionError("--view-address and --view-token go together: without a token anybody could fly the vehicle")
    if options.view_address is not None and not wanted:
        raise OptionError("--view-address is of use with --view or --view-only alone")
    return wanted


@contextlib.contextmanager
def shown(
    simulation: Simulation, options: argparse.Namespace, pace: StoppablePacing | None, then: Callable[[], None]
) -> Iterator[Callable[[], None]]:
    """The page that the options ask for, while the block runs; gives what is to be called after each slice.

    Raises:
        MissingExtra: what draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
        sitl.view.gate.GateError: the address or the token cannot be used.
    """
    if not wants_view(options):
        yield then
        return
    from ..view.gate import Gate
    from ..view.live_page import LivePage

    with contextlib.ExitStack() as stack:
        port_inside = 0 if options.view_address is not None else options.view_port
        page = LivePage(simulation, pace, port_inside, controls=not options.view_only)
        stack.callback(page.close)
        address = page.address
        if options.view_address is not None:
            gate = Gate(options.view_address, options.view_port, options.view_token, page.port)
            stack.callback(gate.close)
            address = gate.address
        print(f"page: {address}", flush=True)
        open_browser(page.address)
        yield Watched(page, lambda: simulation.time_us, then)


def open_browser(address: str) -> None:
    """Open a page where there is a display."""
    has_display = sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if has_display:
        webbrowser.open(address)
