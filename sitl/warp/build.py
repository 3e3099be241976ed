# SPDX-License-Identifier: BSD-3-Clause
"""Compiles the preload library (``preload/*.c``), the runtime for static programs (``static/*.c``) and the library that
holds a program's clock (``lockstep/*.c``) on the user's machine, once, into a cache folder.

The name of the result holds a hash of the sources, the compiler and the machine, so a changed source is
compiled again and two versions never meet. Compilers tried in this order: ``$CC``, ``cc``, ``gcc``,
``clang``, then the one in the PyPI package ``ziglang`` (a C compiler that pip can install where the system
has none).
"""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ..errors import SitlError

HERE = Path(__file__).parent


class CannotBuild(SitlError, RuntimeError):
    """The library or the runtime cannot be made here; the message says what to install or change."""


def cache_folder() -> Path:
    """Where compiled libraries are kept: ``$SITL_CACHE_DIR``, else ``$XDG_CACHE_HOME/gym-sitl``, else
    ~/.cache/gym-sitl.
    """
    if chosen := os.environ.get("SITL_CACHE_DIR"):
        return Path(chosen) / "warp"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "gym-sitl" / "warp"


A_SCRIPT = "a script in simulated time", "gym-sitl[exec]", ", or run it in real time (sitl exec --speedup 1)"
A_PROGRAM = "a program whose clock is held", "ziglang", ""
"""Who needs a C compiler, the package that brings one, and what goes without."""


def compiler(purpose: tuple[str, str, str] = A_SCRIPT) -> list[str]:
    """The command that compiles C here, as the first words of a command line; raises CannotBuild if
    there is none.
    """
    if named := os.environ.get("CC"):
        return shlex.split(named)
    for name in ("cc", "gcc", "clang"):
        if path := shutil.which(name):
            return [path]
    if importlib.util.find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc"]
    who, package, otherwise = purpose
    raise CannotBuild(
        f"{who} needs a C compiler, and there is none of $CC, cc, gcc, clang. Install one "
        f"(Debian: apt install gcc; anywhere: pip install '{package}'){otherwise}."
    )


@functools.cache
def preload_library() -> Path:
    """The compiled preload library for this machine; compiles it if it is not in the cache. Raises
    CannotBuild.
    """
    if sys.platform != "linux":
        raise CannotBuild(
            f"a script's clock follows simulated time on Linux alone, and this is {sys.platform}. In real time "
            "(sitl exec --speedup 1) it runs here; faster on Linux, in a container, too."
        )
    return _preloaded("libsitlclock.so", "preload")


@functools.cache
def lockstep_library() -> Path:
    """The compiled library that holds the clock of a program (``held_clock``); compiles it if it is not in the cache.
    Raises CannotBuild.
    """
    if sys.platform != "linux":
        raise CannotBuild(
            f"the clock of a program is held on Linux alone, and this is {sys.platform}. A container with Linux does."
        )
    return _preloaded("libsitllockstep.so", "lockstep", A_PROGRAM)


def _preloaded(name: str, folder: str, purpose: tuple[str, str, str] = A_SCRIPT) -> Path:
    """A library that the system's loader loads into programs."""
    cache = cache_folder()
    if any(character in str(cache) for character in " :"):
        raise CannotBuild(
            f"the cache folder {str(cache)!r} has a space or a colon in its name, which the system's loader "
            "(LD_PRELOAD) cannot take. Set SITL_CACHE_DIR to a folder without."
        )
    return _cached(name, folder, ["-fPIC"], ["-shared", "-ldl", "-pthread"], purpose)


@functools.cache
def static_runtime() -> Path:
    """The compiled program that starts static programs on the clock; raises CannotBuild.

    Needs Linux on x86-64 or aarch64.
    """
    flags = [
        "-ffreestanding",
        "-fno-builtin",
        "-fno-stack-protector",
        "-fno-asynchronous-unwind-tables",
        "-fPIE",
    ]
    if platform.machine() == "aarch64":
        flags.append("-mno-outline-atomics")  # those are in a library that this program does without
    return _cached("sitl-static-runtime", "static", flags, ["-fPIE", "-pie", "-nostdlib", "-Wl,--no-dynamic-linker"])


def _cached(
    name: str, folder: str, compile_flags: list[str], link_flags: list[str], purpose: tuple[str, str, str] = A_SCRIPT
) -> Path:
    command = compiler(purpose)
    sources = sorted((HERE / folder).glob("*.c"))
    compile_flags = ["-std=gnu11", "-O2", "-fno-strict-aliasing", *compile_flags]
    machine = (command, compile_flags, link_flags, platform.machine(), platform.libc_ver())
    digest = hashlib.sha256(repr(machine).encode())
    for source in [*sources, *sorted(HERE.glob("*/*.h"))]:
        digest.update(source.read_bytes())
    target = cache_folder() / digest.hexdigest()[:16] / name
    if target.exists():
        return target
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=target.parent) as drafts:
            objects = [str(Path(drafts, source.stem + ".o")) for source in sources]
            for source, made in zip(sources, objects, strict=True):
                _compile([*command, *compile_flags, "-c", "-o", made, str(source)])
            draft = Path(drafts, name)
            _compile([*command, "-o", str(draft), *objects, *link_flags])
            os.replace(draft, target)  # two runs at once both end with a whole file
    except OSError as error:
        raise CannotBuild(
            f"cannot write {target}: {error}. Set SITL_CACHE_DIR to a folder that can be written."
        ) from error
    return target


def _compile(words: list[str]) -> None:
    try:
        done = subprocess.run(words, capture_output=True, text=True)
    except OSError as error:
        raise CannotBuild(f"cannot run the C compiler {words[0]}: {error}. Set CC to one that works.") from error
    if done.returncode:
        raise CannotBuild(f"the C compiler failed: {shlex.join(words)}\n{done.stderr.strip()}")
