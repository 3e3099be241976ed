# SPDX-License-Identifier: BSD-3-Clause
"""A policy on a vehicle that may be real: it flies within limits, and the vehicle is left in a safe mode."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest

from sitl import cli
from sitl.agents import baselines, environments, learnt
from sitl.agents.deep import policy_file
from sitl.agents.deploy import Deployed, deploy, options_of
from sitl.agents.errors import AgentError
from sitl.autopilot.copter.modes.guided import GUIDED
from sitl.client.proof import REQUEST_MESSAGE
from sitl.envs.robots import at_connection
from sitl.errors import NotReadyError, OptionError
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
    with RealVehicle(simulation, waits=True) as vehicle:
        guard = {"radius": 4.0, "floor": 2.0, "ceiling": 8.0, "late": 60.0}
        url = f"udpout:127.0.0.1:{vehicle.port}"
        done = deploy(policy, url, episodes=2, guard=guard, wait=10.0)
    assert not done.handed_over and [flown.steps for flown in done.episodes] == [30, 30]
    assert [deed.what for deed in done.deeds if deed.what != "limited"] == ["taken over"] * 2 + ["handed over"]
    assert done.deeds[-1].why == "closed" and len(done.thinking) == 60
    assert np.median(done.periods) == pytest.approx(0.1, abs=0.05)
    assert "learnt with 0.100 s" in done.sentences(policy.step_time)[2]
    assert not {DISARM, REBOOT} & vehicle.commands()
    simulation.advance(5.0)
    assert mode(simulation) == BRAKE and simulation.v.autopilot.arming.armed == 1
    assert 1.0 < height(simulation) < 9.0 and math.dist(position(simulation)[:2], began[:2]) < 8.0


class Acting:
    """A policy that does something else at its tenth step."""

    def __init__(self, policy, deed):
        self.check, self.begin, self._policy, self._deed, self._steps = policy.check, policy.begin, policy, deed, 0

    def act(self, observation):
        self._steps += 1
        action = self._policy.act(observation)
        return self._deed(action) if self._steps == 10 else action


class Clock:
    """Wall time that a test sets forth."""

    def __init__(self):
        self.late = 0.0

    def monotonic(self):
        return self.late


def raises(error):
    def deed(action):
        raise error

    return deed


@pytest.mark.parametrize(
    "error",
    [KeyboardInterrupt(), RuntimeError("no such tensor"), SystemExit(143), MemoryError(), RecursionError()],
    ids=repr,
)
def test_a_policy_that_raises_leaves_the_vehicle_in_a_safe_mode(flown, error):
    policy, simulation, out = learnt.load(flown), hovering(), Deployed()
    acting = policy._replace(policy=Acting(policy.policy, raises(error)))
    with RealVehicle(simulation, waits=True) as vehicle, pytest.raises(type(error)):
        deploy(acting, f"udpout:127.0.0.1:{vehicle.port}", wait=10.0, guard={"late": 60.0}, out=out)
    assert [deed.what for deed in out.deeds if deed.what != "limited"] == ["taken over", "handed over"]
    simulation.advance(5.0)
    assert mode(simulation) == BRAKE and simulation.v.autopilot.arming.armed == 1 and height(simulation) > 1.0


def test_actions_that_are_no_numbers_and_a_policy_that_thinks_too_long_end_it(flown, monkeypatch):
    policy = learnt.load(flown)
    simulation = hovering()
    acting = policy._replace(policy=Acting(policy.policy, lambda action: np.full_like(action, np.nan)))
    with RealVehicle(simulation, waits=True) as vehicle, pytest.raises(gym.error.InvalidAction):
        deploy(acting, f"udpout:127.0.0.1:{vehicle.port}", wait=10.0, guard={"late": 60.0})
    assert mode(simulation) == BRAKE
    clock, simulation = Clock(), hovering()
    monkeypatch.setattr(at_connection, "time", clock)

    def late(action):
        clock.late = 1.5
        return action

    acting = policy._replace(policy=Acting(policy.policy, late))
    with RealVehicle(simulation, waits=True) as vehicle:
        done = deploy(acting, f"udpout:127.0.0.1:{vehicle.port}", wait=10.0, episodes=3)
    assert done.handed_over == "the agent is late: 1.50 s since its last step" and len(done.episodes) == 1
    assert mode(simulation) == BRAKE


def _heed_signals():
    """As a shell starts a program: who runs tests in the background, or by nohup, passes ignored signals on."""
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_DFL)


@pytest.mark.slow
@pytest.mark.parametrize(
    "number",
    [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGTSTP, signal.SIGKILL],
    ids=lambda number: number.name,
)
def test_a_process_that_ends_leaves_the_vehicle_flying(flown, number):
    simulation = hovering()
    words = [sys.executable, "-m", "sitl", "deploy", str(flown), "--episodes", "1000", "--guard", "late=60",
             "--guard", "floor=2"]  # fmt: skip
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with RealVehicle(simulation, waits=True) as vehicle:
        words += ["--connection", f"udpout:127.0.0.1:{vehicle.port}"]
        process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=paths, preexec_fn=_heed_signals)
        try:
            while vehicle.count("SET_POSITION_TARGET_LOCAL_NED") < 20 and process.poll() is None:
                vehicle.wait()
            process.send_signal(number)
            said, _ = process.communicate(timeout=60)
        finally:
            process.kill()
            process.wait()
    assert ("handed over: closed" in said) == (number != signal.SIGKILL)
    assert not {DISARM, REBOOT} & vehicle.commands()
    simulation.advance(8.0)
    assert simulation.v.autopilot.arming.armed == 1 and height(simulation) > 1.0
    assert mode(simulation) == (GUIDED if number == signal.SIGKILL else BRAKE)
    assert np.linalg.norm(simulation.v.physics.body.vel) < 0.3


@pytest.mark.slow
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="Linux has it")
@pytest.mark.parametrize("words", ["{} | head -1", "{} >/dev/full", "{} >&- 2>&-", "{} --guard log=/dev/full"])
def test_output_that_goes_nowhere_stops_no_hand_over(flown, words):
    simulation = hovering()
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with RealVehicle(simulation, waits=True) as vehicle:
        url = f"udpout:127.0.0.1:{vehicle.port}"
        command = f"{sys.executable} -m sitl deploy {flown} --guard late=60 --guard floor=2 --connection {url}"
        subprocess.run(["bash", "-c", words.format(command)], env=paths, capture_output=True, timeout=120)
    assert simulation.v.autopilot.arming.armed == 1
    flew = vehicle.count("SET_POSITION_TARGET_LOCAL_NED") > 0
    assert flew == (">/dev/full" not in words)  # which is noticed before the vehicle hears anything
    assert mode(simulation) == (BRAKE if flew else GUIDED)


SCRIPT = """
import sys, threading, time
import gymnasium as gym
import sitl.envs
env = gym.make(sys.argv[1], connection=sys.argv[2], reset="none", patience=0.5, guard={"late": 60.0})
env.reset(seed=1)
env.step(env.action_space.sample())
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "end",
    ["", "1 / 0", "sys.exit(3)", "threading.Thread(target=time.sleep, args=(1000,)).start(); 1 / 0"],
)
def test_a_script_that_ends_without_close_hands_over(end):
    simulation = hovering()
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with RealVehicle(simulation, waits=True) as vehicle:
        words = [sys.executable, "-W", "ignore", "-c", SCRIPT + end, ID, f"udpout:127.0.0.1:{vehicle.port}"]
        with subprocess.Popen(words, env=paths, stderr=subprocess.PIPE) as process:
            try:
                while mode(simulation) != BRAKE and ("Thread" in end or process.poll() is None):
                    vehicle.wait()
            finally:
                process.kill()
    assert mode(simulation) == BRAKE and simulation.v.autopilot.arming.armed == 1


