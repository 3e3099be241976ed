# SPDX-License-Identifier: BSD-3-Clause
"""The compiled loop gives the bits of the loop through Gymnasium, and says what it cannot run."""

from __future__ import annotations

import os
import subprocess
import sys

import gymnasium as gym
import pytest

from sitl.agents.tabular.compiled_loop import CompiledLoop
from sitl.agents.tabular.learner import learn_episode
from sitl.agents.tabular.settings import Settings
from tests.agents.small_runs import CIRCUIT2, learner_for, make

RULES = [
    ("qlearn", Settings()), ("qlearn", Settings.as_coded("qlearn")),
    ("sarsa", Settings()), ("sarsa", Settings.as_coded("sarsa")),
]  # fmt: skip


def same(name, algorithm, settings, episodes=12, **options):
    """Both loops; the compiled one's outcomes and table."""
    fast_env, slow_env = make(name, **options), make(name, **options)
    fast, slow = learner_for(fast_env, algorithm, settings), learner_for(slow_env, algorithm, settings)
    assert CompiledLoop.suits(fast_env)
    loop = CompiledLoop(fast_env, fast)
    outcomes = []
    for episode in range(episodes):
        fast.begin(episode)
        slow.begin(episode)
        outcomes.append(loop(100 + episode))
        assert outcomes[-1] == learn_episode(slow_env, slow, 100 + episode)
    ours, theirs = fast.arrays(), slow.arrays()
    assert {name: a.tobytes() for name, a in ours.items()} == {name: a.tobytes() for name, a in theirs.items()}
    return outcomes


@pytest.mark.parametrize("algorithm, settings", RULES)
def test_it_gives_the_bits_of_the_gymnasium_loop(algorithm, settings):
    outcomes = same(CIRCUIT2, algorithm, settings, episodes=30, steps=200)
    assert any(o.terminated for o in outcomes) and len({o.steps for o in outcomes}) > 3


@pytest.mark.parametrize("world", ["Circuit", "Maze", "Round"])
def test_in_the_other_worlds_too(world):
    same(f"Gazebo{world}TurtlebotLIDAR-v0", "sarsa", Settings())


def test_with_random_starts_noise_and_figures():
    noise = {"range_noise": (0.0, 0.05), "wheel_radius_left": (0.0345, 0.0355)}
    outcomes = same(CIRCUIT2, "qlearn", Settings(), start="random", randomise=noise, step_time=0.3)
    assert not all(o.terminated for o in outcomes)


def test_it_refuses_what_it_cannot_run():
    assert not CompiledLoop.suits(gym.make(CIRCUIT2, max_episode_steps=-1))
    assert not CompiledLoop.suits(make(task="wander"))
    assert not CompiledLoop.suits(make(observation="scan"))
    assert not CompiledLoop.suits(make(render_mode="rgb_array"))
    assert not CompiledLoop.suits(gym.wrappers.TransformReward(make(), lambda reward: reward))
    assert not CompiledLoop.suits(gym.make("CliffWalking-v1", max_episode_steps=10))


PLAIN = """
from tests.agents.small_runs import learner_for, make
from sitl.agents.tabular.compiled_loop import CompiledLoop
env = make(steps=12)
learner = learner_for(env, "sarsa")
loop = CompiledLoop(env, learner)
for episode in range(2):
    learner.begin(episode)
    print(loop(episode))
print(*(a.tobytes().hex() for a in learner.arrays().values()))
"""


def test_plain_python_gives_the_same_bits():
    outputs = []
    for disabled in ("0", "1"):
        env = {**os.environ, "NUMBA_DISABLE_JIT": disabled, "PYTHONPATH": os.pathsep.join(sys.path)}
        done = subprocess.run([sys.executable, "-c", PLAIN], env=env, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        outputs.append(done.stdout)
    assert outputs[0] == outputs[1] and "Outcome(steps=12" in outputs[0]
