# SPDX-License-Identifier: BSD-3-Clause
"""Builds and loads the units of the compiled core.

Each unit is compiled by Numba into a folder named after its fingerprint (``fingerprint.py``), so a stale unit cannot be
loaded: its folder would have another name. Missing units are built by worker processes side by side. A warm start finds
all folders and only loads machine code.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import os
import platform
import queue
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np

from .build_work import BuildWork, ProgressLines
from .code_cache import ENTRY, BuildError, build_lock, cache_folder, drop_old_versions, is_built, load_entry
from .fingerprint import Reached, borders, fingerprint, reached
from .kernels import INLINED, LAWS, UNITS, Unit, jit_disabled
from .numba_tuning import TRUST, law_options, trust_laws
from .order import Order
from .records import Record
from .shipped import library as shipped
from .shipped.identity import identity
from .shipped.objects import ENVIRONMENT as OBJECT_ENVIRONMENT

Progress = Callable[[str, float, float], None]
"""Called as ``progress(unit name, work done, work of all)``, several times a second, in estimated seconds of work."""
_REPORT_S = 0.2
"""Progress is reported at least so often [s]."""
_SHOWN = 3000
"""Characters of each end of a long text."""
_WHY = "Rejected as the implementation raised a specific error:\n"
"""In Numba's message, once for each law; the last one is before the reason."""
_START_S, _BYTES_A_SECOND = 1.0, 5000.0
"""From measured units: what each takes, and how fast source is compiled."""

_fingerprints: dict[tuple[str, str], str] = {}
"""(Unit name, path of the record type) -> fingerprint: code does not change while a process runs."""
_identities: dict[tuple[str, str], str] = {}
ENTRY_OPTIONS = {"error_model": "numpy", "forceinline": True}
"""Of a unit's entry: its body is compiled into the function with the C signature."""
_SYMBOLS = "symbols name records by their classes alone"
"""Machine code made with symbols of another kind cannot be loaded beside it."""
_jitable: set[int] = set()
_linked: set[str] = set()
_records: dict[Any, str] = {}
"""Numba's record type -> its path."""
_loaded: dict[tuple[str, str], Any] = {}
"""(Unit name, path of the record type) -> the C function."""
_compiled: dict[tuple[str, str], Any] = {}
"""The same -> Numba's function, of those that were not shipped: it holds the machine code."""
_addresses: dict[str, int] = {}
"""Symbol -> address of shipped code that Numba's linker does not know yet."""


def toolchain() -> str:
    """Versions, options and processor that machine code depends on.

    The processor belongs to it: Numba compiles for the one at hand and does not load what was made for another, so that
    a cache folder carried between machines would be compiled anew at every change of machine, without a word.
    """
    import llvmlite.binding
    import numba

    versions = (numba.__version__, llvmlite.__version__, np.__version__, platform.python_version())
    processor = numba.config.CPU_NAME or llvmlite.binding.get_host_cpu_name()
    features = numba.config.CPU_FEATURES
    if features is None:
        features = llvmlite.binding.get_host_cpu_features().flatten()
    options = f"{law_options()!r} {ENTRY_OPTIONS!r}"
    return " ".join((*versions, platform.machine(), processor, features, options, _SYMBOLS))


def record_class(path: str) -> type[Record]:
    """The record class at ``package.module.NAME``."""
    module, name = path.rsplit(".", 1)
    found: type[Record] = getattr(importlib.import_module(module), name)
    return found


def symbol(unit: Unit, path: str) -> str:
    """Name under which other units link to this one, compiled for the record type at ``path``."""
    return f"{unit.symbol}__{path.rsplit('.', 1)[1].lower()}"


def unit_folder(unit: Unit, path: str) -> Path:
    """Where the unit's current machine code for the record type at ``path`` is or will be."""
    key = (unit.name, path)
    if key not in _fingerprints:
        made_by = f"{toolchain()} {TRUST} {path} {unit.inline}"
        _fingerprints[key] = fingerprint(unit, (record_class(path),), made_by)
    return cache_folder() / f"{unit.name}-{path.rsplit('.', 1)[1].lower()}-{_fingerprints[key]}"


def unit_identity(unit: Unit, path: str) -> str:
    """Hash of the sources of the unit for the record type at ``path``; the same on every machine."""
    key = (unit.name, path)
    if key not in _identities:
        _identities[key] = identity(unit, f"{path} {unit.inline}", (record_class(path),))
    return _identities[key]


def is_shipped(unit: Unit, path: str) -> bool:
    """Whether the machine code of the unit's present source came with the package."""
    return shipped.is_shipped(shipped.unit_key(unit.name, path), lambda: unit_identity(unit, path))


def missing(entry: Callable[..., Any], path: str) -> list[Unit]:
    """Units of the core of ``entry`` that have no machine code for their present source."""
    return [u for u in reached(entry) if not is_shipped(u, path) and not is_built(unit_folder(u, path))]


