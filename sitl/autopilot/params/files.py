# SPDX-License-Identifier: BSD-3-Clause
""".parm files: one ``NAME VALUE`` a line, separated by blanks, a tab or a comma; ``#`` starts a comment.

The format of Mission Planner, MAVProxy and ArduPilot's default-parameter files.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from ...core.whole_file import write_whole
from ...errors import SitlError
from .parameter import FLOAT, Parameter, stored
from .table import Values


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


def apply(values: Values, given: Mapping[str, float], source: str = "parameters") -> list[str]:
    """Set a vehicle's parameters to all values given, or none of them; returns the names that its firmware lacks.

    Files of another version of ArduPilot have names that this one does not know; they are returned, so that the
    caller can say so.

    Raises:
        ParameterError: a known parameter's value is refused; nothing was set.
    """
    known = {name: value for name, value in given.items() if name in values.table}
    refused = [text for name, value in known.items() if (text := values.table[name].refusal(value))]
    if refused:
        raise ParameterError(f"{source}: " + "; ".join(refused))
    values.update(known)
    return [name for name in given if name not in known]


def format_value(parameter: Parameter, value: float) -> str:
    """A value as a .parm file shows it: whole for integers, else the shortest text that is stored as the same."""
    if parameter.kind != FLOAT:
        return str(int(value))
    texts = [f"{value:.{digits}g}" for digits in range(6, 18)]
    return next((text for text in texts if stored(parameter, float(text)) == value), texts[-1])


def dump(values: Values) -> str:
    """A vehicle's parameters as .parm text, in the table's order.

    Those are left out that have no effect, were not set, and whose group is switched off.
    """
    shown = {p.name for p in values.listed()} | values.kept.keys()
    chosen = (p for p in values.table if p.has_effect or p.name in shown)
    return "".join(f"{p.name},{format_value(p, values[p.name])}\n" for p in chosen)


def save(values: Values, path: str | Path) -> None:
    """Write a vehicle's parameters to a .parm file.

    Raises:
        SitlError: it cannot be written; the file of before stays.
    """
    write_whole(path, dump(values), title=f"parameter file {path}")
