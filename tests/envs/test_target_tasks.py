# SPDX-License-Identifier: BSD-3-Clause
"""Flight and driving tasks: episodes of every id repeat, and are the same alone and in a vector."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs
from sitl.envs import NEW, EnvOptionError
from sitl.envs.actions import VELOCITY, Continuous, Normalised
from sitl.envs.parts import PARTS
from sitl.envs.targets.gates import Gates
from sitl.envs.targets.hold import Hold
from sitl.envs.targets.landing import Land
from sitl.envs.targets.moving import Trajectory
from sitl.envs.targets.waypoints import Waypoints
from tests.envs.vector_equality import same

HOVER = "sitl/CopterHover-v0"


def played(env, seed, steps=25):
    env.action_space.seed(seed)
    out = [env.reset(seed=seed)]
    for _ in range(steps):
        out.append(env.step(env.action_space.sample()))
        if out[-1][2] or out[-1][3]:
            out.append(env.reset())
    return out


@pytest.mark.parametrize("name", NEW)
def test_episodes_of_an_id_repeat(name):
    """Longer than in ``test_every_id.py``, which has Gymnasium's checks: to their ends, and into the next ones."""
    env = gym.make(name)
    first = played(env, 3)
    assert same(first, played(env, 3)) and not same(first, played(env, 4))
    again = pickle.loads(pickle.dumps(env))
    action = env.action_space.sample()
    assert same(env.step(action), again.step(action))


@pytest.mark.parametrize("name", NEW)
def test_many_are_as_one_alone(name):
    vector = gym.make_vec(name, num_envs=3, vectorization_mode="vector_entry_point")
    singles = gym.make_vec(name, num_envs=3, vectorization_mode="sync")
    vector.action_space.seed(1)
    assert same(vector.reset(seed=5)[0], singles.reset(seed=5)[0])
    for _ in range(30):
        actions = vector.action_space.sample()
        got, expected = vector.step(actions), singles.step(actions)
        assert all(same(a, b) for a, b in zip(got[:4], expected[:4]))
        assert got[4].keys() == expected[4].keys()
        assert all(np.array_equal(got[4][key], expected[4][key]) for key in got[4])


@pytest.mark.parametrize("name", NEW)
def test_a_snapshot_goes_on_bit_for_bit(name):
    env = gym.make(name).unwrapped
    played(env, 6, 10)
    kept = env.snapshot()
    env.action_space.seed(9)
    first = [env.step(env.action_space.sample()) for _ in range(8)]
    env.restore(kept)
    env.action_space.seed(9)
    assert same(first, [env.step(env.action_space.sample()) for _ in range(8)])


@pytest.mark.parametrize(("name", "flies"), [("sitl/RoverReachGoal-v1", False), ("sitl/CopterHover-v1", True)])
def test_a_position_to_hold_is_near_the_start_and_for_what_drives_as_high(name, flies):
    env = gym.make(name).unwrapped
    wide, high = env.session.task.offset
    away = []
    for seed in range(20):
        env.reset(seed=seed)
        away.append(env.session.task.positions[0, 0] - env.session.task.judged_pose()[0, :3])
    most = np.abs(away).max(axis=0)
    assert 0.7 * wide < most[0] <= wide + 1e-9 and 0.7 * wide < most[1] <= wide + 1e-9
    assert (0.7 * high < most[2] <= high + 1e-9) if flies else most[2] == 0.0


@pytest.mark.parametrize("name", NEW)
def test_what_a_task_keeps_is_a_copy_and_comes_back_in_another_environment(name):
    env, other = gym.make(name).unwrapped, gym.make(name).unwrapped
    played(env, 6, 10)
    kept = env.snapshot()
    before = pickle.dumps(kept.task)
    env.step(env.action_space.sample())
    env.reset(seed=7)
    assert pickle.dumps(kept.task) == before
    other.reset(seed=99)
    assert pickle.dumps(other.snapshot().task) != before
    other.restore(kept)
    assert pickle.dumps(other.snapshot().task) == before


