# SPDX-License-Identifier: BSD-3-Clause
"""Sixteen copters fly the example's formations by pymavlink, in lockstep over TCP; a second run is the same."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from sitl.bridge.frame import Splitter
from sitl.simulation import Core
from tests.clients.conftest import EXAMPLES, ROOT, WALL_S, environment, serve

pytestmark = pytest.mark.slow
COUNT = 16


def flight(folder: Path) -> str:
    """What the example prints; logs are in the folder."""
    with serve(folder, "--lockstep", "--count", str(COUNT)) as port:
        command = [sys.executable, str(EXAMPLES / "swarm_formation.py"), f"tcp:127.0.0.1:{port}", "--lockstep"]
        done = subprocess.run(
            command, cwd=ROOT, env=environment(), text=True, timeout=WALL_S,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
    assert done.returncode == 0, done.stdout
    return done.stdout


def sent(log: Path, system: int) -> list[bytes]:
    """Frames that a vehicle sent, from its .tlog."""
    frames = [
        frame.raw for frame in Splitter().feed(log.read_bytes()) if (frame.system, frame.component) == (system, 1)
    ]
    assert len(frames) > 10_000
    return frames


def test_sixteen_copters_fly_formations_and_repeat_bit_for_bit(core: Core, tmp_path: Path) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    said = flight(first)
    assert said == flight(second)
    assert len(re.findall(r"(ring|arrow|square): within 0\.\d\d m", said)) == 3
    assert said.rstrip().endswith("landed and disarmed")  # and nobody was hit
    for system in range(1, COUNT + 1):
        name = f"erle_copter-{system}"
        assert (first / f"{name}.bin").read_bytes() == (second / f"{name}.bin").read_bytes()
        assert sent(first / f"{name}.tlog", system) == sent(second / f"{name}.tlog", system)
