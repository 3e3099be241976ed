# SPDX-License-Identifier: BSD-3-Clause
"""Object files become a shared library, for any target on any machine, by the linker of the package ziglang.

What the library may call outside is said by stubs of the system's libraries, so that a forgotten function is an error
here and not at a user's.
"""

from __future__ import annotations

import importlib.util
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...errors import MissingExtra
from ..code_cache import BuildError
from .object_code import stub
from .target_machines import Target

SYSTEM = {"libm.so.6": ("fmod",), "libc.so.6": ("memcpy", "memmove", "memset", "memcmp", "bcmp")}
"""System library -> what machine code may call of it."""
_OPTIONS = (
    "-shared", "--build-id=none", "--hash-style=gnu", "-Bsymbolic", "--strip-all", "--no-as-needed",
    "-z", "defs", "-z", "now", "-z", "relro", "-z", "noexecstack",
)  # fmt: skip


def command(target: Target) -> list[str]:
    """The linker: that of ziglang; else LLVM's; else the system's own, which knows this machine only.

    Raises:
        MissingExtra: there is none for this target.
    """
    if importlib.util.find_spec("ziglang") is not None:
        return [sys.executable, "-m", "ziglang", "ld.lld"]
    for name in ("ld.lld", "ld"):
        found = shutil.which(name)
        if found is not None and (name != "ld" or target.wheel == platform.machine()):
            return [found]
    raise MissingExtra(f"linking the core for {target.name} needs a linker: pip install ziglang")


def link(objects: Sequence[Path], exported: Sequence[str], target: Target, file: Path) -> None:
    """Link object files into the shared library ``file``.

    Args:
        objects: the object files.
        exported: symbols that Python looks up.
        target: what they are made for.
        file: the library; written whole.

    Raises:
        BuildError: the linker refuses; the message says what is missing.
    """
    scratch = file.with_suffix(".link")
    scratch.mkdir(parents=True, exist_ok=True)
    script = scratch / "exported"
    names = "".join(f'"{name}"; ' for name in sorted(exported))
    script.write_text(f"{{ global: {names} local: *; }};\n")
    made = scratch / file.name
    stubs = _stubs(SYSTEM, target, scratch)
    _run([*_common(target, made, file.name), f"--version-script={script}", *map(str, objects), *map(str, stubs)])
    made.replace(file)
    shutil.rmtree(scratch)


def _stubs(system: Mapping[str, Sequence[str]], target: Target, folder: Path) -> list[Path]:
    """Libraries that have the names of the system's and nothing in them."""
    made = []
    for library, names in system.items():
        code, file = folder / f"{library}.o", folder / library
        code.write_bytes(stub(names, target))
        _run([*_common(target, file, library), str(code)])
        made.append(file)
    return made


def _common(target: Target, file: Path, name: str) -> list[str]:
    return [*command(target), "-m", target.emulation, *_OPTIONS, "-soname", name, "-o", str(file)]


def _run(line: Sequence[str]) -> None:
    done = subprocess.run(line, capture_output=True, text=True)
    if done.returncode != 0:
        raise BuildError(f"linking the core failed:\n{done.stderr[-4000:]}")
