# SPDX-License-Identifier: BSD-3-Clause
"""``sitl deploy`` on a real ArduPilot with its own physics; SITL_ARDUPILOT names the folder of its executables."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks import deployment
from sitl.agents import baselines, learnt
from sitl.agents.deploy import Deployed, deploy
from tests.agents.test_deploy import Acting, raises

FOLDER = Path(os.environ.get("SITL_ARDUPILOT", ""))
SPEEDUP = 3.0
pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore:.*clock cannot be held"),
    pytest.mark.skipif(
        not all((FOLDER / f"ardu{kind}").is_file() for kind in ("copter", "rover")),
        reason="SITL_ARDUPILOT names no folder with arducopter and ardurover",
    ),
]


@pytest.mark.parametrize("name", ["copter-waypoint", "copter-land", "rover-waypoint"])
def test_a_shipped_policy_does_its_task_and_hands_over(name):
    policy, kind = learnt.load(baselines.find(name)), name.partition("-")[0]
    with deployment.real(FOLDER, kind, SPEEDUP) as (pilot, url):
        done = deployment.abroad(policy, pilot, url, 2, 3.0 if kind == "copter" else 0.0)
        pilot.delay(2.0)
        assert pilot.mode == ("BRAKE" if kind == "copter" else "HOLD") and pilot.armed
    assert [flown.solved for flown in done.episodes] == [True, True] and not done.handed_over


@pytest.fixture
def hovering():
    """A pilot's client of a copter that hovers in GUIDED, and the connection for a policy."""
    with deployment.real(FOLDER, "copter", SPEEDUP) as (pilot, url):
        pilot.take_off(6.0)
        yield pilot, url


def still(pilot):
    """How fast it moves after 8 s [m/s]."""
    pilot.delay(8.0)
    assert pilot.armed and pilot.altitude > 1.0
    return math.hypot(*pilot.velocity)


def test_a_policy_that_raises_leaves_it_in_brake(hovering):
    pilot, url = hovering
    policy, out = learnt.load(baselines.find("copter-hover")), Deployed()
    acting = policy._replace(policy=Acting(policy.policy, raises(RuntimeError("no such tensor"))))
    with pytest.raises(RuntimeError, match="no such tensor"):
        deploy(acting, url, guard={"late": 60.0}, out=out)
    assert out.deeds[-1].why == "closed" and still(pilot) < 0.3 and pilot.mode == "BRAKE"


@pytest.mark.parametrize(
    "number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL], ids=lambda number: number.name
)
def test_a_process_that_ends_leaves_it_flying(hovering, number):
    pilot, url = hovering
    words = [sys.executable, "-m", "sitl", "deploy", "copter-hover", "--episodes", "1000", "--connection", url]
    words += ["--guard", "late=60", "--guard", "floor=2"]
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    began = pilot.position
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=paths) as process:
        # sideways: the climb of the take-off may go on for a moment
        pilot.wait(lambda t: math.dist(pilot.position[:2], began[:2]) > 0.5, timeout=200, what="movement")
        process.send_signal(number)
        said, _ = process.communicate(timeout=60)
    assert ("handed over: closed" in said) == (number != signal.SIGKILL)
    assert still(pilot) < 0.3
    assert pilot.mode == ("GUIDED" if number == signal.SIGKILL else "BRAKE")
