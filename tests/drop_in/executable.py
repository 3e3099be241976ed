# SPDX-License-Identifier: BSD-3-Clause
"""Our executables in processes of their own, on free ports, as a launch script starts ArduPilot's."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from tests.ports import free_port

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
    """A port for SERIAL0 whose neighbours for SERIAL1 and SERIAL2 are free, too."""
    return free_port(2, 3)


def command(program: str) -> list[str]:
    """What the installed script of this name runs."""
    start = f"import sys; from sitl.cli.drop_in import {program}; sys.exit({program}())"
    return [sys.executable, "-c", start]


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


@contextmanager
def running(folder: Path, *words: str, program: str = "arducopter") -> Iterator[Running]:
    """The executable, started in ``folder``, until the block is left; it has waited for its first client."""
    base, sticks = free_base(), free_port()
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
