# SPDX-License-Identifier: BSD-3-Clause
"""Tables: numbers of states, growth, files; and the compiled loop, which fills them with the bits of Gymnasium's."""

from __future__ import annotations

import os
import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.agents.errors import AgentError
from sitl.agents.tabular.compiled_loop import CompiledLoop
from sitl.agents.tabular.exploration import EMPTY, slot_of
from sitl.agents.tabular.learner import learn_episode
from sitl.agents.tabular.settings import Settings
from sitl.agents.tabular.table import Table
from tests.agents.small_runs import CIRCUIT2, learner_for, make


def fill(table, keys):
    for taken, key in enumerate(keys):
        table.reserve(taken, 1)
        slot = slot_of(table.keys, key)
        assert table.keys[slot] == EMPTY
        table.keys[slot], table.values[slot], table.visits[slot] = key, [key, -key, 0.5], [1, 2, 3]


@given(st.lists(st.integers(0, 20), min_size=6, max_size=6))
def test_number_of_a_state_gives_its_digits_back(digits):
    table = Table([21] * 6, 3)
    key = table.key(np.array(digits))
    assert 0 <= key < table.size and table.digits(key) == digits


def test_growing_keeps_every_state():
    table = Table([21] * 5, 3)
    keys = np.unique(np.random.default_rng(1).integers(0, table.size, 5000)).tolist()
    fill(table, keys)
    assert len(table) == len(keys) and 2 * len(keys) <= len(table.keys)
    assert all(table.row(key).tolist() == [key, -key, 0.5] for key in keys)
    assert table.row(next(k for k in range(table.size) if k not in set(keys))).tolist() == [0.0, 0.0, 0.0]


def test_file_holds_the_table_and_does_not_depend_on_the_order_of_states(tmp_path):
    one, other = Table([21] * 5, 3), Table([21] * 5, 3)
    keys = list(range(0, 90_000, 37))
    fill(one, keys)
    fill(other, keys[::-1])
    one.save(tmp_path / "one.npz")
    other.save(tmp_path / "other.npz")
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "other.npz").read_bytes()
    back = Table.load(tmp_path / "one.npz")
    assert len(back) == len(keys) and all(back.row(key).tolist() == one.row(key).tolist() for key in keys)
    assert back.radix.tolist() == [21] * 5 and back.visits.sum() == 6 * len(keys)


def test_files_that_are_no_tables_are_refused(tmp_path):
    (tmp_path / "text.npz").write_text("no table")
    np.savez(tmp_path / "other.npz", a=1)
    for name, message in (("text.npz", "no model"), ("other.npz", "no table"), ("none.npz", "no model")):
        with pytest.raises(AgentError, match=message):
            Table.load(tmp_path / name)


def stored():
    """Arrays of a table of two states."""
    table = Table([21] * 5, 3)
    fill(table, [5, 7])
    return table.arrays()


@pytest.mark.parametrize(
    "change",
    [
        {"keys": np.array([5, 5])}, {"keys": np.array([-1, 7])}, {"keys": np.array([5, 2 * 21**5])},
        {"keys": np.array([5.0, 7.0])}, {"keys": np.array([5])}, {"radix": np.array(21)}, {"radix": np.array([21, 0])},
        {"values": np.full((2, 3), np.nan)}, {"values": np.zeros((2, 2))}, {"values": np.zeros(6)},
        {"values": np.array([["a"] * 3] * 2)}, {"visits": np.zeros((2, 3))}, {"visits": np.full((2, 3), -1)},
    ],
)  # fmt: skip
def test_damaged_tables_are_refused(tmp_path, change):
    assert len(Table.of_arrays(stored())) == 2
    np.savez(tmp_path / "table.npz", **{**stored(), **change})
    with pytest.raises(AgentError, match="table"):
        Table.load(tmp_path / "table.npz")


def test_damaged_files_are_refused_in_words(tmp_path):
    path = tmp_path / "table.npz"
    table = Table([21] * 5, 3)
    fill(table, list(range(0, 3000, 7)))
    table.save(path)
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    damaged = [whole[:count] for count in (0, 1, 30, len(whole) // 2, len(whole) - 1)]
    for place in rng.integers(len(whole), size=150).tolist():
        damaged.append(whole[:place] + bytes([whole[place] ^ int(rng.integers(1, 256))]) + whole[place + 1 :])
    refused = 0
    for content in damaged:
        path.write_bytes(content)
        try:
            assert len(Table.load(path)) == len(table)  # a byte that nobody reads
        except AgentError as error:
            assert str(path) in str(error)
            refused += 1
    assert refused > 100


def test_only_discrete_spaces_have_tables():
    digits, three = gym.spaces.MultiDiscrete([7] * 5), gym.spaces.Discrete(3)
    assert Table.for_spaces(digits, three).size == 7**5
    assert Table.for_spaces(gym.spaces.Discrete(16), three).size == 16
    with pytest.raises(AgentError, match="observation = digits"):
        Table.for_spaces(gym.spaces.Box(0.0, 1.0, (5,)), three)
    with pytest.raises(AgentError, match="--option action=discrete"):
        Table.for_spaces(digits, gym.spaces.Box(0.0, 1.0, (1,)))
    with pytest.raises(AgentError, match="too many"):
        Table.for_spaces(gym.spaces.MultiDiscrete([100] * 12), three)


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


def test_with_random_starts_noise_and_properties():
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
