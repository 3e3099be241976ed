# SPDX-License-Identifier: BSD-3-Clause
"""Learning rules by hand, exploration, the cliff that tells Q-learning from Sarsa, and which table is the best."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from pytest import approx

from sitl.agents.errors import AgentError
from sitl.agents.runs.files import read_arrays
from sitl.agents.tabular.exploration import epsilon_in, slot_of
from sitl.agents.tabular.learner import Learner, Outcome, learn_episode
from sitl.agents.tabular.settings import Settings
from sitl.agents.tabular.table import Table
from sitl.agents.tabular.training import Checks
from tests.agents.small_runs import learner_for, make

GREEDY = {"epsilon": 0.0, "epsilon_floor": 0.0}


def learner(algorithm="qlearn", seed=3, **settings):
    table = Table([10], 3)
    for key, values in ((1, (1.0, 2.0, 3.0)), (2, (10.0, 20.0, -5.0))):
        slot = slot_of(table.keys, key)
        table.keys[slot], table.values[slot], table.visits[slot] = key, values, 1
    made = Learner(algorithm, Settings(**{**GREEDY, **settings}), table, seed)
    made.begin(0)
    return made


def test_qlearning_moves_a_value_towards_reward_and_best_successor():
    one = learner()
    following = one.learn(1, 2, 4.0, 2, False)
    assert one.table.row(1).tolist() == [1.0, 2.0, approx(3.0 + 0.2 * (4.0 + 0.9 * 20.0 - 3.0))]
    assert following == 1


def test_sarsa_learns_from_the_action_that_it_takes_next():
    worths = {0: 10.0, 1: 20.0, 2: -5.0}
    seen = set()
    for seed in range(20):
        one = learner("sarsa", seed, epsilon=1.0)
        following = one.learn(1, 0, 4.0, 2, False)
        seen.add(following)
        assert one.table.row(1)[0] == approx(1.0 + 0.2 * (4.0 + 0.9 * worths[following] - 1.0))
    assert seen == {0, 1, 2}


def test_sarsa_that_redraws_takes_other_actions_than_it_learns_from():
    worths = {0: 10.0, 1: 20.0, 2: -5.0}
    differ = 0
    for seed in range(20):
        one = learner("sarsa", seed, epsilon=1.0, redraw=True)
        following = one.learn(1, 0, 4.0, 2, False)
        differ += one.table.row(1)[0] != approx(1.0 + 0.2 * (4.0 + 0.9 * worths[following] - 1.0))
    assert differ > 5


@pytest.mark.parametrize("algorithm", ["qlearn", "sarsa"])
def test_nothing_follows_a_terminal_state_unless_asked_for(algorithm):
    one = learner(algorithm)
    one.learn(1, 0, -200.0, 2, True)
    assert one.table.row(1)[0] == approx(1.0 + 0.2 * (-200.0 - 1.0))
    one = learner(algorithm, terminal_bootstrap=True)
    one.learn(1, 0, -200.0, 2, True)
    assert one.table.row(1)[0] == approx(1.0 + 0.2 * (-200.0 + 0.9 * 20.0 - 1.0))


def test_first_visit_stores_the_reward_and_later_ones_do_not():
    one = learner(first_visit=True)
    one.learn(5, 0, 4.0, 2, False)
    assert one.table.row(5)[0] == 4.0
    one.learn(5, 0, 4.0, 2, False)
    assert one.table.row(5)[0] == approx(4.0 + 0.2 * (4.0 + 0.9 * 20.0 - 4.0))
    assert one.states == 3 == len(one.table)


def test_running_out_of_steps_is_no_end():
    env = gym.make("CliffWalking-v1", max_episode_steps=1)
    one = learner_for(env, settings=Settings(**GREEDY, alpha=1.0))
    start = 36
    for key in range(48):  # all states are worth 7
        slot = slot_of(one.table.keys, key)
        one.table.keys[slot], one.table.values[slot] = key, 7.0
    one.begin(0)
    before = one.table.row(start).copy()
    outcome = learn_episode(env, one, 1)
    assert outcome.steps == 1 and not outcome.terminated
    changed = one.table.row(start)[one.table.row(start) != before]
    assert changed.tolist() in ([approx(-1.0 + 0.9 * 7.0)], [approx(-100.0 + 0.9 * 7.0)])


def shares(one, key, draws=6000):
    return np.bincount([one.choose(key) for _ in range(draws)], minlength=3) / draws


def test_exploration_is_uniform_or_noise_and_equals_are_drawn():
    assert shares(learner(), 2).tolist() == [0.0, 1.0, 0.0]
    assert shares(learner(epsilon=1.0), 2) == approx([1 / 3] * 3, abs=0.03)
    assert shares(learner(epsilon=0.3), 2) == approx([0.1, 0.8, 0.1], abs=0.02)
    assert shares(learner(), 9) == approx([1 / 3] * 3, abs=0.03)  # not met: all values are 0
    # Noise of +-10 on 10, 20, -5: the best is beaten by the first alone, with the area of a corner.
    assert shares(learner(epsilon=1.0, exploration="noise"), 2) == approx([0.125, 0.875, 0.0], abs=0.02)


def test_epsilon_falls_from_episode_to_episode_down_to_its_floor():
    assert epsilon_in(0, 0.9, 0.9986, 0.05) == 0.9
    assert epsilon_in(100, 0.9, 0.9986, 0.05) == approx(0.9 * 0.9986**100)
    assert epsilon_in(2999, 0.9, 0.9986, 0.05) == 0.05
    assert epsilon_in(10, 0.0, 0.9986, 0.05) == 0.0


def test_on_the_cliff_qlearning_takes_the_edge_and_sarsa_keeps_away():
    """Sutton and Barto, example 6.6: the shortest way is 13 steps, along the edge."""
    lengths = {}
    for algorithm in ("qlearn", "sarsa"):
        env = gym.make("CliffWalking-v1", max_episode_steps=500)
        settings = Settings(alpha=0.5, gamma=1.0, epsilon=0.1, epsilon_decay=1.0)
        one = learner_for(env, algorithm, settings)
        for episode in range(500):
            one.begin(episode)
            learn_episode(env, one, episode)
        state, total = env.reset(seed=0)[0], 0
        for _ in range(60):
            state, reward, terminated, _, _ = env.step(int(np.argmax(one.table.row(int(state)))))
            total += reward
            if terminated:
                break
        assert terminated
        lengths[algorithm] = -total
    assert lengths["qlearn"] == 13 and 15 <= lengths["sarsa"] <= 25


STATES, ACTIONS, GAMMA = 6, 3, 0.8


def small_world(seed=3):
    """Where each action leads, what it gives, whether the episode ends there; shapes (states, actions)."""
    rng = np.random.default_rng(seed)
    size = (STATES, ACTIONS)
    return rng.integers(STATES, size=size), rng.normal(0.0, 2.0, size), rng.random(size) < 0.2


def iterated(worth):
    """Values of all pairs, by value iteration; ``worth`` of a table of values is that of each state."""
    goes, gives, ends = small_world()
    values = np.zeros((STATES, ACTIONS))
    for _ in range(500):
        values = gives + GAMMA * ~ends * worth(values)[goes]
    return values


def learnt(algorithm, epsilon, steps, alpha):
    """Values that a learner has after so many steps; ``alpha`` of a step's number is its step size."""
    goes, gives, ends = small_world()
    table = Table([STATES], ACTIONS)
    one = Learner(algorithm, Settings(gamma=GAMMA, epsilon=epsilon, epsilon_decay=1.0, epsilon_floor=0.0), table, 1)
    one.begin(0)
    rng = np.random.default_rng(1)
    state, action = 0, one.choose(0)
    for step in range(steps):
        one._view.alpha = alpha(step)
        after, ended = int(goes[state, action]), bool(ends[state, action])
        following = one.learn(state, action, float(gives[state, action]), after, ended)
        state, action = after, following
        if ended or step % 20 == 19:
            state = int(rng.integers(STATES))
            action = one.choose(state)
    return np.array([one.table.row(key) for key in range(STATES)])


