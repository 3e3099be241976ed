# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink's commands and constants by their names, as pymavlink's ``ardupilotmega`` dialect has them."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega

from ..errors import did_you_mean
from .errors import UnknownNameError

PREFIX = "MAV_CMD_"
_ENTRIES = ardupilotmega.enums["MAV_CMD"]


@cache
def _numbers() -> dict[str, int]:
    return {entry.name.removeprefix(PREFIX): number for number, entry in _ENTRIES.items()}


def command_number(name: str) -> int:
    """Number of a command, with or without "MAV_CMD_".

    Raises:
        UnknownNameError: there is no such command.
    """
    short = name.removeprefix(PREFIX)
    if short not in _numbers():
        raise UnknownNameError(f"MAVLink has no command {name!r}{did_you_mean(short, _numbers())}")
    return _numbers()[short]


def command_name(number: int) -> str:
    """Name of a command without "MAV_CMD_"; its number in words when there is none."""
    entry = _ENTRIES.get(number)
    return entry.name.removeprefix(PREFIX) if entry is not None else f"command {number}"


@cache
def argument_names(number: int) -> dict[str, int]:
    """Name -> index (0 .. 6) of a command's parameters: MAVLink's labels in snake case, and "param1" .. "param7"."""
    names = {f"param{k}": k - 1 for k in range(1, 8)}
    entry = _ENTRIES.get(number)
    labels = entry.label if entry is not None else {}
    return names | {re.sub(r"\W+", "_", label).lower(): k - 1 for k, label in labels.items()}


def arguments(number: int, params: tuple[Any, ...], named: dict[str, Any]) -> list[Any]:
    """The parameters of a command in order, as many as are given.

    Args:
        params: the first ones.
        named: others by name; a text is the name of a MAVLink constant.

    Raises:
        UnknownNameError: the command has no such parameter; there is no such constant.
    """
    known = argument_names(number)
    values: list[Any] = list(params)
    for name, value in named.items():
        if name not in known:
            labels = [label for label in known if not re.fullmatch(r"param\d", label)]
            raise UnknownNameError(
                f"{command_name(number)} has no parameter {name!r}; it has {', '.join([*labels, 'param1 .. param7'])}"
            )
        values += [0.0] * (known[name] + 1 - len(values))
        values[known[name]] = value
    return [constant(value) if isinstance(value, str) else value for value in values]


def constant(name: str) -> int:
    """A constant of MAVLink by its full name, such as "MAV_FRAME_LOCAL_NED".

    Raises:
        UnknownNameError: there is none.
    """
    value = getattr(ardupilotmega, name, None) if name.isupper() else None
    if not isinstance(value, int):
        raise UnknownNameError(f"MAVLink has no constant {name!r}")
    return value


def entry_name(enum: str, number: int) -> str:
    """Name of an entry of a MAVLink enumeration in lower-case words, without the enumeration's own name."""
    entry = ardupilotmega.enums[enum].get(number)
    if entry is None:
        return f"{enum} {number}"
    return str(entry.name).removeprefix(f"{enum}_").lower().replace("_", " ")