def make_jitable(inline: bool = False) -> None:
    """Let Numba compile laws into their callers (the functions themselves stay plain Python).

    Args:
        inline: no law stays a call. What is compiled in one process is compiled in one way: each unit has a worker of
            its own.
    """
    from numba.extending import register_jitable

    from . import numba_constant_tables, numba_float_bits, numba_system_call  # noqa: F401  known when imported

    numba_constant_tables.make_known()

    for function in LAWS:
        if id(function) not in _jitable:
            _jitable.add(id(function))
            register_jitable(**law_options(inline or function in INLINED))(function)
    for unit in UNITS.values():
        if unit.name not in _linked:
            _linked.add(unit.name)
            _link(unit)


def _link(unit: Unit) -> None:
    """Make a call of the unit's function, inside another unit, a call of its C symbol for the caller's record type."""
    from numba import types
    from numba.extending import overload

    integers = [types.int64] * unit.integers

    def external(fleet: Any) -> Any:
        name = symbol(unit, _records[fleet.dtype])
        return types.ExternalFunction(name, types.void(types.uintp, types.int64, types.int64, *integers))

    # Numba compares the parameters of both functions, so they are written out for this number of integers.
    more = "".join(f", n{k}" for k in range(unit.integers))
    space: dict[str, Any] = {"external": external}
    exec(
        f"def called(fleet, index{more}):\n"
        f"    call = external(fleet)\n"
        f"    return lambda fleet, index{more}: call(fleet.ctypes.data, len(fleet), index{more})\n",
        space,
    )
    overload(unit.function, target="cpu")(space["called"])  # for other targets a unit has no symbol


def _body(unit: Unit) -> Any:
    """The unit's function under a second identity: the first one is a call of its symbol (``_link``)."""
    from numba.extending import register_jitable

    original = unit.function
    copy = FunctionType(original.__code__, original.__globals__, original.__name__ + "_body")
    return register_jitable(**law_options(True))(copy)


def _wrapper_source(unit: Unit) -> str:
    integers = "".join(f", n{k}" for k in range(unit.integers))
    return (
        f"# The C entry of unit {unit.name}.\n"
        f"def {ENTRY}(vehicles, count, index{integers}):\n"
        f"    body(carray(vehicles, count), index{integers})\n"
    )


def entry_of(unit: Unit, path: str) -> tuple[str, dict[str, Any], Any]:
    """The C entry of a unit for the record type at ``path``: its source, what that refers to, and Numba's signature."""
    import numba
    from numba import types

    make_jitable(unit.inline)
    from .numba_records import numba_type

    record = numba_type(record_class(path))
    if _records.setdefault(record, path) != path:
        raise BuildError(f"{path} and {_records[record]} are the same record type; one of them will do")
    signature = types.void(types.CPointer(record), types.int64, types.int64, *[types.int64] * unit.integers)
    return _wrapper_source(unit), {"carray": numba.carray, "body": _body(unit)}, signature


def load_unit(unit: Unit, path: str) -> Any:
    """The unit for the record type at ``path`` as a C function: shipped code, or from the cache, or compiled now.

    Units that are compiled later can call it by its symbol.
    """
    key = (unit.name, path)
    if key not in _loaded:
        _loaded[key] = _load_shipped(unit, path) if is_shipped(unit, path) else _load_compiled(unit, path)
    return _loaded[key]


def _load_shipped(unit: Unit, path: str) -> Any:
    library, name = shipped.library(), symbol(unit, path)
    assert library is not None
    function = library.function(name, [ctypes.c_void_p, *[ctypes.c_int64] * (2 + unit.integers)])
    _addresses[name] = ctypes.cast(function, ctypes.c_void_p).value or 0
    return function


def _load_compiled(unit: Unit, path: str) -> Any:
    import llvmlite.binding
    import numba

    source, names, signature = entry_of(unit, path)
    folder, name = unit_folder(unit, path), symbol(unit, path)
    while _addresses:
        llvmlite.binding.add_symbol(*_addresses.popitem())
    compile_entry = numba.cfunc(signature, cache=True, **ENTRY_OPTIONS)
    with trust_laws():
        function = load_entry(folder, name, source, names, compile_entry)
    llvmlite.binding.add_symbol(name, function.address)
    shipped.redirect(shipped.unit_key(unit.name, path), name, function.address)
    _compiled[unit.name, path] = function
    return function.ctypes


def build(entries: Iterable[Callable[..., Any]], path: str, progress: Progress | None = None, jobs: int = 0) -> float:
    """Compile what ``entries``, for the record type at ``path``, miss in the cache, side by side; returns the seconds.

    Raises:
        BuildError: a unit failed to compile; the message holds Numba's own.
    """
    start = time.monotonic()
    with build_lock():
        entry_for = {unit: entry for entry in entries for unit in missing(entry, path)}
        compile_tasks(
            {f"{entry_for[unit].__module__}:{unit.name}": unit for unit in entry_for}, Order(path), progress, jobs
        )
    return time.monotonic() - start