def test_parts_are_named_and_bounded():
    names = [name for name in PARTS if name not in ("goal_heading", "route")]  # which this task does not have
    env = gym.make("sitl/CopterWaypoint-v0", observation=names)
    seen = env.unwrapped.session.observation
    observation, _ = env.reset(seed=1)
    assert env.observation_space.contains(observation) and observation.dtype == np.float32
    assert len(seen.columns) == len(observation) and list(seen.slices) == names
    robot = env.unwrapped.robot
    assert np.allclose(observation[seen.slices["pose"]], robot.pose[0], atol=1e-6)
    assert np.allclose(observation[seen.slices["true_pose"]][:3], robot.true_state()[0, :3], atol=1e-6)
    body = robot.view(0).physics.body.pos
    assert np.allclose(robot.true_state()[0, :3], (body[0], -body[1], -body[2]))
    named = gym.make("sitl/CopterWaypoint-v0", observation="+".join(names))
    by_name, _ = named.reset(seed=1)
    assert all(np.array_equal(by_name[name], observation[where]) for name, where in seen.slices.items())


def test_the_goal_is_the_way_in_the_robots_heading():
    env = gym.make("sitl/CopterWaypoint-v0", start=(0.0, 0.0, np.pi / 2)).unwrapped
    observation, _ = env.reset(seed=2)
    x, y, z, yaw = env.robot.pose[0]
    way = env.task.targets[0] - (x, y, z)
    ahead, left, up = observation[:3]
    assert ahead * np.cos(yaw) - left * np.sin(yaw) == pytest.approx(way[0], abs=1e-5)
    assert ahead * np.sin(yaw) + left * np.cos(yaw) == pytest.approx(way[1], abs=1e-5)
    assert up == pytest.approx(way[2], abs=1e-5)


def fly(env, seed, fastest=2.0, ahead=0):
    """Velocity towards the goal [m/s], or one that is ``ahead``; the last info and the sum of rewards."""
    observation, _ = env.reset(seed=seed)
    total = 0.0
    while True:
        way = observation[3 * ahead : 3 * ahead + 3].astype(float)
        way *= min(1.5 + 0.5 * ahead, fastest / max(np.sqrt((way * way).sum()), 1e-6))
        action = np.clip([*way[:2] / 5.0, way[2] / 2.0, 0.0], -1.0, 1.0).astype(np.float32)
        observation, reward, terminated, truncated, info = env.step(action)
        total += reward
        if terminated or truncated:
            return info, total, terminated


@pytest.mark.parametrize("name", ["CopterHover", "CopterWaypoint", "CopterCourse", "CopterGates", "CopterFollow"])
def test_who_flies_to_its_goal_succeeds(name):
    follows = name == "CopterFollow"
    info, total, _ = fly(gym.make(f"sitl/{name}-v0"), 1, 4.0 if follows else 2.0, int(follows))
    assert info["is_success"] and total > 10.0


def test_landing_is_judged_by_where_the_copter_really_is():
    env = gym.make("sitl/CopterLand-v0", task=Land(offset=0.0, pad=2.0))
    info, total, terminated = fly(env, 1, 0.7)
    assert terminated and info["is_success"] and total > 15.0
    env = gym.make("sitl/CopterLand-v0", task=Land(offset=0.0, pad=1e-6))
    info, total, terminated = fly(env, 1, 0.7)
    assert terminated and not info["is_success"] and total < 0.0


@pytest.mark.parametrize("options", [{}, {"gcs": "udpout:127.0.0.1:9"}])
def test_a_copter_that_is_asked_says_when_it_has_landed(options):
    env = gym.make("sitl/CopterLand-v0", task=Land(offset=0.0), **options).unwrapped
    env.reset(seed=1)
    robot = env.robot
    assert robot.has_landed().tolist() == [False]
    robot.apply(VELOCITY, np.array([[0.0, 0.0, -1.0, 0.0]]))
    for _ in range(200):
        robot.advance(0.1)
        if robot.has_landed()[0]:
            break
    assert robot.has_landed().tolist() == [True] and robot.true_state()[0, 2] < 0.05
    assert robot.view(0).autopilot.arming.landed
    env.reset(seed=2)
    assert robot.has_landed().tolist() == [False]
    env.close()


