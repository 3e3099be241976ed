# SPDX-License-Identifier: BSD-3-Clause
"""The folder of object files that libraries are linked from."""

from __future__ import annotations

import platform
from pathlib import Path
from typing import NamedTuple

from .target_machines import TARGETS, Target

_OLDEST = {"x86_64": "x86-64", "aarch64": "generic"}
ENVIRONMENT = {
    "NUMBA_CPU_NAME": _OLDEST.get(platform.machine(), "generic"),
    "NUMBA_CPU_FEATURES": "",
    "NUMBA_DISABLE_INTEL_SVML": "1",
    "NUMBA_OPT": "3",
    "PYTHONHASHSEED": "0",
}
"""Of processes that make object code: nothing of it depends on the machine that they run on."""


class Objects(NamedTuple):
    """Object files that are wanted, of units and kernels, for some targets.

    A file is named after the sources of what it holds, and the folder after the compilers, so that nothing stale is
    linked. Beside each is what it was made from, LLVM's optimised code (``.bc``), for those who look at it.
    """

    folder: Path
    targets: tuple[Target, ...]

    @classmethod
    def from_text(cls, text: str) -> Objects:
        """What ``str`` gave."""
        names, _, folder = text.partition(":")
        return cls(Path(folder), tuple(target for target in TARGETS if target.name in names.split(",")))

    def __str__(self) -> str:
        return f"{','.join(target.name for target in self.targets)}:{self.folder}"

    def file(self, symbol: str, identity: str, target: Target) -> Path:
        """Where the object code of one unit or kernel is or will be."""
        return self.folder / f"{symbol}-{identity}-{target.name}.o"

    def complete(self, symbol: str, identity: str) -> bool:
        """Whether there is all that is wanted of it."""
        return all(self.file(symbol, identity, target).exists() for target in self.targets)
