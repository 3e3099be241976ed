# SPDX-License-Identifier: BSD-3-Clause
"""Ports for processes that a test starts, where a test cannot say 0 and read which one it became.

A port that the kernel chose, and that was closed again, may be given to the next that asks: another test's. So these
are below the ones that kernels choose, each process of pytest has a share of its own, and none comes twice in a row.
"""

from __future__ import annotations

import itertools
import os
import socket
from collections.abc import Sequence
from contextlib import ExitStack, suppress

LOCAL = "127.0.0.1"
FIRST, SHARE, SHARES = 20_000, 1_000, 12
"""Ports of a worker of pytest; kernels begin at 32768 (Linux) or 49152 (macOS)."""
WORKER = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")) % SHARES
_next = itertools.count(os.getpid() * 37)  # two runs on one machine begin apart
BOTH = (socket.SOCK_STREAM, socket.SOCK_DGRAM)


def _is_free(port: int, kinds: Sequence[int]) -> bool:
    with ExitStack() as stack, suppress(OSError):
        for kind in kinds:
            stack.enter_context(socket.socket(socket.AF_INET, kind)).bind((LOCAL, port))
        return True
    return False


def free_port(*more: int, kinds: Sequence[int] = BOTH) -> int:
    """A port that is free by TCP and UDP, as are those ``more`` above it."""
    for number in itertools.islice(_next, SHARE):
        port = FIRST + SHARE * WORKER + number % (SHARE - max(more, default=0))
        if all(_is_free(port + step, kinds) for step in (0, *more)):
            return port
    raise AssertionError(f"none of {SHARE} ports is free")
