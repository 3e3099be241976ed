# SPDX-License-Identifier: BSD-3-Clause
"""``python -m sitl.core.worker MODULE RECORD UNIT``: compile one unit (started by ``compile.build``)."""

from __future__ import annotations

import importlib
import sys


def main() -> int:
    """Compile the unit named on the command line."""
    import llvmlite.binding

    from .compile import load_unit, symbol
    from .kernels import UNITS

    module, path, name = sys.argv[1:4]
    importlib.import_module(module)  # registers its units
    for unit in UNITS.values():
        if unit.name != name:  # never called here: any address lets the linker finish
            llvmlite.binding.add_symbol(symbol(unit, path), 1)
    load_unit(UNITS[name], path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
