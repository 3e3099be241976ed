# SPDX-License-Identifier: BSD-3-Clause
"""``sitl params``: a firmware's parameters as a .parm file or a documentation page."""

from __future__ import annotations

import argparse
from typing import Any

from .. import vehicles
from ..autopilot.params import docs, files
from ..autopilot.params.parameter import Parameter, stored
from ..autopilot.params.table import Values
from ..vehicle.kinds import DEFAULT, KINDS
from .options import check_kind
from .output import print_json


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("params")
    parser.add_argument("--vehicle", choices=sorted(KINDS), help=f"firmware (default: that of --frame, or {DEFAULT})")
    parser.add_argument("--frame", metavar="NAME", help="use the values of this airframe")
    form = parser.add_mutually_exclusive_group()
    form.add_argument(
        "--markdown", action="store_true", help="print the documentation page: meaning, range, unit, default"
    )
    form.add_argument("--json", action="store_true", help="for programs: a list of parameters")
    parser.set_defaults(function=params)


def params(options: argparse.Namespace) -> int:
    """Print every parameter.

    Raises:
        OptionError: the airframe is of another kind than the vehicle.
    """
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
        files.apply(values, airframe.parameters, f"airframe {airframe.name}")
    if options.json:
        print_json([row(p, values[p.name]) for p in table])
    else:
        print(files.dump(values), end="")
    return 0


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
