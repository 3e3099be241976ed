# SPDX-License-Identifier: BSD-3-Clause
"""Free ports of this machine, for programs whose ports must be given."""

from __future__ import annotations

import contextlib
import socket

from ..errors import OptionError

HOST = "127.0.0.1"


def free_tcp_run(length: int) -> int:
    """The first of ``length`` TCP ports in a row that nobody listens on.

    Raises:
        OptionError: none are to be had.
    """
    for _ in range(64):
        with contextlib.ExitStack() as stack:
            first = 0
            try:
                for k in range(length):
                    probe = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_STREAM))
                    probe.bind((HOST, first + k if first else 0))
                    first = first or probe.getsockname()[1]
            except (OSError, OverflowError):
                continue
            return first
    raise OptionError(f"there are no {length} free TCP ports in a row on this machine")
