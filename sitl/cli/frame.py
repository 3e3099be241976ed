# SPDX-License-Identifier: BSD-3-Clause
"""``sitl frame``: the airframes there are, and one as a file to change and to fly (``--frame FILE.toml``)."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import vehicles
from ..core.whole_file import write_whole
from ..errors import OptionError
from .output import add_json_option, print_json


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("frame")
    parser.add_argument(
        "frame", nargs="?", metavar="NAME|FILE", help="print this airframe as a .toml file (default: list them)"
    )
    parser.add_argument("--out", type=Path, metavar="FILE.toml", help="write the file instead of printing it")
    add_json_option(parser, "a list of airframes, or one with all its properties")
    parser.set_defaults(function=show)


def show(options: argparse.Namespace) -> int:
    """List the airframes, or print one."""
    if options.frame is None:
        if options.out is not None:
            raise OptionError(f"--out {str(options.out)!r} is the file of one airframe; which? `sitl frame` lists them")
        _list(options.json)
        return 0
    airframe = vehicles.load(options.frame)
    if options.json:
        data = vehicles.to_data(airframe)
        of_before = {"figures": data["properties"]}  # the key of version 0.1, until 0.4
        print_json({"kind": airframe.kind, "description": airframe.description, **data, **of_before})
    elif options.out is None:
        print(vehicles.to_toml(airframe), end="")
    else:
        write(options.out, vehicles.to_toml(airframe), "--out")
    return 0


def write(path: Path, text: str, option: str) -> None:
    """Write an airframe's file and say so.

    Raises:
        OptionError: it cannot be written, or ``--frame`` would not take it for a file.
    """
    if path.suffix != ".toml":
        raise OptionError(f"{option} {str(path)!r} does not end in .toml, by which --frame tells such files")
    write_whole(path, text, OptionError, f"{option} {str(path)!r}")
    print(f"airframe: {path}")


def _list(as_json: bool) -> None:
    found = [vehicles.load(name) for name in vehicles.names()]
    if as_json:
        print_json([{"name": one.name, "kind": one.kind, "description": one.description} for one in found])
        return
    width = max(len(one.name) for one in found)
    for one in found:
        print(f"{one.name:{width}}  {one.kind:6}  {one.description}")
