# SPDX-License-Identifier: BSD-3-Clause
"""Our executables in processes of their own, on free ports, as a launch script starts ArduPilot's."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]


class Running(NamedTuple):
    """An executable that waits for its first client."""

    process: subprocess.Popen[str]
    base: int
    """TCP port of SERIAL0; those of SERIAL1 and SERIAL2 are 2 and 3 more."""
    sticks: int
    """UDP port."""
    said: list[str]
    """Lines up to "Waiting for connection"."""

    def url(self, port: int = 0) -> str:
        """Where a client connects."""
        return f"tcp:127.0.0.1:{self.base + port}"


def free_base() -> int:
    """A TCP port that is free, as are those 2 and 3 above it."""
    while True:
        with ExitStack() as stack:
            try:
                first = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
                base = int(first.getsockname()[1])
                for step in (2, 3):
                    stack.enter_context(socket.create_server(("127.0.0.1", base + step)))
            except (OSError, OverflowError):
                continue
            return base


def free_udp_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def command(program: str) -> list[str]:
    """What the installed script of this name runs."""
    start = f"import sys; from sitl.cli.drop_in import {program}; sys.exit({program}())"
    return [sys.executable, "-c", start]


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


@contextmanager
def running(folder: Path, *words: str, program: str = "arducopter") -> Iterator[Running]:
    """The executable, started in ``folder``, until the block is left; it has waited for its first client."""
    base, sticks = free_base(), free_udp_port()
    ports = ("--base-port", str(base), "--rc-in-port", str(sticks))
    process = subprocess.Popen(
        [*command(program), *ports, *words], cwd=folder, env=environment(), text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout is not None and process.stderr is not None
    try:
        said = [process.stdout.readline()]
        while said[-1] and "Waiting for connection" not in said[-1]:
            said.append(process.stdout.readline())
        assert said[-1], process.stderr.read()
        yield Running(process, base, sticks, said)
    finally:
        process.terminate()
        process.communicate(timeout=60)
