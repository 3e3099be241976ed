# SPDX-License-Identifier: BSD-3-Clause
"""Starts a script, with everything it starts itself, on the clock of a page."""

from __future__ import annotations

import contextlib
import os
import subprocess
from collections.abc import Mapping, Sequence
from typing import Any

from sitl.warp.build import CannotBuild, preload_library, static_runtime
from sitl.warp.page import CLOCK_PAGE, ClockPage


def script_environment(page: ClockPage, env: Mapping[str, str] | None = None) -> dict[str, str]:
    """The environment that puts a program on the clock of `page`: `env` (this process's own by default) and
    a few more.

    Raises CannotBuild if the preload library cannot be made on this machine. The first call compiles, some
    seconds.
    """
    result = dict(os.environ if env is None else env)
    others = [name for name in result.get("LD_PRELOAD", "").split(":") if name]
    result["LD_PRELOAD"] = ":".join([str(preload_library()), *others])
    result[CLOCK_PAGE] = page.path
    # Only gRPC generations of MAVSDK need it; other processors than it is written for do without.
    with contextlib.suppress(CannotBuild):
        result["SITL_WARP_RUNTIME"] = str(static_runtime())
    return result


def start_script(
    argv: Sequence[str],
    page: ClockPage,
    env: Mapping[str, str] | None = None,
    ends_with_us: bool = False,
    **options: Any,
) -> subprocess.Popen:
    """Start `argv` on the clock of `page` and return at once; `options` go to subprocess.Popen.

    With `ends_with_us` it gets SIGTERM when the thread that calls this ends, also by SIGKILL.
    """
    environment = script_environment(page, env)
    if ends_with_us:
        environment["SITL_WARP_PARENT"] = str(os.getpid())
    return subprocess.Popen(list(argv), env=environment, **options)
