# SPDX-License-Identifier: BSD-3-Clause
"""``python -m sitl.core.worker [--objects=TARGETS:FOLDER] RECORD JOBS MODULE:UNIT ...``: compile units side by side
(started by ``compile_tasks``), for this machine into the cache, or for other machines as object files.

The units' modules and Numba are loaded once; each unit is compiled by a copy of this process, because what is compiled
in one process is compiled in one way. Laws that many units contain are compiled once as well (``shared_laws.py``), when
the copies for units that inline everything have been made. With ``kernels`` for RECORD, they are kernels on arrays
(``array_kernels.py``).
One line on standard output for each step: "begin UNIT", "end UNIT" or "fail UNIT". Where a process cannot be copied,
each unit has a process of its own.
"""

from __future__ import annotations

import gc
import importlib
import os
import sys
import traceback
import warnings
from collections.abc import Callable, Sequence

from .kernels import UNITS
from .order import KERNELS_PATH, Order
from .shared_laws import ENOUGH, compile_once

FORKS = sys.platform == "linux"
"""Copies of a process that has loaded Numba work there."""


def compile_one(order: Order, name: str) -> None:
    """Compile a unit, or a kernel, whose module is loaded."""
    path = order.path
    if order.objects is not None:
        from .shipped.object_code import write

        write(path, name, order.objects)
        return
    if path == KERNELS_PATH:
        from .array_kernels import KERNELS

        KERNELS[name].function()
        return
    import llvmlite.binding

    from .compile import load_unit, symbol

    for unit in UNITS.values():
        if unit.name != name:  # never called here: any address lets the linker finish
            llvmlite.binding.add_symbol(symbol(unit, path), 1)
    load_unit(UNITS[name], path)


def complain(error: BaseException) -> None:
    """Say what went wrong: of a law that Numba cannot type, what and where it is, not the way through Numba."""
    from numba.core.errors import NumbaError

    if isinstance(error, NumbaError):
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
    else:
        traceback.print_exception(error)


def fork(order: Order, name: str) -> int:
    """Start a copy of this process that compiles a unit, and return its id."""
    with warnings.catch_warnings():  # libraries have threads that wait, and hold no lock
        warnings.simplefilter("ignore", DeprecationWarning)
        pid = os.fork()
    if pid:
        return pid
    code = 1
    try:
        compile_one(order, name)
        code = 0
    except BaseException as error:
        complain(error)
    finally:
        sys.stderr.flush()
        os._exit(code)


def spawn(order: Order, task: str) -> int:
    """Start a process of its own for a unit, and return its id."""
    command = [sys.executable, "-m", "sitl.core.worker", *order.arguments(), "0", task]
    return os.posix_spawn(sys.executable, command, os.environ)  # Popen would wait for those that nobody holds


def compile_all(order: Order, jobs: int, tasks: Sequence[str]) -> int:
    """Compile them side by side, in this order; returns 1 after the first that fails."""
    start: Callable[[str], int]
    early: list[str] = []
    if FORKS:
        import numba.core.registry

        for task in tasks:
            importlib.import_module(task.partition(":")[0])
        numba.core.registry.cpu_target.target_context.refresh()
        gc.freeze()  # a tenth of the time, else, goes into looking for garbage among all that was loaded here
        start = lambda task: fork(order, task.partition(":")[2])  # noqa: E731
        if order.path != KERNELS_PATH:
            early = [task for task in tasks if UNITS[task.partition(":")[2]].inline]
    else:
        start = lambda task: spawn(order, task)  # noqa: E731
    waiting, running = [*early, *(task for task in tasks if task not in early)], dict[int, str]()
    shares = FORKS and len(tasks) - len(early) >= ENOUGH
    while waiting or running:
        while waiting and len(running) < jobs:
            if shares and waiting[0] not in early:
                compile_once()
                shares = False
            task = waiting.pop(0)
            print("begin", task.partition(":")[2], flush=True)
            running[start(task)] = task.partition(":")[2]
        pid, status = os.wait()
        name = running.pop(pid)
        print("fail" if status else "end", name, flush=True)
        if status:
            return 1
    return 0


def main() -> int:
    """Compile the units of the command line."""
    order, (jobs, *tasks) = Order.taken(sys.argv[1:])
    if jobs == "0":
        module, _, name = tasks[0].partition(":")
        importlib.import_module(module)
        try:
            compile_one(order, name)
        except Exception as error:
            complain(error)
            return 1
        return 0
    return compile_all(order, int(jobs), tasks)


if __name__ == "__main__":
    sys.exit(main())
