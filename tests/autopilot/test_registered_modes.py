# SPDX-License-Identifier: BSD-3-Clause
"""A mode of another package is a file and a line: it is registered, compiled, and set and flown by MAVLink."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

SPIN = """
from sitl.autopilot.modes import register_mode

register_mode("copter", "spin_mode:MODE")

import math

from sitl import Simulation
from sitl.client import Client

vehicle = Client(Simulation("erle_copter", seed=1))
vehicle.take_off(10)
before = vehicle.position
vehicle.command("DO_SET_MODE", 1, 99)
vehicle.wait_mode("SPIN")
vehicle.delay(2)
first = vehicle.heading
vehicle.delay(2)
turned = (vehicle.heading - first) % 360.0
assert abs(turned - 60.0) < 6.0, turned
assert math.dist(before[:2], vehicle.position[:2]) < 2.0
vehicle.set_mode("GUIDED")
with vehicle.messages("AVAILABLE_MODES") as seen:
    vehicle.request("REQUEST_MESSAGE", 435)
    vehicle.delay(1)
assert [m for m in seen if "SPIN" in str(m)], seen
print("flown")
"""


def run(program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """The program in a process of its own that finds ``spin_mode``."""
    paths = (str(Path(__file__).parent), str(Path(__file__).parents[2]))
    everything = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **environment}
    return subprocess.run([sys.executable, "-c", program], env=everything, capture_output=True, text=True, timeout=600)


@pytest.mark.slow
def test_a_mode_of_another_package_is_flown_by_mavlink() -> None:
    done = run(SPIN)
    assert done.stdout.strip() == "flown", done.stderr


def test_the_environment_variable_does_the_same() -> None:
    program = "from sitl.autopilot.copter.modes.table import MODES; print(MODES[-1].name, MODES[-1].description)"
    done = run(program, SITL_MODES="rover=nothing:MODE copter=spin_mode:MODE")
    assert done.stdout.strip().startswith("SPIN holds its place and turns"), done.stderr


@pytest.mark.parametrize(
    ("program", "message"),
    (
        ("import sitl.autopilot.copter.firmware; register('copter', 'spin_mode:MODE')", "too late"),
        ("register('plane', 'spin_mode:MODE')", "no firmware 'plane'"),
        ("register('copter', 'spin_mode')", 'must be written as "package.module:NAME"'),
        ("register('copter', 'no_such:MODE'); import sitl.autopilot.copter.firmware", "No module named 'no_such'"),
        ("register('copter', 'spin_mode:RATE'); import sitl.autopilot.copter.firmware", "is no CopterMode"),
        (
            "register('copter', 'sitl.autopilot.copter.modes.brake:MODE'); import sitl.autopilot.copter.firmware",
            "BRAKE (17) takes the place of BRAKE (17)",
        ),
    ),
)
def test_what_cannot_be_taken_is_refused_clearly(program: str, message: str) -> None:
    done = run(f"from sitl.autopilot.modes import register_mode as register\n{program}")
    assert done.returncode != 0
    assert "ModeError: mode " in done.stderr and message in done.stderr.splitlines()[-1], done.stderr