def test_one_that_is_not_asked_does_not():
    env = gym.make("sitl/CopterHover-v0").unwrapped
    env.reset(seed=1)
    env.robot.apply(VELOCITY, np.array([[0.0, 0.0, -1.0, 0.0]]))
    for _ in range(200):
        env.robot.advance(0.1)
    assert env.robot.view(0).autopilot.arming.landed and env.robot.has_landed().tolist() == [False]


@pytest.mark.parametrize(("lost", "ends"), [(3.6, True), (None, False)])
def test_a_landing_ends_far_from_the_pad_if_asked_to(lost, ends):
    """The copter climbs away from the pad below it; the error is the distance since the given time."""
    given = {} if lost is None else {"lost": lost}
    env = gym.make("sitl/CopterLand-v0", task=Land(offset=0.0, settle=0.5, **given))
    env.reset(seed=1)
    far, errors, terminated = [], [], False
    while not terminated and len(far) < 20:
        _, _, terminated, _, info = env.step(np.array([0.0, 0.0, 1.0, 0.0], np.float32))
        x, y, z = env.unwrapped.task.targets[0] - info["true_pose"][:3]
        far.append(float(np.sqrt(x * x + y * y + z * z)))
        errors.append(info["error"])
    assert terminated == ends and (far[-1] > 3.6 >= max(far[:-1]) or not ends)
    assert not any(errors[:4])
    assert errors[-1] == pytest.approx(np.sqrt(np.mean(np.square(far[4:]))), abs=1e-6)
    env.close()


def test_an_autopilot_that_says_that_it_has_landed_ends_a_landing(monkeypatch):
    env = gym.make("sitl/CopterLand-v0", task=Land(offset=0.0, pad=2.0)).unwrapped
    env.reset(seed=1)
    assert not env.step(np.zeros(4, np.float32))[2]
    monkeypatch.setattr(env.robot, "has_landed", lambda: np.array([True]))  # as where telemetry's height is wrong
    _, _, terminated, _, info = env.step(np.zeros(4, np.float32))
    assert terminated and info["is_success"]


def test_leaving_the_arena_ends_an_episode():
    env = gym.make("sitl/CopterWaypoint-v0", task=Waypoints(reach=3.0))
    env.reset(seed=1)
    for _ in range(200):
        _, reward, terminated, _, info = env.step(np.array([1.0, 0.0, 0.0, 0.0], np.float32))
        if terminated:
            break
    assert terminated and not info["is_success"] and reward < -9.0 and env.unwrapped.robot.pose[0, 0] > 8.0


def test_rewards_of_goals_are_those_of_steps():
    env = gym.make("sitl/CopterReachGoal-v0").unwrapped
    observation, _ = env.reset(seed=1)
    for _ in range(20):
        observation, reward, *_ = env.step(env.action_space.sample())
        assert reward == env.compute_reward(observation["achieved_goal"], observation["desired_goal"], {})
    there = observation["achieved_goal"]
    assert env.compute_reward(np.stack([there, there]), np.stack([there, there + 5.0]), {}).tolist() == [0.0, -1.0]


@pytest.mark.parametrize(
    "setpoint", ["velocity", "position", "attitude", "acceleration", "thrust", "rates", "rc", "loiter"]
)
def test_normalised_actions_reach_their_limits(setpoint):
    env = gym.make(HOVER, setpoint=setpoint).unwrapped
    action, commands = env.session.action, env.session.commands
    assert env.action_space == gym.spaces.Box(-1.0, 1.0, (4,), np.float32)
    for value in (-1.0, 0.0, 1.0):
        action.commands(np.full((1, 4), value), commands)
        low, high = np.array(action.limits).T
        assert np.allclose(commands[0, action.columns], low + 0.5 * (value + 1.0) * (high - low))
    env.reset(seed=1)
    env.step(np.zeros(4, np.float32))


