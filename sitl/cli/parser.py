# SPDX-License-Identifier: BSD-3-Clause
"""The parser of command lines: a user's mistake is one line that says what is allowed and where to read more."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable
from functools import partial
from typing import Any, NoReturn

from ..errors import did_you_mean

_MISSING = "the following arguments are required: "
_CHOICE = re.compile(r"argument (?P<name>\S+): invalid choice: (?P<value>'.*?'|\S+) \(choose from (?P<choices>.*)\)$")
_SHOWN = 12
"""Choices that are listed in full."""


class Parser(argparse.ArgumentParser):
    """As ``argparse``'s, with errors of one line. An option must be written in full: an abbreviation would change its
    meaning when another option begins with the same letters."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        layout = partial(argparse.HelpFormatter, max_help_position=28)
        super().__init__(*args, **{"allow_abbrev": False, "formatter_class": layout, **kwargs})

    def error(self, message: str) -> NoReturn:
        """Leave with exit code 2 after one line on standard error."""
        self.exit(2, f"{self.prog}: {self._plain(message)} (see {self.prog} --help)\n")

    def parse_known_args(  # type: ignore[override]  # the base has an overload for each way to leave one out
        self, args: Iterable[str] | None = None, namespace: Any = None
    ) -> tuple[Any, list[str]]:
        """As the base's, but what is not known is refused by the command that it was given to, not by ``sitl``."""
        found, extra = super().parse_known_args(args, namespace)
        if extra:
            self.error(f"unrecognized arguments: {' '.join(extra)}")
        return found, extra

    def _plain(self, message: str) -> str:
        if message.startswith(_MISSING):
            names = message.removeprefix(_MISSING).split(", ")
            return " and ".join(map(self._wanted, names)) + (" is missing" if len(names) == 1 else " are missing")
        if message.startswith("unrecognized arguments: "):
            word = message.removeprefix("unrecognized arguments: ").split()[0]
            if word.startswith("-"):
                name = word.partition("=")[0]
                return f"there is no option {name}{did_you_mean(name, self._option_string_actions)}"
            return f"{word!r} is one argument too many"
        choice = _CHOICE.match(message)
        if choice:
            value, choices = choice["value"].strip("'"), re.findall(r"'([^']*)'|([^\s',]+)", choice["choices"])
            allowed = [quoted or bare for quoted, bare in choices]
            shown = f"; it is one of {', '.join(allowed)}" if len(allowed) <= _SHOWN else ""
            return f"{choice['name']} {value!r} is not known{did_you_mean(value, allowed) or shown}"
        return message.removeprefix("argument ")

    def _wanted(self, name: str) -> str:
        """How a missing argument is named: with its choices, where they are few."""
        for action in self._actions:
            if name in (action.metavar, action.dest, *action.option_strings) and action.choices is not None:
                if len(list(action.choices)) <= _SHOWN:
                    return f"{name} ({' or '.join(map(str, action.choices))})"
        return name
