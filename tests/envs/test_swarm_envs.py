# SPDX-License-Identifier: BSD-3-Clause
"""Environments of several agents keep PettingZoo's rules, repeat, and are what their tasks say."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pettingzoo", reason="PettingZoo is not installed")

from gymnasium.error import InvalidAction, ResetNeeded
from pettingzoo.test import parallel_api_test

from sitl.envs.options import EnvOptionError
from sitl.envs.swarm.parallel import HIT, SwarmEnv
from sitl.envs.swarm.tasks import HEIGHT, TASKS, Crossing, Escort, Formation, Pursuit, Scene
from tests.test_docs import ROOT, blocks

GUST = {"SIM_WIND_SPD": 2.0, "SIM_WIND_TURB": 1.0}


@pytest.fixture(scope="module", params=TASKS)
def env(request: Any) -> Iterator[SwarmEnv]:
    made = SwarmEnv(request.param, steps=30, params=GUST)
    yield made
    made.close()


def to_goals(env: SwarmEnv, observations: dict[str, Any]) -> dict[str, Any]:
    """Towards each agent's goal, slower near it."""
    found = {}
    for agent in env.agents:
        size = env.action_space(agent).shape[0]
        north, east, down = 0.6 * observations[agent][3:6] - 0.5 * observations[agent][:3]
        found[agent] = np.clip(np.array([north / 3.0, east / 3.0, -down / 1.5][:size], np.float32), -1.0, 1.0)
    return found


def flown(env: SwarmEnv, seed: int, steps: int = 8) -> list[Any]:
    observations, _ = env.reset(seed=seed)
    seen: list[Any] = [observations]
    for _ in range(steps):
        observations, *rest = env.step(to_goals(env, observations))
        seen.append((observations, *rest))
        if not env.agents:
            break
    return seen


