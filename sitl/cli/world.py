# SPDX-License-Identifier: BSD-3-Clause
"""``sitl world``: the worlds there are, and what one looks like."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from .. import worlds
from ..errors import OptionError, SitlError
from .output import add_json_option, print_json


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("world")
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    listing = actions.add_parser("list", help="list the worlds")
    add_json_option(listing, "a list of worlds")
    listing.set_defaults(function=list_worlds)
    show = actions.add_parser("show", help="describe a world and draw its plan to a .png file")
    show.add_argument("world", metavar="NAME|FILE", help="name of a world (sitl world list), or a .toml file")
    show.add_argument("--png", type=Path, metavar="OUT", help="file of the picture (default: NAME.png)")
    show.add_argument(
        "--height", type=float, metavar="Z", help="height of the plan's cut [m] (default: set by the world)"
    )
    show.set_defaults(function=show_world)


def list_worlds(options: argparse.Namespace) -> int:
    """Print every world with what it is."""
    if options.json:
        print_json([row(worlds.load(name)) for name in worlds.names()])
        return 0
    width = max(map(len, worlds.names()))
    for name in worlds.names():
        print(f"{name:{width}s}  {worlds.load(name).description}")
    return 0


def row(world: worlds.World) -> dict[str, Any]:
    """A world as ``--json`` prints it: lengths in metres, angles in degrees."""
    starts = [
        {"name": start.name, "position": start.position, "yaw": math.degrees(start.yaw), "robot": start.robot}
        for start in world.starts
    ]
    return {
        "name": world.name,
        "description": world.description,
        "solids": len(world.solids),
        "bounds": world.bounds,
        "starts": starts,
    }


def show_world(options: argparse.Namespace) -> int:
    """Describe a world and draw it."""
    from ..worlds import drawing

    world = worlds.load(options.world)
    drawing.check_installed()
    print(drawing.summary(world))
    path = options.png or Path(f"{world.name}.png")
    try:
        drawing.draw(world, path, options.height)
    except SitlError as error:
        raise OptionError(f"--png {error}") from None
    except ValueError as error:  # an ending that matplotlib does not know
        raise OptionError(f"--png {str(path)!r} cannot be written: {error}") from None
    print(f"plan: {path}")
    return 0