def test_qlearning_finds_the_values_of_value_iteration():
    found = learnt("qlearn", 1.0, 20_000, lambda step: 1.0)
    assert found == approx(iterated(lambda values: values.max(axis=1)), abs=1e-6)


def test_sarsa_finds_the_values_of_the_policy_that_explores():
    def worth(values):
        return 0.6 * values.max(axis=1) + 0.4 * values.mean(axis=1)

    found = learnt("sarsa", 0.4, 120_000, lambda step: max(0.3 * (1.0 - step / 100_000), 0.001))
    right, best = iterated(worth), iterated(lambda values: values.max(axis=1))
    assert np.abs(found - right).max() < 1.0 < 5.0 < np.abs(found - best).max()


def test_settings_that_cannot_be_are_refused():
    for name, value in (("alpha", 0.0), ("gamma", 1.5), ("exploration", "none"), ("redraw", 1), ("epsilon", "x")):
        with pytest.raises(AgentError, match=name):
            Settings.of({name: value})
    with pytest.raises(AgentError, match="did you mean 'alpha'"):
        Settings.of({"alhpa": 0.1})
    assert Settings.as_coded("qlearn").exploration == "noise" and Settings.as_coded("sarsa").redraw


def checks_by(check_by, path):
    env = make()
    return Checks(env, learner_for(env, settings=Settings(check_every=1, check_episodes=2, check_by=check_by)), path)


TABLES = {"slow": [(60.0, False), (80.0, False)], "fast": [(300.0, False), (200.0, True)], "safe": [(90.0, False)] * 2}
"""Rewards of what a table drives, and whether it crashed."""


@pytest.mark.parametrize(("check_by", "best"), [("reward", "fast"), ("crashes", "safe")])
def test_the_best_table_is_by_reward_or_by_crashes(tmp_path, check_by, best):
    checks = checks_by(check_by, tmp_path / "best.npz")
    for episodes, driven in enumerate(TABLES.values(), 1):
        outcomes = iter(driven)
        checks._play = lambda seed, options: Outcome(60, *next(outcomes))  # noqa: B023
        checks.after(episodes)
    found = read_arrays(tmp_path / "best.npz")
    assert list(TABLES)[int(found["episodes"]) - 1] == best
    again = checks_by(check_by, tmp_path / "best.npz")
    again._play = lambda seed, options: Outcome(60, 70.0, False)
    again.after(4)
    assert int(read_arrays(tmp_path / "best.npz")["episodes"]) == int(found["episodes"])


def test_no_other_way_to_choose():
    with pytest.raises(AgentError, match="check_by = 'laps'; it must be one of reward, crashes"):
        Settings(check_by="laps")