def equal(a: Any, b: Any) -> bool:
    """Whether nested results are the same, bit for bit."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(equal(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(map(equal, a, b))
    return bool(np.array_equal(a, b))


def test_the_rules_of_the_interface_are_kept(env: SwarmEnv) -> None:
    parallel_api_test(env, num_cycles=60)  # PettingZoo's, which asserts


def test_the_same_seed_gives_the_same_episode(env: SwarmEnv) -> None:
    first, other = flown(env, 1), flown(env, 2)
    assert equal(flown(env, 1), first)
    assert not equal(other, first)


def test_agents_are_named_after_their_kinds(env: SwarmEnv) -> None:
    env.reset(seed=0)
    kinds = [agent.partition("_")[0] for agent in env.agents]
    assert kinds == [vehicle.kind.name for vehicle in env.swarm.vehicles]
    assert all(space.dtype == np.float32 for space in map(env.observation_space, env.agents))


class Still(Formation):
    """A ring that does not move."""

    SPEED = TURN = 0.0


@pytest.mark.slow
@pytest.mark.parametrize("task", [Still, Escort])
def test_who_flies_to_the_goals_succeeds(task: type[Formation] | type[Escort]) -> None:
    env = SwarmEnv(task(3), steps=175, estimator="truth")
    observations, _ = env.reset(seed=5)
    infos: dict[str, Any] = {}
    while env.agents:
        observations, _, _, _, infos = env.step(to_goals(env, observations))
    assert len(infos) == 3
    assert all(info["is_success"] for info in infos.values()), observations


def test_a_hit_costs_and_ends_the_episode_of_both() -> None:
    """Two copters that change positions meet in the middle."""
    env = SwarmEnv(Crossing(2), steps=60, estimator="truth")
    env.task.begin = lambda positions, rng: setattr(env.task, "_goals", positions[::-1].copy())  # type: ignore[method-assign]
    observations, _ = env.reset(seed=0)
    rewards: dict[str, float] = {}
    terminations: dict[str, bool] = {}
    while env.agents:
        observations, rewards, terminations, _, infos = env.step(to_goals(env, observations))
    assert terminations == {"copter_0": True, "copter_1": True}
    assert all(reward < HIT + 2.0 for reward in rewards.values())
    assert all(info["was_hit"] for info in infos.values())


def test_rewards_are_what_is_gained() -> None:
    task = Formation(3)
    before, positions, goals = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    goals[:, 0], positions[:, 0] = 5.0, (1.0, 0.0, 4.5)
    assert task.rewards(Scene(positions, before, goals, goals)) == pytest.approx([1.0, 0.0, 4.6])
    moved = goals + (2.0, 0.0, 0.0)
    assert task.rewards(Scene(positions, before, moved, goals)) == pytest.approx([-1.0, -2.0, 2.5])


@pytest.mark.parametrize("task", ["formation", "crossing", "escort"])
def test_an_episode_pays_its_first_distance_minus_its_last(task: str) -> None:
    """Also where goals move; without what is paid for being there, and for hits."""
    env = SwarmEnv(task, steps=6)
    observations, _ = env.reset(seed=3)

    def far() -> Any:
        positions = env._true_positions()
        return np.linalg.norm(positions - env.task.goals(positions, 0.2 * env._count), axis=1)

    first, paid = far(), np.zeros(len(env.agents))
    while env.agents:
        observations, rewards, *_, infos = env.step(to_goals(env, observations))
        for k, agent in enumerate(env.possible_agents):
            paid[k] += rewards[agent] - 0.1 * infos[agent]["is_success"]
            assert not infos[agent]["was_hit"]
    assert paid == pytest.approx(first - far(), abs=1e-9)
    env.close()


def scene(positions: Any, before: Any = None, goals: Any = None) -> Scene:
    now = np.asarray(positions, float)
    then = now if before is None else np.asarray(before, float)
    to = np.zeros_like(now) if goals is None else np.asarray(goals, float)
    return Scene(now, then, to, to)


def apart(*gaps: float) -> list[tuple[float, float, float]]:
    """Pursuers so far behind the last one [m]."""
    return [*((-gap, 0.0, -5.0) for gap in gaps), (0.0, 0.0, -5.0)]


@pytest.mark.parametrize(("gaps", "caught"), [((2.01, 9.0), False), ((2.0, 9.0), False), ((9.0, 1.99), True)])
def test_who_is_pursued_is_caught_within_two_metres(gaps: Any, caught: bool) -> None:
    task, now = Pursuit(3), scene(apart(*gaps), apart(5.0, 5.0))
    assert task.is_over(now) is caught
    assert task.is_success(now).tolist() == [caught, caught, not caught], "it succeeds as long as it gets away"
    gain = 5.0 - min(gaps) + (10.0 if caught else 0.0)
    assert task.rewards(now) == pytest.approx([gain, gain, -gain])


def test_pursuers_are_to_be_where_the_last_one_is_which_is_to_be_far_away() -> None:
    task, positions = Pursuit(3), np.asarray(apart(4.0, 7.0))
    task.begin(positions, np.random.default_rng(1))
    goals = task.goals(positions, 0.0)
    assert (goals[:2] == positions[-1]).all() and goals[-1, 2] == positions[-1, 2]
    assert np.linalg.norm(goals[-1] - positions[-1]) == pytest.approx(20.0)
    moved = positions + (1.0, 2.0, 3.0)
    assert task.goals(moved, 9.0) == pytest.approx(goals + (1.0, 2.0, 3.0))


def test_who_cross_are_to_be_where_the_one_opposite_began() -> None:
    positions = np.array([(0, 0, 0), (6, 0, 0), (0, 6, 0), (6, 6, 0)], float)
    task = Crossing(4)
    task.begin(positions, np.random.default_rng(1))
    goals = task.goals(positions, 0.0)
    away = goals[:, :2] - positions[::-1, :2]
    assert (abs(away) <= 0.5).all() and (away != 0.0).all() and (goals[:, 2] == -HEIGHT).all()
    assert (task.goals(positions + 1.0, 9.0) == goals).all(), "they stay"


@pytest.mark.parametrize("count", [3, 20])
def test_a_formation_is_a_ring_that_flies_and_turns(count: int) -> None:
    positions, task = np.random.default_rng(0).uniform(-5.0, 5.0, (count, 3)), Formation(count)
    task.begin(positions, np.random.default_rng(1))
    first, later = task.goals(positions, 0.0), task.goals(positions, 10.0)
    for goals in (first, later):
        middle = goals.mean(axis=0)
        radii = np.linalg.norm(goals - middle, axis=1)
        assert radii == pytest.approx([radii[0]] * count)
        assert max(4.0, 0.5 * count) - 1e-9 <= radii[0] <= max(7.0, 0.5 * count) + 1e-9
        gaps = np.linalg.norm(goals - np.roll(goals, 1, axis=0), axis=1)
        assert gaps == pytest.approx([2.0 * radii[0] * np.sin(np.pi / count)] * count), "as far from each other"
        assert (goals[:, 2] == -HEIGHT).all()
    assert first.mean(axis=0)[:2] == pytest.approx(positions.mean(axis=0)[:2])
    assert np.linalg.norm(later.mean(axis=0) - first.mean(axis=0)) == pytest.approx(5.0), "0.5 m/s"
    one, other = first[0] - first.mean(axis=0), later[0] - later.mean(axis=0)
    turned = np.arctan2(one[0] * other[1] - one[1] * other[0], one[:2] @ other[:2])
    assert turned == pytest.approx(0.5), "0.05 rad/s, to the right"


def test_who_escort_keep_around_the_rover_three_metres_above_the_ground() -> None:
    positions, task = np.random.default_rng(0).uniform(-5.0, 5.0, (4, 3)), Escort(4)
    assert task.frames == ("erle_copter", "erle_copter", "erle_copter", "ardupilot_rover")
    task.begin(positions, np.random.default_rng(1))
    goals = task.goals(positions, 0.0)
    assert (goals[:3, 2] == -3.0).all()
    around = goals[:3, :2] - positions[3, :2]
    assert np.linalg.norm(around, axis=1) == pytest.approx([2.5] * 3) and around.sum(axis=0) == pytest.approx(
        [0.0, 0.0]
    )
    assert 8.0 <= np.linalg.norm(goals[3] - positions[3]) <= 15.0 and goals[3, 2] == positions[3, 2]
    later = task.goals(positions + 1.0, 5.0)
    assert (later[3] == goals[3]).all() and later[:3, :2] == pytest.approx(goals[:3, :2] + 1.0)


def test_who_is_within_a_metre_is_there_and_gets_a_tenth() -> None:
    task = Crossing(2)
    now = scene([(0.99, 0, 0), (0, 0, 1.0)], [(0.99, 0, 0), (0, 0, 1.0)])
    assert task.is_success(now).tolist() == [True, False] and task.rewards(now) == pytest.approx([0.1, 0.0])
    assert not task.is_over(now)


def test_what_is_reported_is_where_they_are_and_how_fast() -> None:
    """North, east, down of the world's origin, and each other's and the goal's from there."""
    starts = [(30.0, -20.0, 0.0, 0.0), (-15.0, 25.0, 0.0, 90.0), (5.0, 40.0, 0.0, 200.0)]
    env = SwarmEnv(Formation(3), starts=starts, estimator="truth", steps=20)
    env.reset(seed=1)
    found: dict[str, Any] = {}
    for _ in range(15):
        found = env.step({agent: np.array([0.5, -0.25, 0.1], np.float32) for agent in env.agents})[0]
    true = env._true_positions()
    speeds = np.array([tuple(vehicle.v.physics.body.vel) for vehicle in env.swarm.vehicles])
    assert np.abs(env._reported[:, :3] - true).max() < 0.5 and np.abs(env._reported[:, 3:] - speeds).max() < 0.5
    assert np.abs(speeds[:, :2]).min() > 0.5
    for k, agent in enumerate(env.agents):
        others = [env._reported[j] - env._reported[k] for j in range(3) if j != k]
        own = np.concatenate((env._reported[k, 3:], env._goals[k] - env._reported[k, :3], *others))
        assert found[agent] == pytest.approx(own, abs=1e-3)
    env.close()


