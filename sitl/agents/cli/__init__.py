# SPDX-License-Identifier: BSD-3-Clause
"""Subcommands of ``sitl``: every module of this folder with ``add_parser(commands)`` is one."""

from __future__ import annotations

import argparse
import pkgutil
from importlib import import_module


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the commands."""
    for found in sorted(pkgutil.iter_modules(__path__), key=lambda found: found.name):
        module = import_module(f"{__name__}.{found.name}")
        if hasattr(module, "add_parser"):
            module.add_parser(commands)
