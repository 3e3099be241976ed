# SPDX-License-Identifier: BSD-3-Clause
"""The examples fly, as they stand."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from sitl import vehicles
from sitl.simulation import Core
from tests.clients.conftest import EXAMPLES, FASTEST, ROOT, SPEEDUP, WALL_S, Fly

pytestmark = pytest.mark.slow


def test_pymavlink_guided(fly: Fly) -> None:
    said = fly(EXAMPLES / "pymavlink_guided.py", "udpin:127.0.0.1:PORT")
    assert "at 20 m north, 20 m east" in said
    assert said.rstrip().endswith("landed and disarmed")


@pytest.mark.parametrize("name", ["mavsdk_offboard", "mavsdk_mission"])
def test_mavsdk(fly: Fly, name: str) -> None:
    pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")
    assert "landed and disarmed" in fly(EXAMPLES / f"{name}.py", "udpin://127.0.0.1:PORT")


@pytest.mark.parametrize(
    ("frame", "speedup"),
    [("erle_rover", SPEEDUP), *((name, FASTEST) for name in vehicles.names("rover", on_bench=False))],
)
def test_mavsdk_rover(fly: Fly, frame: str, speedup: str) -> None:
    """Every rover drives it, the small one for six minutes."""
    pytest.importorskip("mavsdk.asyncio", reason="MAVSDK 4 is not installed")
    url = "udpin://127.0.0.1:PORT"
    said = fly(EXAMPLES / "mavsdk_rover.py", url, "--frame", frame, vehicle="rover", speedup=speedup)
    assert "square driven" in said and "home again" in said
    assert "low" not in said  # no battery warnings
    assert said.rstrip().endswith("disarmed")


def test_lockstep_client(core: Core) -> None:
    command = [sys.executable, str(EXAMPLES / "lockstep_client.py")]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=WALL_S)
    assert done.returncode == 0, done.stderr
    first, second, verdict = done.stdout.splitlines()
    assert verdict == "the same numbers"
    assert first.split(": ")[1] == second.split(": ")[1]
    assert float(first.split()[2]) < 0.5
