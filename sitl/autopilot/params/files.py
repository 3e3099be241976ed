# SPDX-License-Identifier: BSD-3-Clause
""".parm files: one ``NAME VALUE`` a line, separated by blanks, a tab or a comma; ``#`` starts a comment.

The format of Mission Planner, MAVProxy and ArduPilot's default-parameter files.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...errors import SitlError
from .parameter import FLOAT, Parameter
from .table import Table, stored


class ParameterError(SitlError, ValueError):
    """A parameter's name or value that cannot be taken."""


def parse(text: str, source: str = "parameters") -> dict[str, float]:
    """Names and values of a .parm text.

    Raises:
        ParameterError: names the source, the line and what is wrong with it.
    """
    values: dict[str, float] = {}
    for number, line in enumerate(text.splitlines(), 1):
        words = re.split(r"[\s,]+", line.split("#", 1)[0].strip())
        if words == [""]:
            continue
        if len(words) < 2:
            raise ParameterError(f"{source}, line {number}: expected 'NAME VALUE', found {line.strip()!r}")
        try:
            values[words[0].upper()] = float(words[1])
        except ValueError:
            raise ParameterError(f"{source}, line {number}: {words[1]!r} is not a number ({words[0]})") from None
    return values


def load(path: str | Path) -> dict[str, float]:
    """Names and values of a .parm file; ParameterError when it cannot be read or parsed."""
    try:
        return parse(Path(path).read_text(encoding="utf-8"), str(path))
    except OSError as error:
        raise ParameterError(f"parameter file {str(path)!r} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise ParameterError(f"parameter file {str(path)!r} is not text: {error}") from None


def apply(table: Table, params: Any, values: Mapping[str, float], source: str = "parameters") -> list[str]:
    """Set all values in a params record, or none of them; returns the names that this firmware does not have.

    Files of a whole ArduPilot vehicle name a thousand parameters of drivers that do not exist here; they are
    returned, so that the caller can say so.

    Raises:
        ParameterError: a known parameter's value is refused; nothing was set.
    """
    refused = [text for name, value in values.items() if name in table and (text := table[name].refusal(value))]
    if refused:
        raise ParameterError(f"{source}: " + "; ".join(refused))
    for name, value in values.items():
        if name in table:
            params[name] = stored(table[name], value)
    return [name for name in values if name not in table]


def format_value(parameter: Parameter, value: float) -> str:
    """A value as a .parm file shows it: whole for integers, else the shortest text that reads back the same."""
    if parameter.kind != FLOAT:
        return str(int(value))
    return next(text for digits in range(6, 18) if float(text := f"{value:.{digits}g}") == value or digits == 17)


def dump(table: Table, params: Any) -> str:
    """A params record as .parm text, in the table's order."""
    return "".join(f"{p.name},{format_value(p, float(params[p.name]))}\n" for p in table)


def save(table: Table, params: Any, path: str | Path) -> None:
    """Write all parameters to a .parm file."""
    Path(path).write_text(dump(table, params), encoding="utf-8")
