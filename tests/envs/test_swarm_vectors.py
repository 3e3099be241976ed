# SPDX-License-Identifier: BSD-3-Clause
"""Several swarms as one vector environment: rows are what single swarms give; one policy learns for all."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pettingzoo", reason="PettingZoo is not installed")

import gymnasium as gym
from gymnasium.vector import AutoresetMode
from pettingzoo.test import api_test, parallel_seed_test

from sitl.envs import swarm
from sitl.envs.options import EnvOptionError
from sitl.envs.swarm.parallel import HIT, SwarmEnv
from sitl.envs.swarm.tasks import Crossing
from sitl.envs.swarm.vector import SwarmVectorEnv
from tests.envs.test_swarm_envs import GUST, equal, flown
from tests.test_docs import ROOT, blocks

pytestmark = pytest.mark.filterwarnings("ignore:.*action space.*")


def test_rows_are_those_of_single_swarms() -> None:
    """Of copters and a rover; also in the episode after the first one."""
    many = SwarmVectorEnv("escort", swarms=2, steps=3, params=GUST)
    alone = [SwarmEnv("escort", steps=3, params=GUST) for _ in range(2)]
    seen, infos = many.reset(seed=4)
    rows = [env.reset(seed=4 + k)[0] for k, env in enumerate(alone)]
    assert many.num_envs == 6 and infos == {} and many.agents == ("copter_0", "copter_1", "rover_2")
    assert many.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    many.action_space.seed(0)
    for step in range(1, 6):
        assert np.array_equal(seen, [row[agent] for row in rows for agent in many.agents])
        actions = many.action_space.sample()
        seen, rewards, terminated, truncated, infos = many.step(actions)
        assert seen in many.observation_space and not terminated.any() and truncated.all() == (step == 3)
        for k, env in enumerate(alone):
            own = dict(zip(many.agents, actions[3 * k : 3 * k + 3]))
            rows[k], paid, _, _, told = env.step({**own, "rover_2": own["rover_2"][:2]})
            assert np.array_equal(rewards[3 * k : 3 * k + 3], list(paid.values()))
            final = infos["final_info"] if step == 3 else infos
            assert np.array_equal(final["true_place"][3 * k], told["copter_0"]["true_place"])
            if step == 3:
                last = infos["final_obs"][3 * k : 3 * k + 3]
                assert all(np.array_equal(a, b) for a, b in zip(last, rows[k].values(), strict=True))
                rows[k] = env.reset()[0]
    many.close()
    for env in alone:
        env.close()


def test_a_hit_ends_the_episode_of_the_swarm() -> None:
    """Two change places and meet; a third one, which was not hit, is truncated."""
    env = SwarmVectorEnv(Crossing(3), steps=60, estimator="truth")
    task: Any = env.swarms[0].task
    task.begin = lambda places, rng: setattr(task, "_goals", places[[1, 0, 2]].copy())
    seen, _ = env.reset(seed=0)
    for _ in range(60):
        way = 0.6 * seen[:, 3:6] - 0.5 * seen[:, :3]
        actions = np.clip(way * np.array([1.0, 1.0, -2.0]) / 3.0, -1.0, 1.0).astype(np.float32)
        seen, rewards, terminated, truncated, infos = env.step(actions)
        if terminated.any():
            break
    assert terminated.tolist() == [True, True, False] and truncated.tolist() == [False, False, True]
    assert (rewards[:2] < HIT + 2.0).all() and infos["final_info"]["was_hit"].tolist() == [True, True, False]
    assert np.linalg.norm(seen[:2, 3:6] - np.stack(infos["final_obs"][:2])[:, 3:6]) > 1.0, "it has begun anew"
    env.close()


def test_what_cannot_be_is_refused() -> None:
    for arguments, needed in (((("formation"), 0), "swarms = 0"), ((Crossing(2), 2), "2 swarms need a task's name")):
        with pytest.raises(EnvOptionError, match=needed):
            SwarmVectorEnv(*arguments)
    env = SwarmVectorEnv("formation", count=2)
    with pytest.raises(gym.error.ResetNeeded):
        env.step(np.zeros((2, 3)))
    with pytest.raises(ValueError, match="1 seeds for num_envs = 2"):
        env.reset(seed=[1])
    env.reset(seed=1)
    with pytest.raises(gym.error.InvalidAction, match=r"shape \(2, 2\); it must be \(2, 3\)"):
        env.step(np.zeros((2, 2)))
    for value in (np.nan, np.inf):
        with pytest.raises(gym.error.InvalidAction, match="agent 'copter_1'"):
            env.step(np.array([[0.0, 0.0, 0.0], [0.0, value, 0.0]]))
    env.close()


@pytest.mark.slow
@pytest.mark.parametrize("steps", [None, 3])
def test_a_pickled_swarm_goes_on(steps: int | None) -> None:
    """Before its first episode, and within one."""
    env = SwarmEnv("escort", params=GUST)
    if steps is not None:
        flown(env, 3, steps)
    copy = pickle.loads(pickle.dumps(env))
    assert copy.agents == env.agents
    if steps is None:
        assert equal(flown(copy, 1, 3), flown(env, 1, 3))
    else:
        actions = {agent: np.full(env.action_space(agent).shape, 0.5, np.float32) for agent in env.agents}
        assert all(equal(copy.step(actions), env.step(actions)) for _ in range(3))
        assert equal(copy.reset(), env.reset())
    env.close()
    copy.close()


@pytest.mark.slow
def test_both_interfaces_of_pettingzoo_are_kept() -> None:
    """By PettingZoo's own tests, which assert."""
    parallel_seed_test(lambda: swarm.parallel_env("escort", steps=10), num_cycles=15)
    api_test(swarm.env("crossing", steps=10), num_cycles=30)


@pytest.mark.slow
def test_supersuit_makes_a_vector_environment() -> None:
    supersuit = pytest.importorskip("supersuit", reason="needs SuperSuit")
    pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    single = supersuit.black_death_v3(swarm.parallel_env("formation", steps=10))
    env = supersuit.concat_vec_envs_v1(
        supersuit.pettingzoo_env_to_vec_env_v1(single), 2, num_cpus=0, base_class="stable_baselines3"
    )
    seen = env.reset()
    assert seen.shape == (8, 24)
    for _ in range(12):
        seen, rewards, dones, infos = env.step(np.zeros((8, 3), np.float32))
    assert rewards.shape == dones.shape == (8,) and len(infos) == 8


@pytest.mark.slow
def test_one_policy_learns_for_all_agents() -> None:
    """As the page shows it, with fewer steps."""
    pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    (example,) = blocks(ROOT / "docs/swarm.md", "py")
    example, learning = example.replace("24_000", "512").split("model.learn")
    scope: dict[str, Any] = {}
    exec(compile(example, "docs/swarm.md", "exec"), scope)
    model = scope["model"]
    before = [values.detach().numpy().copy() for values in model.policy.parameters()]
    exec(compile("model.learn" + learning, "docs/swarm.md", "exec"), scope)
    after = [values.detach().numpy() for values in model.policy.parameters()]
    assert scope["env"].get_attr("step_us") == [200_000] * 16 and model.num_timesteps >= 512
    assert all(np.isfinite(b).all() for b in after)
    assert any(not np.array_equal(a, b) for a, b in zip(before, after))
    scope["env"].close()