def test_what_cannot_be_is_refused() -> None:
    for options, needed in (
        ({"task": "dance"}, "formation"),
        ({"count": 1}, "from 2"),
        ({"step": 0.001}, "multiple"),
        ({"step": float("inf")}, "multiple"),
        ({"steps": 0}, "whole number from 1 on"),
        ({"steps": 2.5}, "whole number from 1 on"),
    ):
        with pytest.raises(EnvOptionError, match=needed):
            SwarmEnv(**options)  # type: ignore[arg-type]


NAN = np.array([0.0, np.nan, 0.0], np.float32)


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"copter_1": NAN}, r"agent 'copter_1': action array\(\[ 0., nan,  0.\].* is not in Box.*north -1 .. 1, east"),
        ({"copter_0": [0.0, 0.0, 1.5]}, r"agent 'copter_0': action \[0.0, 0.0, 1.5\] is not in Box.*up -1 .. 1"),
        ({"copter_0": [0.0, 0.0]}, "agent 'copter_0'"),
        ({"copter_0": None}, "agent 'copter_0'"),
        ({"rover_2": [0.0, 0.0, 0.0]}, "agent 'rover_2': .*: north -1 .. 1, east -1 .. 1$"),
        ({"copter_9": [0.0, 0.0, 0.0]}, "agent 'copter_9': agents are copter_0, copter_1, rover_2"),
    ],
)
def test_actions_that_cannot_be_are_refused_and_nothing_moves(changed: dict[str, Any], why: str) -> None:
    env = SwarmEnv("escort", clip_actions=False)
    env.reset(seed=1)
    still = {agent: np.zeros(env.action_space(agent).shape, np.float32) for agent in env.agents}
    time = env.swarm.time_us
    with pytest.raises(InvalidAction, match=why):
        env.step({**still, **changed})
    assert env.swarm.time_us == time
    env.close()


