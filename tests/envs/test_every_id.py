# SPDX-License-Identifier: BSD-3-Clause
"""Each registered id keeps the contracts: the checkers' of the libraries, repeats, pickles, vectors like single ones.

(Swarms: ``test_swarm_envs.py``.)
"""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import sitl.envs  # noqa: F401
from sitl.envs import ids

NAVIGATE = "sitl/Navigate-v0"
IDS = [*ids.PAPER, *ids.FIRST, *ids.NEW, NAVIGATE, "sitl/Navigate-v1"]
OTHERS = [name for name in IDS if name not in ids.NEW]
"""``test_target_tasks.py`` plays those of ``NEW`` again, alone and in vectors, for longer."""
STEPS = 4
pytestmark = pytest.mark.filterwarnings("ignore:.*Box.*(infinity|bound|symmetric|normalized)", "ignore:.*render")


def same(a, b):
    """Whether two observations, rewards or infos are the same to the last bit."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(map(same, a, b))
    a, b = np.asarray(a), np.asarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def played(env, seed, actions):
    """What an episode's reset and steps give."""
    return [env.reset(seed=seed), *(env.step(action) for action in actions)]


@pytest.fixture(params=IDS, scope="module")
def env(request):
    """One for all tests of an id: its vehicles have booted once with a seed."""
    found = gym.make(request.param)
    yield found
    found.close()


def actions_of(env, seed=5):
    env.action_space.seed(seed)
    return [env.action_space.sample() for _ in range(STEPS)]


def test_every_id_is_registered():
    assert set(IDS) <= set(gym.registry)


def test_gymnasiums_checker_takes_it(env):
    check_env(env.unwrapped, skip_render_check=True)


def test_stable_baselines3s_checker_takes_it(env):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    checker.check_env(env, warn=False)  # as gymnasium.make gives it: its wrappers, too


@pytest.mark.parametrize("env", OTHERS, indirect=True)
def test_it_repeats_bit_for_bit_and_pickles_in_the_middle(env):
    actions = actions_of(env)
    first = played(env, 3, actions)
    assert same(first, played(env, 3, actions))
    played(env, 3, actions[:2])
    other = pickle.loads(pickle.dumps(env.unwrapped))
    assert same(first[3:], [other.step(action) for action in actions[2:]])
    other.close()


@pytest.mark.parametrize("env", OTHERS, indirect=True)
def test_a_vector_gives_what_single_ones_give(env):
    vector = gym.make_vec(env.unwrapped.spec.id, num_envs=2)
    rows = [actions_of(env, seed) for seed in (1, 2)]
    observations, _ = vector.reset(seed=3)
    several = [observations]
    for pair in zip(*rows):
        *step, _ = vector.step(np.stack(pair))
        several.append(step)
    vector.close()
    for index, actions in enumerate(rows):
        alone = played(env, 3 + index, actions)
        assert same(alone[0][0], row_of(several[0], index))
        for (observation, *numbers, _), step in zip(alone[1:], several[1:]):
            assert same(observation, row_of(step[0], index))
            assert numbers == [column[index] for column in step[1:]]


def row_of(observations, index):
    if isinstance(observations, dict):
        return {name: value[index] for name, value in observations.items()}
    return observations[index]
