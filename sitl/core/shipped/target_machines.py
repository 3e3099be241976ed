# SPDX-License-Identifier: BSD-3-Clause
"""The machines that the core is shipped for, and which of them this one is."""

from __future__ import annotations

import platform
import sys
from functools import cache
from pathlib import Path
from typing import NamedTuple


class Target(NamedTuple):
    """A machine that code is made for."""

    name: str
    triple: str
    """LLVM's name of architecture, system and C library."""
    cpu: str
    """LLVM's name of the processor: the oldest that runs the code."""
    emulation: str
    """The linker's name of the architecture."""
    wheel: str
    """Architecture in the name of a wheel."""
    flags: frozenset[str] = frozenset()
    """What Linux must say of the processor (/proc/cpuinfo)."""

    @property
    def file(self) -> str:
        """Name of the library."""
        return f"core-{self.name}.so"


TARGETS = (
    Target(
        "x86_64_v3", "x86_64-unknown-linux-gnu", "x86-64-v3", "elf_x86_64", "x86_64",
        frozenset(("avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "abm", "movbe", "xsave")),
    ),
    Target("x86_64", "x86_64-unknown-linux-gnu", "x86-64", "elf_x86_64", "x86_64"),
    Target("aarch64", "aarch64-unknown-linux-gnu", "generic", "aarch64linux", "aarch64"),
)  # fmt: skip
"""Of those that run on a machine, the first is the fastest. Flights are the same on all, to the last bit."""


@cache
def usable() -> tuple[Target, ...]:
    """The targets whose code this machine runs, the fastest first."""
    if sys.platform != "linux":
        return ()
    machine = platform.machine()
    flags = _processor_flags() if machine == "x86_64" else frozenset()
    return tuple(target for target in TARGETS if target.wheel == machine and target.flags <= flags)


def _processor_flags() -> frozenset[str]:
    try:
        for line in Path("/proc/cpuinfo").read_text(errors="replace").splitlines():
            name, _, value = line.partition(":")
            if name.strip() == "flags":
                return frozenset(value.split())
    except OSError:
        pass
    return frozenset()