def test_an_acceleration_accelerates_and_a_rate_turns():
    env = gym.make(HOVER, setpoint="acceleration", step_time=0.5).unwrapped
    env.reset(seed=1)
    for _ in range(2):
        env.step(np.array([0.25, 0.0, 0.0, 0.0], np.float32))  # 1 m/s^2
    assert env.robot.true_state()[0, 4] == pytest.approx(1.0, abs=0.35)
    env = gym.make(HOVER, setpoint="rates", step_time=0.1).unwrapped
    env.reset(seed=1)
    hover = 2.0 * env.robot.view(0).autopilot.params.MOT.THST_HOVER - 1.0
    for _ in range(3):
        env.step(np.array([0.25, 0.0, 0.0, hover], np.float32))  # 1 rad/s to the right
    assert env.robot.true_state()[0, 10] == pytest.approx(1.0, abs=0.2) and env.robot.true_state()[0, 8] > 0.1


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"observation": ["gaol"]}, "part 'gaol' is not known.*did you mean 'goal'"),
        ({"observation": []}, "has no parts; there are pose"),
        ({"observation": ["goal"], "task": "wander"}, "has no target"),
        ({"action": "normal"}, "did you mean 'normalised'"),
    ],
)
def test_what_cannot_be_made_is_said(options, says):
    with pytest.raises(EnvOptionError, match=says):
        gym.make(HOVER, **options)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Hold(radius=0.0), "radius=0"),
        (lambda: Waypoints(0), "count=0"),
        (lambda: Waypoints(places=[(1.0, 2.0)]), "one .x, y, z."),
        (lambda: Gates([]), "one at least"),
        (lambda: Gates([(0.0, 0.0, 1.0, float("nan"))]), "one at least"),
        (lambda: Trajectory("eigth"), "did you mean 'eight'"),
        (lambda: Trajectory(speed=0.0), "above 0"),
        (lambda: Land(pad=0.0), "pad above 0"),
    ],
)
def test_tasks_refuse_what_cannot_be(make, says):
    with pytest.raises(EnvOptionError, match=says):
        make()


def test_a_rover_cannot_land_and_wandering_has_no_goal():
    with pytest.raises(EnvOptionError, match="does not fly"):
        gym.make("sitl/RoverWaypoint-v0", task=Land())
    env = gym.make("sitl/CopterWaypoint-v0").unwrapped
    assert not hasattr(env, "compute_reward")  # by it libraries know what is goal-conditioned


def test_normalised_actions_of_limits_of_ones_own():
    env = gym.make(HOVER, action=Normalised(Continuous(VELOCITY, (-1.0, -1.0), (1.0, 1.0), (0, 3))))
    assert env.action_space.shape == (2,)
    env.reset(seed=1)
    env.step(np.ones(2, np.float32))
    assert sitl.envs.NEW


def test_a_box_of_ones_own_gives_way_to_another_set_point():
    env = gym.make("sitl/CopterReachGoal-v0").unwrapped
    assert env.action_space.shape == (3,) and env.session.action.columns == [0, 1, 2]
    env = gym.make("sitl/CopterReachGoal-v0", setpoint="attitude").unwrapped
    assert env.action_space.shape == (4,) and env.session.action.setpoint.name == "attitude"


def test_observed_targets_are_written_by_the_tasks_own_writer(monkeypatch):
    """It is found by its name: with another one observations are the same, and slower."""
    made = []
    whole = Hold.offsets_writer

    def counted(task, *given):
        made.append(whole(task, *given))
        return made[-1]

    monkeypatch.setattr(Hold, "offsets_writer", counted)
    env = gym.make(HOVER)
    env.reset(seed=0)
    env.step(env.action_space.sample())
    env.close()
    assert made and None not in made
