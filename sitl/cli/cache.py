# SPDX-License-Identifier: BSD-3-Clause
"""``sitl cache``: the compiled core on disk."""

from __future__ import annotations

import argparse

from ..core import compile as compiler


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("cache", help="show, clear or build the compiled core")
    parser.add_argument("action", choices=("show", "clear", "build"))
    parser.set_defaults(function=cache)


def cache(options: argparse.Namespace) -> int:
    """Show where the compiled core is, delete it, or build what is missing."""
    from ..advance import advance
    from ..vehicle import VEHICLE_DTYPE
    from .progress import CompileProgress

    if options.action == "clear":
        print(f"deleted {compiler.clear_cache()} compiled units from {compiler.cache_folder()}")
    elif options.action == "build":
        with CompileProgress() as progress:
            took = compiler.build(advance, "sitl.vehicle.VEHICLE_DTYPE", VEHICLE_DTYPE, progress)
        print(f"built in {took:.1f} s")
    else:
        absent = {u.name for u in compiler.missing(VEHICLE_DTYPE)}
        print(compiler.cache_folder())
        for unit in compiler.UNITS.values():
            print(f"  {'to build' if unit.name in absent else 'ready   '}  {unit.name}")
    return 0