def test_a_vehicle_without_a_lidar_flies_what_reads_none(flown):
    policy, simulation = learnt.load(flown), hovering()
    with RealVehicle(simulation, unsent=("OBSTACLE_DISTANCE", "DEBUG_FLOAT_ARRAY"), waits=True) as vehicle:
        url = f"udpout:127.0.0.1:{vehicle.port}"
        done = deploy(policy, url, guard={"late": 60.0}, wait=10.0)
        assert not done.handed_over and done.episodes[0].steps == 30
        seen = policy.config.with_(env="sitl/CopterForest-v0", env_options={"world": "open"})
        env = environments.make(seen, connection=url, reset="none")
        with pytest.raises(NotReadyError, match=r"does not send OBSTACLE_DISTANCE every 100 ms; .* reads the lidar"):
            env.reset()
        env.close()


def test_a_copter_that_has_landed_flies_back_and_lands_again(flown):
    land = learnt.load(baselines.find("copter-land"))
    with pytest.raises(AgentError, match="the guard's floor is 1 m above the ground: --guard floor=-5"):
        deploy(land, "udpout:127.0.0.1:1")
    simulation = hovering()
    with RealVehicle(simulation, step_us=2_500, waits=True) as vehicle:
        guard = {"late": 60.0, "floor": -5.0}
        done = deploy(land, f"udpout:127.0.0.1:{vehicle.port}", episodes=2, reset="return", guard=guard, wait=30.0)
    assert [flown.solved for flown in done.episodes] == [True, True]
    assert "take-off" in [deed.what for deed in done.deeds]


