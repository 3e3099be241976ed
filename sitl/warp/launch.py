# SPDX-License-Identifier: BSD-3-Clause
"""Starts a script, with everything it starts itself, on the clock of a page."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from typing import Any

from sitl.warp.build import CannotBuild, preload_library, static_runtime
from sitl.warp.page import ClockPage

FORWARDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def script_environment(page: ClockPage, env: Mapping[str, str] | None = None) -> dict[str, str]:
    """The environment that puts a program on the clock of `page`: `env` (this process's own by default) and
    a few more.

    Raises CannotBuild if the preload library cannot be made on this machine. The first call compiles, some
    seconds.
    """
    result = dict(os.environ if env is None else env)
    others = [name for name in result.get("LD_PRELOAD", "").split(":") if name]
    result["LD_PRELOAD"] = ":".join([str(preload_library()), *others])
    result["SITL_WARP_PAGE"] = page.path
    # Only gRPC generations of MAVSDK need it; other processors than it is written for do without.
    with contextlib.suppress(CannotBuild):
        result["SITL_WARP_RUNTIME"] = str(static_runtime())
    return result


def start_script(
    argv: Sequence[str], page: ClockPage, env: Mapping[str, str] | None = None, **options: Any
) -> subprocess.Popen:
    """Start `argv` on the clock of `page` and return at once; `options` go to subprocess.Popen."""
    return subprocess.Popen(list(argv), env=script_environment(page, env), **options)


def run_script(argv: Sequence[str], page: ClockPage, env: Mapping[str, str] | None = None) -> int:
    """Run `argv` on the clock of `page` to its end and return its exit code; 128 + n if signal n ended it.

    The caller's simulator must go on publishing meanwhile, from another thread. Called in the main thread,
    this leaves it to the script what to do about SIGINT, SIGTERM and SIGHUP: it forwards them.
    """
    child = start_script(argv, page, env)

    def forward(number: int, _frame: object) -> None:
        # A terminal sends its Ctrl-C to the whole group, so the script has that one already.
        if child.poll() is None and not (number == signal.SIGINT and sys.stdin and sys.stdin.isatty()):
            child.send_signal(number)

    previous = {}
    if threading.current_thread() is threading.main_thread():
        previous = {number: signal.signal(number, forward) for number in FORWARDED}
    try:
        code = child.wait()
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)
        if child.poll() is None:
            child.kill()
            child.wait()
    return code if code >= 0 else 128 - code
