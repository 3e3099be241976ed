# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission``: fly, convert, record, replay and compare missions.

Every module of this folder with ``add_parser(commands)`` is one of its commands.
"""

from __future__ import annotations

import argparse
import pkgutil
from importlib import import_module


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare ``sitl mission`` and its commands."""
    parser = commands.add_parser("mission")
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    for found in sorted(pkgutil.iter_modules(__path__), key=lambda found: found.name):
        module = import_module(f"{__name__}.{found.name}")
        if hasattr(module, "add_parser"):
            module.add_parser(actions)