def compile_tasks(tasks: Mapping[str, Unit], order: Order, progress: Progress | None = None, jobs: int = 0) -> None:
    """Compile what worker processes know as ``tasks``, side by side, while the caller holds the lock of the cache.

    Args:
        tasks: "MODULE:NAME" -> what is compiled.
        order: what workers make of it.
        progress: called with it; None: lines on standard error.
        jobs: processes; 0: one for each processor.

    Raises:
        BuildError: one failed to compile.
    """
    if not tasks:
        return
    weights = {task: _weight(unit) for task, unit in tasks.items()}
    work = BuildWork({task.partition(":")[2]: weight for task, weight in weights.items()})
    longest_first = sorted(tasks, key=lambda task: -weights[task])
    with _workers(order, jobs or min(len(tasks), os.cpu_count() or 1), longest_first) as process:
        _follow(process, work, progress or ProgressLines())
    drop_old_versions()


def _follow(process: subprocess.Popen[str], work: BuildWork, progress: Progress) -> None:
    """Report the progress of workers until all units are compiled.

    Raises:
        BuildError: one failed.
    """
    assert process.stdout is not None and process.stderr is not None
    steps: queue.SimpleQueue[str] = queue.SimpleQueue()
    said: list[str] = []

    def listen(lines: Iterable[str], take: Callable[[str], object]) -> threading.Thread:
        thread = threading.Thread(target=lambda: [take(line) for line in lines], daemon=True)
        thread.start()
        return thread

    listeners = [listen(process.stdout, steps.put), listen(process.stderr, said.append)]
    failed, name = "", ""
    while any(thread.is_alive() for thread in listeners) or not steps.empty():
        try:
            step, _, name = steps.get(timeout=_REPORT_S).strip().partition(" ")
        except queue.Empty:
            step = ""
        now = time.monotonic()
        if step == "begin":
            work.begin(name, now)
        elif step == "end":
            work.end(name, now)
        elif step == "fail":
            failed = name
        if name:
            progress(name, work.done(now), work.total)
    if process.wait() != 0:
        what = f"unit {failed}" if failed else "the core"
        raise BuildError(f"compiling {what} failed:\n{_reason(''.join(said))}")


def _reason(said: str) -> str:
    """What a worker said, from where Numba says why: laws by which it got there come before it, and again behind it."""
    text = textwrap.dedent(said.rpartition(_WHY)[2]).strip()
    return text if len(text) <= 2 * _SHOWN else f"{text[:_SHOWN]}\n...\n{text[-_SHOWN:]}"


def _weight(unit: Unit) -> float:
    """A guess at the time that it takes to compile [s], from the source that it reaches."""
    lines = Reached(unit.function, borders(unit)).lines
    return _START_S + sum(len(line) for line in lines) / _BYTES_A_SECOND


@contextlib.contextmanager
def _workers(order: Order, jobs: int, tasks: Sequence[str]) -> Iterator[subprocess.Popen[str]]:
    """The process that compiles, ended with all that it has started when the context ends."""
    command = [sys.executable, "-m", "sitl.core.worker", *order.arguments(), str(jobs), *tasks]
    root = str(Path(__file__).resolve().parents[2])
    found = os.pathsep.join(p for p in (root, *sys.path) if p)  # modes of other packages are found, too
    environment = {**os.environ, "PYTHONPATH": found, "OPENBLAS_NUM_THREADS": "1"}
    if order.objects is not None:
        environment |= OBJECT_ENVIRONMENT
    process = subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    try:
        yield process
    finally:  # a failure or Ctrl-C leaves no compiler behind
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _is_loaded(entry: Callable[..., Any], path: str) -> bool:
    """Whether this process has all units of the core of ``entry``: nothing is looked for on disk then."""
    return all((unit.name, path) in _loaded for unit in reached(entry))


def build_missing(entries: Sequence[Callable[..., Any]], path: str, progress: Progress | None = None) -> None:
    """The same, if anything is missing that this process has not loaded; nothing with Numba's JIT disabled."""
    if not jit_disabled() and any(missing(entry, path) for entry in entries if not _is_loaded(entry, path)):
        build(entries, path, progress)


def load(entry: Callable[..., Any], path: str, progress: Progress | None = None) -> Any:
    """The compiled form of unit ``entry`` as a C function ``(address, count, index, *integers)``.

    Builds what is missing. With Numba's JIT disabled, returns None: call ``entry`` itself.

    Args:
        entry: a unit.
        path: of the record type of the fleets that it is for, ``package.module.NAME``.
        progress: called for each unit that is compiled.
    """
    if jit_disabled():
        return None
    build_missing((entry,), path, progress)
    units = reached(entry)  # callees before callers, so that symbols exist when needed
    for unit in units:
        load_unit(unit, path)
    return _loaded[units[-1].name, path]
