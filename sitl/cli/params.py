# SPDX-License-Identifier: BSD-3-Clause
"""``sitl params``: a firmware's parameters as a .parm file or a documentation page; some of them with their meaning."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from .. import vehicles
from ..autopilot.params import docs, parm_files
from ..autopilot.params.parameter import Parameter, stored
from ..autopilot.params.table import Values
from ..errors import OptionError, did_you_mean
from ..vehicle.kinds import DEFAULT, KINDS
from .options import check_kind
from .output import print_json


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("params")
    parser.add_argument(
        "words", nargs="*", metavar="WORD",
        help="print value, range and meaning of the parameters that have all these words in name or meaning",
    )  # fmt: skip
    parser.add_argument("--vehicle", choices=sorted(KINDS), help=f"firmware (default: that of --frame, or {DEFAULT})")
    parser.add_argument(
        "--frame", metavar="NAME", help="use the values of this airframe, or of a .toml or .py file of one"
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument(
        "--markdown", action="store_true", help="print the documentation page: meaning, range, unit, default"
    )
    form.add_argument("--json", action="store_true", help="for programs: a list of parameters")
    parser.set_defaults(function=params)


def params(options: argparse.Namespace) -> int:
    """Print every parameter, or those that are looked for.

    Raises:
        OptionError: the airframe is of another kind than the vehicle, or no parameter has the words.
    """
    if options.words and options.markdown:
        raise OptionError("--markdown prints all parameters; leave out the words or --markdown")
    airframe = vehicles.load(options.frame) if options.frame else None
    if airframe and options.vehicle:
        check_kind(options.frame, airframe, options.vehicle)
    kind = KINDS[airframe.kind if airframe else options.vehicle or DEFAULT]
    table = kind.firmware.table
    if options.markdown:
        print(docs.page(kind.name, table), end="")
        return 0

    holder = table.record()
    table.set_defaults(holder)
    values = Values(table, holder)
    if airframe:
        parm_files.apply(values, airframe.parameters, airframe.title)
    found = [p for p in table if has_words(p, options.words)]
    if not found:
        known = did_you_mean(options.words[0].upper(), [p.name for p in table]) if len(options.words) == 1 else ""
        raise OptionError(f"no parameter of the {kind.name} has {' and '.join(map(repr, options.words))}{known}")
    if options.json:
        print_json([row(p, values[p.name]) for p in found])
    elif options.words:
        for p in found:
            print(described(p, values[p.name]))
    else:
        print(parm_files.dump(values), end="")
    return 0


def has_words(p: Parameter, words: Sequence[str]) -> bool:
    """Whether name or meaning of a parameter contain all words; capitals do not count."""
    text = f"{p.name} {p.doc}".lower()
    return all(word.lower() in text for word in words)


def described(p: Parameter, value: float) -> str:
    """A parameter in two lines: name, value, default and range; its meaning."""
    unit = f" {p.unit}" if p.unit else ""
    default = stored(p, p.default)
    usual = "" if value == default else f", default {default:.7g}"
    meaning = p.doc if p.has_effect else f"{p.doc} (kept, without effect here)"
    return f"{p.name} = {value:.7g}{unit} ({p.low:.7g} .. {p.high:.7g}{usual})\n    {meaning}"


def row(p: Parameter, value: float) -> dict[str, Any]:
    """A parameter as ``--json`` prints it."""
    return {
        "name": p.name,
        "value": value,
        "default": stored(p, p.default),
        "low": p.low,
        "high": p.high,
        "unit": p.unit,
        "type": p.kind,
        "meaning": p.doc,
        "has_effect": p.has_effect,
    }
