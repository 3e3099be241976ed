# SPDX-License-Identifier: BSD-3-Clause
"""``sitl arducopter``, ``sitl ardurover``, and the installed scripts of these names."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from ..drop_in import server
from ..errors import SitlError
from . import plugins
from .progress import CompileProgress


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the commands; their words are ArduPilot's, so that none of them is an option here."""
    for program in server.PROGRAMS:
        parser = commands.add_parser(program, add_help=False, prefix_chars="\0")
        parser.add_argument("words", nargs="*", metavar="OPTION")
        parser.set_defaults(function=lambda options: run(options.command, options.words))


def run(program: str, words: Sequence[str]) -> int:
    """Run the executable; returns the exit code."""
    with CompileProgress() as progress:
        return server.run(program, words, progress)


def _main(program: str) -> int:
    try:
        plugins.load()
        return run(program, sys.argv[1:])
    except SitlError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130


def arducopter() -> int:
    """The installed script."""
    return _main("arducopter")


def ardurover() -> int:
    """The installed script."""
    return _main("ardurover")
