# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission library``: the missions that come with the simulator."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path

from sitl.cli.options import open_folder
from sitl.cli.output import add_json_option, print_json
from sitl.core.whole_file import write_whole
from sitl.errors import OptionError

from .. import library


def add_parser(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = actions.add_parser("library", help="list or copy the missions of this package")
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as copter/square (default: all)")
    parser.add_argument("--copy", type=Path, metavar="DIR", help="copy their files to this folder")
    add_json_option(parser, "a list of missions")
    parser.set_defaults(function=show)


def show(options: argparse.Namespace) -> int:
    """List them, or copy their files."""
    chosen = [library.find(name) for name in options.names] or list(library.entries().values())
    if options.json and options.copy is None:
        print_json([{**asdict(entry), "path": str(entry.path)} for entry in chosen])
        return 0
    for entry in chosen:
        if options.copy is None:
            where = f" [{entry.frame}{', world ' + entry.world if entry.world else ''}]"
            print(f"{entry.name:24s} {entry.description}{where}")
            continue
        target = options.copy / entry.file
        if target.exists():
            raise OptionError(f"{target} is there already")
        open_folder(target.parent, "--copy")
        write_whole(target, entry.path.read_bytes(), OptionError)
        print(target)
    return 0
