# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from .. import __version__, errors
from . import cache, demo, execute, params, physics, run, world

COMMANDS = (run, execute, demo, physics, params, world, cache)


def parser() -> argparse.ArgumentParser:
    """The command line of every subcommand."""
    top = argparse.ArgumentParser(prog="sitl", description="Autopilot-in-the-loop simulator in simulated time.")
    top.add_argument("--version", action="version", version=f"gym-sitl {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for module in COMMANDS:
        module.add_parser(commands)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code. A user's mistake is one line on stderr and code 2."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(words)
    try:
        return int(options.function(options))
    except errors.USER_ERRORS as error:
        print(f"sitl {options.command}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 141
