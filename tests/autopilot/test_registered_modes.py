# SPDX-License-Identifier: BSD-3-Clause
"""Modes of other packages: where they are listed, and what cannot be taken. One is flown in docs/extending.md."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

LISTED = """
from sitl.autopilot.copter.modes.mode_list import NAMES, is_known, run, start
from sitl.bridge.copter.profile import PROFILE
import spin_mode

mode = PROFILE.modes[-1]
assert (mode, NAMES[99], is_known(99)) == (spin_mode.MODE, "SPIN", True)
assert spin_mode.run in run.__globals__.values()
print(mode.description)
"""


def program(text: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A process of its own that finds ``spin_mode``."""
    paths = (str(Path(__file__).parent), str(Path(__file__).parents[2]))
    everything = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **environment}
    return subprocess.run([sys.executable, "-c", text], env=everything, capture_output=True, text=True, timeout=600)


@pytest.mark.parametrize(
    ("text", "environment"),
    (
        (LISTED, {"SITL_MODES": "rover=nothing:MODE copter=spin_mode:MODE"}),
        (f"from sitl.autopilot.modes import register_mode\nregister_mode('copter', 'spin_mode:MODE')\n{LISTED}", {}),
    ),
)
def test_a_mode_of_another_package_is_in_the_list_that_all_else_is_made_from(text: str, environment: dict[str, str]):
    done = program(text, **environment)
    assert done.stdout.strip() == "holds its place and turns at 30 degrees a second; a mode of another package", (
        done.stderr
    )


DRIVEN = """
from sitl.autopilot.modes import register_mode
register_mode("rover", "cruise_mode:MODE")

from sitl import Simulation
from sitl.client import Client

vehicle = Client(Simulation("erle_rover", seed=1))
vehicle.wait_ready()
vehicle.arm()
vehicle.set_mode("CRUISE")
vehicle.delay(15)
assert vehicle.mode == "CRUISE"
print(vehicle.groundspeed / vehicle.params["WP_SPEED"])
"""


@pytest.mark.slow
def test_a_driving_mode_of_another_package_is_driven_by_mavlink() -> None:
    done = program(DRIVEN)
    assert float(done.stdout or "0") == pytest.approx(1.0, abs=0.1), done.stderr


REMEMBERED = """
from sitl.autopilot.modes import register_state
register_state("copter", "spin", "spin_state:SpinState")
from sitl.autopilot.copter.state import Autopilot
from spin_state import SpinState

ap = Autopilot()
ap.modes.spin.turned = 1.5
print(type(ap.modes.spin) is SpinState, ap.modes.spin.turned, list(type(ap.modes).fields)[-1])
"""


def test_what_a_mode_remembers_is_in_the_record_of_the_modes() -> None:
    done = program(REMEMBERED)
    assert done.stdout.strip() == "True 1.5 spin", done.stderr


@pytest.mark.parametrize(
    ("name", "place", "message"),
    (
        ("spin", "spin_mode:MODE", "is no Record"),
        ("flip", "spin_state:SpinState", "the copter has a state of modes flip already"),
        ("Spin", "spin_state:SpinState", "name 'Spin' is not small letters, digits and _"),
    ),
)
def test_what_cannot_be_remembered_is_refused_clearly(name: str, place: str, message: str) -> None:
    first = "from sitl.autopilot.modes import register_state"
    done = program(f"{first}\nregister_state('copter', {name!r}, {place!r})\nimport sitl.autopilot.copter.firmware")
    assert done.returncode != 0
    assert "ExtensionError: state of modes " in done.stderr and message in done.stderr.splitlines()[-1], done.stderr


@pytest.mark.parametrize(
    ("text", "message"),
    (
        ("import sitl.autopilot.copter.firmware; register('copter', 'spin_mode:MODE')", "register it before"),
        ("register('copter', 'spin_mode')", 'must be written as "package.module:NAME"'),
        ("register('copter', 'no_such:MODE'); import sitl.autopilot.copter.firmware", "No module named 'no_such'"),
        ("register('copter', 'spin_mode:RATE'); import sitl.autopilot.copter.firmware", "is no CopterMode"),
        (
            "register('copter', 'sitl.autopilot.copter.modes.brake:MODE'); import sitl.autopilot.copter.firmware",
            "BRAKE (17) takes the place of BRAKE (17)",
        ),
    ),
)
def test_what_cannot_be_taken_is_refused_clearly(text: str, message: str) -> None:
    done = program(f"from sitl.autopilot.modes import register_mode as register\n{text}")
    assert done.returncode != 0
    assert "ExtensionError: mode " in done.stderr and message in done.stderr.splitlines()[-1], done.stderr
