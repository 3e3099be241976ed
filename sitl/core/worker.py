# SPDX-License-Identifier: BSD-3-Clause
"""``python -m sitl.core.worker MODULES DTYPE_PATH UNIT``: compile one unit (started by ``compile.build``)."""

from __future__ import annotations

import importlib
import sys


def main() -> int:
    """Compile the unit named on the command line."""
    import llvmlite.binding

    from .compile import load_unit
    from .kernels import UNITS

    modules, dtype_path, name = sys.argv[1:4]
    for module in modules.split(","):
        importlib.import_module(module)  # registers its units
    for unit in UNITS.values():
        if unit.name != name:  # never called here: any address lets the linker finish
            llvmlite.binding.add_symbol(unit.symbol, 1)
    load_unit(UNITS[name], dtype_path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
