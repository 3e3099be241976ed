# SPDX-License-Identifier: BSD-3-Clause
"""The folder of machine code: where it is, how compiled functions get into it, who may build, what is deleted.

Each compiled function has a folder of its own, named after the fingerprint of all that it depends on
(``fingerprint.py``). The folder holds a source file with its entry, and Numba's cache of that file.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import platformdirs

from ..errors import SitlError
from .numba_tuning import quick

ENTRY = "sitl_unit_entry"
"""Name of the function in each source file."""
_SOURCE = "unit.py"
_BUILT = "built"
_KEEP_VERSIONS = 16


class BuildError(SitlError, RuntimeError):
    """A function of the core could not be compiled, or its machine code not be kept."""


def cache_folder() -> Path:
    """Folder of the compiled units: ``$SITL_CACHE_DIR``, else the user's cache folder."""
    return Path(os.environ.get("SITL_CACHE_DIR") or platformdirs.user_cache_dir("gym-sitl"))


def clear_cache() -> int:
    """Delete every compiled unit; returns how many were there."""
    folders = [p for p in cache_folder().glob("*") if (p / _SOURCE).exists()]
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)
    return len(folders)


def is_built(folder: Path) -> bool:
    """Whether ``folder`` holds machine code."""
    return (folder / _BUILT).exists()


def load_entry(
    folder: Path, module_name: str, source: str, names: Mapping[str, Any], compile_entry: Callable[[Any], Any]
) -> Any:
    """Compile the function ``ENTRY`` of ``source`` into ``folder``, or load what was compiled there before.

    Args:
        folder: named after the fingerprint of what is compiled.
        module_name: under which Numba finds the entry's module; one for each entry.
        source: text of the module: it defines ``ENTRY``.
        names: what the source refers to.
        compile_entry: Numba's decorator, with its cache switched on.

    Returns:
        What ``compile_entry`` returns.

    Raises:
        BuildError: the folder cannot be written.
    """
    import numba

    file = folder / _SOURCE
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not file.exists():
            temporary = folder / f"unit.{os.getpid()}"
            temporary.write_text(source)
            os.utime(temporary, (0, 0))
            os.replace(temporary, file)
    except OSError as error:
        raise cannot_write(folder, error) from None
    module = ModuleType(module_name)  # in sys.modules, because Numba's cache looks the entry's module up by name
    sys.modules[module_name] = module
    vars(module).update(names)
    exec(compile(file.read_text(), str(file), "exec"), vars(module))
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(folder)
    try:
        with quick(ENTRY):
            try:
                function = compile_entry(vars(module)[ENTRY])
            except Exception:
                if not _forget(folder):
                    raise
                function = compile_entry(vars(module)[ENTRY])
    finally:
        numba.config.CACHE_DIR = before
    (folder / _BUILT).touch()
    return function


def _forget(folder: Path) -> bool:
    """Delete what Numba has noted of machine code in ``folder``; whether there was any.

    Numba keeps types of arguments as pickles, which name the modules of their classes: a version that has moved a
    class cannot read them, although the code is the same. A file that is damaged cannot be read, either.
    """
    noted = list(folder.rglob("*.nbi"))
    for file in noted:
        file.unlink(missing_ok=True)
    return bool(noted)


def cannot_write(folder: Path, error: OSError) -> BuildError:
    """The error of a cache folder that cannot be written."""
    return BuildError(f"{folder}: {error.strerror}. Set SITL_CACHE_DIR to a folder that can be written")


@contextlib.contextmanager
def build_lock() -> Iterator[None]:
    """One building process at a time; the others wait and then find the units built."""
    folder = cache_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = open(folder / "lock", "w")  # noqa: SIM115 (closed by the "with" below)
    except OSError as error:
        raise cannot_write(folder, error) from None
    with handle:
        try:
            import fcntl
        except ImportError:  # Windows: two builders repeat work but do not harm each other
            yield
            return
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def drop_old_versions() -> None:
    """Keep the newest few builds of each unit (switching branches back and forth stays warm)."""
    by_unit: dict[str, list[Path]] = {}
    for folder in cache_folder().glob("*"):
        if is_built(folder):
            by_unit.setdefault(folder.name.rsplit("-", 1)[0], []).append(folder)
    for folders in by_unit.values():
        folders.sort(key=lambda f: (f / _BUILT).stat().st_mtime, reverse=True)
        for folder in folders[_KEEP_VERSIONS:]:
            shutil.rmtree(folder, ignore_errors=True)
