# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command.

Other packages add subcommands by the entry-point group ``sitl.commands``: its name is the subcommand's, its object a
module with ``add_parser(commands)`` like those here. What they add to the simulator itself is in their ``plugins``.
"""

from __future__ import annotations

import argparse
import errno
import os
import sys
from collections.abc import Iterator, Sequence
from importlib import import_module, metadata
from typing import Any

from ..errors import SitlError
from ..version import __version__
from . import plugins
from .command_list import COMMANDS, WELCOME
from .parser import Parser

GROUP = "sitl.commands"
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
"""Why a file that is open cannot be written."""


class _Commands(argparse._SubParsersAction):  # type: ignore[type-arg]  # at run time it takes none
    """Subcommands; the help of those that come with the package is in the table."""

    def add_parser(self, name: str, **settings: Any) -> argparse.ArgumentParser:
        """Declare one."""
        if name in COMMANDS:
            settings["help"] = COMMANDS[name].help
        return super().add_parser(name, **settings)


def parser(words: Sequence[str] | None = None) -> argparse.ArgumentParser:
    """The command line, for these words: what is needed to understand them is loaded. Without: every subcommand."""
    top = Parser(prog="sitl", description="Autopilot-in-the-loop simulator in simulated time.")
    top.add_argument("--version", action="version", version=f"gym-sitl {__version__}")
    commands = top.add_subparsers(action=_Commands, dest="command", required=True, metavar="COMMAND")
    given = next((word for word in words if not word.startswith("-")), None) if words is not None else None
    for name, listed in COMMANDS.items():
        if name in commands.choices:
            continue
        if words is None or name == given:
            import_module(listed.module).add_parser(commands)
        elif given is None or given not in COMMANDS or COMMANDS[given].module != listed.module:
            commands.add_parser(name)
    if given is None or given not in COMMANDS:
        _add_others(commands)
    return top


def _add_others(commands: argparse._SubParsersAction[Parser]) -> None:
    """Load the subcommands of other packages."""
    for name, entry in added():
        try:
            entry.load().add_parser(commands)
        except Exception as error:  # whatever a package does when it is loaded: the other commands must work
            print(f"sitl: subcommand {name} ({entry.value}) cannot be loaded: {error!r}", file=sys.stderr)


def added() -> Iterator[tuple[str, metadata.EntryPoint]]:
    """(name, entry point) of each subcommand that a package adds, by name; the first of a name counts."""
    seen = set(COMMANDS)
    for entry in sorted(metadata.entry_points(group=GROUP), key=lambda entry: entry.name):
        if entry.name not in seen:
            seen.add(entry.name)
            yield entry.name, entry


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code. A user's mistake is one line on stderr and code 2."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if "_ARGCOMPLETE" in os.environ:
        complete()
    if not words:
        print(WELCOME, end="")
        return 0
    command = words[0]
    try:
        if command != "doctor":  # which tells what of them is broken
            plugins.load()
        options = parser(words).parse_args(words)
        code = int(options.function(options))
        sys.stdout.flush()  # a full disk is told now
        return code
    except SitlError as error:
        print(f"sitl {command}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 141
    except OSError as error:
        if error.filename is None and error.errno in FULL:  # every other writer names its file
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            print(f"sitl {command}: its output cannot be written: {error.strerror}", file=sys.stderr)
            return 2
        if error.filename is None:
            raise
        print(f"sitl {command}: {str(error.filename)!r}: {error.strerror}", file=sys.stderr)
        return 2


def complete() -> None:
    """Answer a shell that asks how the words of its command line may go on, and leave."""
    import argcomplete

    line = os.environ.get("COMP_LINE", "").split()[1:]
    argcomplete.autocomplete(parser(line))
