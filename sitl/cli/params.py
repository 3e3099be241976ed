# SPDX-License-Identifier: BSD-3-Clause
"""``sitl params``: the firmware's parameters as a .parm file or a documentation page."""

from __future__ import annotations

import argparse

from .. import vehicles
from ..autopilot.params import docs, files, table
from ..core.records import record


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("params", help="list the parameters")
    parser.add_argument("--frame", metavar="NAME", help="with the values of this airframe")
    parser.add_argument("--markdown", action="store_true", help="as the documentation page")
    parser.set_defaults(function=params)


def params(options: argparse.Namespace) -> int:
    """Print every parameter."""
    if options.markdown:
        print(docs.page(), end="")
        return 0
    import numpy as np

    holder = np.zeros(1, record(("params", table.PARAMS_DTYPE))).view(np.recarray)[0].params
    table.set_defaults(holder)
    if options.frame:
        files.apply(holder, vehicles.load(options.frame).parameters, f"airframe {options.frame}")
    print(files.dump(holder), end="")
    return 0