def test_actions_outside_of_their_box_are_clipped_unless_they_are_no_numbers() -> None:
    env = SwarmEnv("formation", count=2)
    env.reset(seed=1)
    given = {"copter_0": [2.0, -7.0, 0.5], "copter_1": [0.0, 0.0, 0.0]}
    assert env.check(given) == {"copter_0": [1.0, -1.0, 0.5], "copter_1": [0.0, 0.0, 0.0]}
    for number in (np.nan, np.inf):
        with pytest.raises(InvalidAction, match="agent 'copter_0'"):
            env.check({**given, "copter_0": [number, 0.0, 0.0]})
    env.close()
    with pytest.raises(EnvOptionError, match="clip_actions = 'no'; it must be True or False"):
        SwarmEnv("formation", clip_actions="no")  # type: ignore[arg-type]


def test_each_agent_needs_an_action_and_the_first_step_a_reset() -> None:
    env = SwarmEnv("crossing")
    with pytest.raises(ResetNeeded, match="call reset"):
        env.step({})
    env.reset(seed=1)
    with pytest.raises(InvalidAction, match="no action of agent copter_1, copter_2, copter_3"):
        env.step({"copter_0": np.zeros(3, np.float32)})
    with pytest.raises(InvalidAction, match="no dict"):
        env.step(np.zeros((4, 3), np.float32))  # type: ignore[arg-type]
    env.close()


def test_the_examples_of_the_page_run() -> None:
    _, example, sights = blocks(ROOT / "docs/swarm.md", "python")
    exec(compile(sights, "docs/swarm.md", "exec"), {})
    scope: dict[str, Any] = {}
    exec(compile(example, "docs/swarm.md", "exec"), scope)
    assert not scope["env"].agents and set(scope["rewards"]) == set(scope["infos"]) != set()


def start_errors(env: SwarmEnv, seed: int) -> Any:
    """What vehicles say of their positions minus true positions, north and east [m], one after another."""
    env.reset(seed=seed)
    return (env._reported - np.hstack((env._true_positions(), np.zeros((len(env.swarm), 3)))))[:, :2].ravel()


def test_episodes_begin_with_boots_of_their_own() -> None:
    """With one boot, estimates err by the same in all episodes; what noise adds within the first step is small."""
    one, many = (SwarmEnv("escort", boots=boots) for boots in (1, 2))
    assert np.all(np.std([start_errors(one, seed) for seed in range(4)], 0) < 0.01)
    drawn = [start_errors(many, seed) for seed in range(4)]
    assert sorted(many.prepared) == [1, 2] and np.all(np.ptp(drawn, 0)[:4] > 0.02)  # the rover's receiver is ideal
    assert np.array_equal(start_errors(many, 0), drawn[0])
    one.close()
    many.close()


def test_a_number_of_boots_that_cannot_be_is_refused() -> None:
    with pytest.raises(EnvOptionError, match=r"boots = 0; a whole number, 1 .. 1024, is needed"):
        SwarmEnv(boots=0)
