# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command.

Other packages add subcommands by the entry-point group ``sitl.commands``: its name is the subcommand's, its object a
module with ``add_parser(commands)`` like those here.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from importlib import metadata

from .. import __version__
from ..errors import SitlError
from . import cache, demo, drop_in, execute, params, physics, run, world

COMMANDS = (run, drop_in, execute, demo, physics, params, world, cache)
GROUP = "sitl.commands"


def parser() -> argparse.ArgumentParser:
    """The command line of every subcommand."""
    top = argparse.ArgumentParser(prog="sitl", description="Autopilot-in-the-loop simulator in simulated time.")
    top.add_argument("--version", action="version", version=f"gym-sitl {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for module in COMMANDS:
        module.add_parser(commands)
    for name, entry in added():
        try:
            entry.load().add_parser(commands)
        except Exception as error:  # whatever a package does when it is loaded: the other commands must work
            print(f"sitl: subcommand {name} ({entry.value}) cannot be loaded: {error!r}", file=sys.stderr)
    return top


def added() -> Iterator[tuple[str, metadata.EntryPoint]]:
    """(name, entry point) of each subcommand that a package adds, by name; the first of a name counts."""
    seen = {module.__name__.rpartition(".")[2] for module in COMMANDS}
    for entry in sorted(metadata.entry_points(group=GROUP), key=lambda entry: entry.name):
        if entry.name not in seen:
            seen.add(entry.name)
            yield entry.name, entry


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code. A user's mistake is one line on stderr and code 2."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(words)
    try:
        return int(options.function(options))
    except SitlError as error:
        print(f"sitl {options.command}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 141
