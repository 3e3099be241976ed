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
from ..simulation import Simulation
from .options import port


def add_view_options(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("--view", action="store_true", help="show the vehicle on a page in the browser (docs/view.md)")
    parser.add_argument("--view-only", action="store_true", help="the same; the page can do nothing to the vehicle")
    parser.add_argument(
        "--view-port", type=port, default=0, metavar="PORT", help="of the page on this machine (default: a free one)"
    )


def wants_view(options: argparse.Namespace) -> bool:
    """Whether a page is asked for."""
    return bool(getattr(options, "view", False) or getattr(options, "view_only", False))


@contextlib.contextmanager
def shown(
    simulation: Simulation, options: argparse.Namespace, pace: StoppablePacing | None, then: Callable[[], None]
) -> Iterator[Callable[[], None]]:
    """The page that the options ask for, while the block runs; gives what is to be called after each slice.

    Raises:
        MissingExtra: what draws it is not installed.
        sitl.view.page.PageAddressError: the port is taken.
    """
    if not wants_view(options):
        yield then
        return
    from ..view.live_page import LivePage

    page = LivePage(simulation, pace, options.view_port, controls=not options.view_only)
    try:
        print(f"page: {page.address}", flush=True)
        open_browser(page.address)
        yield Watched(page, lambda: simulation.time_us, then)
    finally:
        page.close()


def open_browser(address: str) -> None:
    """Open a page where there is a display."""
    has_display = sys.platform in ("darwin", "win32") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if has_display:
        webbrowser.open(address)
