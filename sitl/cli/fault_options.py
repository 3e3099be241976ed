# SPDX-License-Identifier: BSD-3-Clause
"""``--fail``: which faults are of the vehicle and which of its links, and what became of them."""

from __future__ import annotations

import argparse
import sys

from ..bridge.services.failure_injection import FaultService
from ..errors import OptionError
from ..simulation import Simulation
from ..vehicle.faults import FORM, LATEST_S, Text

LINK = "link"
"""Fault of the links to all clients: they are cut."""


def add_fail_option(parser: argparse.ArgumentParser) -> None:
    """``--fail``."""
    parser.add_argument(
        "--fail",
        action="append",
        default=[],
        metavar="FAULT",
        help=f"inject a fault: {FORM}, such as gps@12, motor:2=0.5@20..30 or link@60..75 "
        "(repeatable; sitl help faults)",
    )


def _is_of_link(text: str) -> bool:
    return text.strip().partition("@")[0].partition(":")[0].partition("/")[0].partition("=")[0] == LINK


def vehicle_faults(options: argparse.Namespace) -> list[str]:
    """Those of the vehicle.

    Raises:
        OptionError: one of links, and the command has none that can fail.
    """
    given = getattr(options, "fail", [])
    of_links = [text for text in given if _is_of_link(text)]
    if of_links and not hasattr(options, "link_cut"):
        raise OptionError(f"--fail {of_links[0]}: this command has no links that can fail; sitl run and sitl exec have")
    return [text for text in given if text not in of_links]


def link_cuts(options: argparse.Namespace) -> list[str]:
    """When links are cut, as words of ``--link-cut``.

    Raises:
        OptionError: a fault of links that says more than its times.
    """
    cuts = []
    for text in filter(_is_of_link, getattr(options, "fail", [])):
        found = Text.of(text)
        if found.instance or found.type or found.amount is not None:
            raise OptionError(f"--fail {text}: links are cut, as in link@60..75; --link-loss and others do less")
        cuts.append(f"{found.begin or 0.0}..{LATEST_S if found.end is None else found.end}")
    return cuts


def watch_faults(simulation: Simulation) -> None:
    """Take down which of the faults act."""
    service = simulation.bridge.get(FaultService)
    if service.texts:
        service.keep_history()


def say_faults(simulation: Simulation) -> None:
    """Say which faults acted, from when to when, and which never did: a trial of those was none."""
    history = simulation.bridge.get(FaultService).history
    for acted in history.finish(simulation.time_us) if history is not None else ():
        print(acted if acted.spans else f"sitl: {acted}", file=sys.stdout if acted.spans else sys.stderr)