def test_the_command_says_what_happened(flown, capsys):
    simulation = hovering()
    with RealVehicle(simulation, waits=True) as vehicle:
        words = ["deploy", str(flown), "--connection", f"udpout:127.0.0.1:{vehicle.port}", "--max-steps", "5",
                 "--guard", "radius=5", "--guard", "hand_over=LOITER", "--guard", "late=60"]  # fmt: skip
        assert cli.main(words) == 0
    out = capsys.readouterr().out
    assert "left out, since a simulator alone has them: latency, randomise" in out
    assert "taken over" in out and "handed over: closed" in out and "episode 0: 5 steps" in out
    assert mode(simulation) == LOITER


def test_a_policy_that_names_a_connection_is_flown_there_only_when_the_user_says_so(flown, capsys, monkeypatch):
    monkeypatch.setenv("SITL_ALLOW_CODE", "")
    simulation = hovering()
    with RealVehicle(simulation, waits=True) as vehicle:
        url = f"udpout:127.0.0.1:{vehicle.port}"
        named = learnt.load(flown)
        about = {"env": ID, "algorithm": "ppo", "max_steps": 5, "step_time": 0.1, "versions": {},
                 "options": {"connection": url, "reset": "none", "guard": {"late": 60.0}, "patience": 0.5}}  # fmt: skip
        policy_file.write(flown, named.policy, about)
        words = ["rollout", str(flown), "--episodes", "1", "--robots", "1"]
        assert cli.main(words) == 2
        said = capsys.readouterr().err
        assert f"connection = '{url}'" in said and f"--option connection={url}" in said and not vehicle.received
        word = [f"connection={url}", "reset=none", 'guard={"late": 60.0}']
        again = [part for each in word for part in ("--option", each)]
        assert cli.main([*words, *again, "--jobs", "2"]) == 2
        assert "leads to one vehicle: one process of this machine flies it" in capsys.readouterr().err
        assert not vehicle.received
        assert cli.main([*words, *again]) == 0
        assert mode(simulation) == BRAKE and vehicle.count("SET_POSITION_TARGET_LOCAL_NED") >= 5
        simulation.bridge.autopilot.set_mode(GUIDED)
        # deploy gives these options itself, whatever the file says
        words = ["deploy", str(flown), "--connection", url, "--guard", "late=60"]
        monkeypatch.setenv("SITL_ALLOW_CODE", "")
        assert cli.main(words) == 0 and mode(simulation) == BRAKE


def test_another_autopilot_than_the_one_that_was_named_is_only_asked_who_it_is(flown):
    policy = learnt.load(flown)
    options = {"autopilot": "px4"}
    with RealVehicle(hovering()) as vehicle:
        url = f"udpout:127.0.0.1:{vehicle.port}"
        with pytest.raises(OptionError, match=r"the vehicle is no PX4: .*--autopilot ardupilot"):
            deploy(policy, url, options=options, wait=2.0)
    told = {name for name, _ in vehicle.received}
    assert told <= {"COMMAND_LONG", "PARAM_REQUEST_READ"} and not vehicle.commands() - {REQUEST_MESSAGE}
    with pytest.raises(OptionError, match="a PX4 at a connection is not rebooted"):
        deploy(policy, "udpout:127.0.0.1:1", reset="reboot", options=options)


def test_what_cannot_be_is_refused_before_the_vehicle_hears_anything(flown):
    policy = learnt.load(flown)
    with pytest.raises(AgentError, match="episodes = 0"):
        deploy(policy, "udpout:127.0.0.1:1", episodes=0)
    with pytest.raises(AgentError, match=r"Guard\(radius=-1\)"):
        deploy(policy, "udpout:127.0.0.1:1", guard={"radius": -1})
    with pytest.raises(OptionError, match="connection 'there' is none of"):
        deploy(policy, "there")
    assert cli.main(["deploy", str(flown), "--connection", "udpout:127.0.0.1:1", "--guard", "fence=3"]) == 2
