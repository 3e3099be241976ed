# SPDX-License-Identifier: BSD-3-Clause
"""Options for faults of links, such as ``--link-loss 0.2``."""

from __future__ import annotations

import argparse

from ..bridge.links import LinkFaults
from ..bridge.links.faults import OPTIONS
from .fault_options import link_cuts


def add_link_options(parser: argparse.ArgumentParser) -> None:
    """Add them: each word is kept as it stands."""
    group = parser.add_argument_group("faults of the links to clients, in simulated time (sitl help faults)")
    for name, (metavar, text) in OPTIONS.items():
        group.add_argument(f"--link-{name}", action="append", default=[], metavar=metavar, help=text)


def link_faults(options: argparse.Namespace) -> LinkFaults | None:
    """What they say; None when none is given.

    Raises:
        OptionError: a word that cannot be understood, or a value that cannot be.
    """
    words = {name: getattr(options, f"link_{name}", []) for name in OPTIONS}
    return LinkFaults.of_texts({**words, "cut": [*words["cut"], *link_cuts(options)]})
