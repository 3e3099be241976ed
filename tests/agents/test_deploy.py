# SPDX-License-Identifier: BSD-3-Clause
"""A policy on a vehicle that may be real: it flies within limits, and the vehicle is left in a safe mode."""

from __future__ import annotations

import math

import gymnasium as gym
import numpy as np
import pytest

from sitl import cli
from sitl.agents import learnt
from sitl.agents.deep import policy_file
from sitl.agents.deploy import deploy, options_of
from sitl.agents.errors import AgentError
from sitl.errors import OptionError
from tests.agents.test_policy_files import made
from tests.envs.test_guarded_vehicles import BRAKE, LOITER, mode, position
from tests.envs.test_reset_of_real_vehicles import DISARM, REBOOT, RealVehicle, height, hovering

ID = "sitl/CopterWaypoint-v0"
pytestmark = pytest.mark.filterwarnings("ignore:.*clock cannot be held")


@pytest.fixture
def flown(tmp_path):
    """The file of a policy for ``ID`` that was never trained."""
    env = gym.make(ID)
    policy = made(env.observation_space, env.action_space, frames=1)
    env.close()
    about = {"env": ID, "algorithm": "ppo", "options": {"latency": 0.05, "randomise": {"mass": [0.9, 1.1]}},
             "max_steps": 30, "step_time": 0.1, "versions": {}}  # fmt: skip
    policy_file.write(tmp_path / "p.npz", policy, about)
    return tmp_path / "p.npz"


def test_a_policy_flies_within_its_guard_and_hands_over_at_the_end(flown):
    policy = learnt.load(flown)
    assert options_of(policy, {"wait": 3.0}) == ({"wait": 3.0}, ["latency", "randomise"])
    simulation = hovering()
    began = position(simulation)
    with RealVehicle(simulation) as vehicle:
        guard = {"radius": 4.0, "floor": 2.0, "ceiling": 8.0, "late": 60.0}
        url = f"udpout:127.0.0.1:{vehicle.port}"
        done = deploy(policy, url, episodes=2, guard=guard, wait=10.0)
    assert not done.handed_over and [steps for steps, _, _ in done.episodes] == [30, 30]
    assert [deed.what for deed in done.deeds if deed.what != "limited"] == ["taken over"] * 2 + ["handed over"]
    assert done.deeds[-1].why == "closed" and len(done.thinking) == 60
    assert np.median(done.periods) == pytest.approx(0.1, abs=0.05)
    assert "learnt with 0.100 s" in done.sentences(policy.step_time)[2]
    assert not {DISARM, REBOOT} & vehicle.commands()
    simulation.advance(5.0)
    assert mode(simulation) == BRAKE and simulation.v.autopilot.arming.armed == 1
    assert 1.0 < height(simulation) < 9.0 and math.dist(position(simulation)[:2], began[:2]) < 8.0


def test_ctrl_c_and_an_error_leave_it_in_a_safe_mode(flown):
    policy = learnt.load(flown)

    class Interrupted:
        check, begin = policy.policy.check, policy.policy.begin

        def act(self, observation):
            raise KeyboardInterrupt

    simulation = hovering()
    with RealVehicle(simulation) as vehicle, pytest.raises(KeyboardInterrupt):
        deploy(policy._replace(policy=Interrupted()), f"udpout:127.0.0.1:{vehicle.port}", wait=10.0)
    simulation.advance(3.0)
    assert mode(simulation) == BRAKE and height(simulation) == pytest.approx(5.0, abs=0.7)


def test_the_command_says_what_happened(flown, capsys):
    simulation = hovering()
    with RealVehicle(simulation) as vehicle:
        words = ["deploy", str(flown), "--connection", f"udpout:127.0.0.1:{vehicle.port}", "--max-steps", "5",
                 "--guard", "radius=5", "--guard", "hand_over=LOITER", "--guard", "late=60"]  # fmt: skip
        assert cli.main(words) == 0
    out = capsys.readouterr().out
    assert "left out, since a simulator alone has them: latency, randomise" in out
    assert "taken over" in out and "handed over: closed" in out and "episode 0: 5 steps" in out
    assert mode(simulation) == LOITER


def test_what_cannot_be_is_refused_before_the_vehicle_hears_anything(flown):
    policy = learnt.load(flown)
    with pytest.raises(AgentError, match="episodes = 0"):
        deploy(policy, "udpout:127.0.0.1:1", episodes=0)
    with pytest.raises(AgentError, match=r"Guard\(radius=-1\)"):
        deploy(policy, "udpout:127.0.0.1:1", guard={"radius": -1})
    with pytest.raises(OptionError, match="connection 'there' is none of"):
        deploy(policy, "there")
    assert cli.main(["deploy", str(flown), "--connection", "udpout:127.0.0.1:1", "--guard", "fence=3"]) == 2
