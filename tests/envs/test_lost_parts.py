# SPDX-License-Identifier: BSD-3-Clause
"""Parts whose readings get lost, one by one or several in a row, and whose latency each episode draws."""

from __future__ import annotations

import pickle

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError
from sitl.envs.losses import Losses, rates_of
from sitl.envs.noise import uniform
from sitl.envs.sensed import Sensed
from tests.envs.vector_equality import same

OPEN = {"world": "open", "step_time": 0.1, "action": "continuous"}
TURNING = np.array([0.3, 0.1], np.float32)


def driven(observation, steps, seed=1):
    """Observations of an episode with the same actions, a row a step."""
    env = gym.make("sitl/Navigate-v1", observation=observation, max_episode_steps=-1, **OPEN)
    seen = [env.reset(seed=seed)[0], *(env.step(TURNING)[0] for _ in range(steps))]
    assert all(env.observation_space.contains(row) for row in seen)
    env.close()
    return np.array(seen)


def test_each_episode_draws_a_latency_that_stays():
    now = driven(["pose"], 30)
    assert len(np.unique(now, axis=0)) == 31, "each step has a pose of its own"
    found = []
    for seed in range(40):
        late = driven([Sensed("pose", latency=(0.1, 0.4))], 30, seed)
        ages = [k - int(np.flatnonzero((now == row).all(axis=1))[0]) for k, row in enumerate(late)]
        assert ages == [min(k, ages[-1]) for k in range(31)], "of the first steps the first reading is seen"
        found.append(ages[-1])
    assert set(found) == {1, 2, 3, 4}
    assert np.array_equal(late, driven([Sensed("pose", latency=[0.1, 0.4])], 30, 39)), "the seed draws it"


@pytest.mark.parametrize(("dropout", "burst", "length"), [(0.3, None, 1.0 / 0.7), (0.3, 6.0, 6.0), (0.7, 3.0, 3.0)])
def test_as_many_are_lost_as_was_asked_for_and_the_last_that_arrived_is_seen(dropout, burst, length):
    steps = 5000
    now = driven(["pose"], steps)
    rows = driven([Sensed("pose", dropout=dropout, burst=burst, mask=True)], steps)
    seen, arrived = rows[:, :4], rows[:, 4]
    assert arrived[0] == 1.0 and set(arrived) == {0.0, 1.0}
    last = 0
    for k in range(steps + 1):
        last = k if arrived[k] else last
        assert np.array_equal(seen[k], now[last]), k
    begun = np.count_nonzero(np.diff(arrived) < 0.0)
    assert np.mean(arrived == 0.0) == pytest.approx(dropout, abs=0.05)
    assert np.count_nonzero(arrived == 0.0) / begun == pytest.approx(length, rel=0.15)


def test_readings_between_which_steps_lie_are_lost_as_readings():
    rows = driven([Sensed("pose", rate=2.5, dropout=0.5, mask=True)], 400)
    changes = np.flatnonzero(np.diff(rows[:, 4])) + 1
    assert len(changes) > 20 and np.all(changes % 4 == 0), "one each four steps"


def test_what_is_lost_keeps_its_noise():
    rows = driven([Sensed("pose", noise=0.1, dropout=0.5, mask=True)], 200)
    lost = np.flatnonzero(rows[:, 4] == 0.0)
    assert np.array_equal(rows[lost, :4], rows[lost - 1, :4])
    arrived = np.flatnonzero(rows[1:, 4] == 1.0) + 1
    assert np.all(rows[arrived, 0] != rows[arrived - 1, 0])


def test_parts_of_one_list_are_lost_together_and_others_on_their_own():
    lossy = {"dropout": 0.4, "mask": True}
    together = {"part": ["pose", "velocity"], **lossy}
    rows = driven([together, Sensed("pose", **lossy), Sensed("velocity", **lossy)], 300)
    assert rows.shape[1] == 9 + 5 + 5
    one, pose, velocity = rows[:, 8], rows[:, 13], rows[:, 18]
    assert 0.3 < np.mean(one != pose) < 0.6 and 0.3 < np.mean(pose != velocity) < 0.6
    plain = driven(["pose", "velocity"], 300)
    assert np.array_equal(rows[one == 1.0, :8], plain[one == 1.0])


@pytest.mark.parametrize("name", ["sitl/Navigate-v1", "sitl/CopterHover-v1"])
def test_vector_equals_singles_and_goes_on_from_snapshots_and_pickles(name):
    parts = [
        Sensed(["pose", "velocity"], 0.05, latency=(0.0, 0.6), dropout=0.5, burst=3.0, mask=True),
        Sensed("heading", rate=5.0, dropout=0.3),
    ]
    options = {"observation": parts, "step_time": 0.1, "max_episode_steps": 12}
    vector = gym.make_vec(name, num_envs=3, **options)
    singles = gym.make_vec(name, num_envs=3, vectorization_mode="sync", **options)
    vector.action_space.seed(1)
    assert same(vector.reset(seed=3)[0], singles.reset(seed=3)[0])
    for _ in range(20):
        actions = vector.action_space.sample()
        got = vector.step(actions)
        assert same(got[0], singles.step(actions)[0])
    kept, copy = vector.unwrapped.snapshot(), pickle.loads(pickle.dumps(vector))
    after = [vector.step(actions)[0] for _ in range(8)]
    assert same([copy.step(actions)[0] for _ in range(8)], after)
    vector.unwrapped.restore(kept)
    assert same(vector.unwrapped.observe(), got[0])
    assert same([vector.step(actions)[0] for _ in range(8)], after)
    vector.close()
    singles.close()


def test_a_snapshot_of_other_losses_is_refused():
    plain, lossy = (
        gym.make("sitl/Navigate-v1", observation=[Sensed("pose", dropout=share)], **OPEN).unwrapped
        for share in (0.0, 0.2)
    )
    plain.reset(seed=1)
    with pytest.raises(EnvOptionError, match="had another rate, latency or dropout"):
        lossy.restore(plain.snapshot())


def test_the_chain_has_the_share_and_the_bursts_that_were_asked_for():
    losses = Losses(rates_of(0.2, 4.0), 5000, 1)
    losses.begin(np.zeros((5000, 1)), None)
    seeds, robots = np.arange(5000), np.arange(5000)
    lost = []
    for step in range(1, 40):
        losses.receive(np.full((5000, 1), step), np.full(5000, step), seeds, robots)
        lost.append(losses.lost.copy())
    assert np.mean(lost[20:]) == pytest.approx(0.2, abs=0.01)
    again = np.array(lost)[:, np.array(lost[-2])][-1]
    assert np.mean(again) == pytest.approx(0.75, abs=0.04)


def test_numbers_without_state_are_uniform_and_independent():
    drawn = uniform(np.repeat(np.arange(200), 200), np.tile(np.arange(200), 200)).reshape(200, 200)
    assert drawn.min() >= 0.0 and drawn.max() < 1.0
    assert np.histogram(drawn, 10, (0.0, 1.0))[0] == pytest.approx(4000, abs=300)
    for a, b in ((drawn[1:], drawn[:-1]), (drawn[:, 1:], drawn[:, :-1])):
        assert abs(np.corrcoef(a.ravel(), b.ravel())[0, 1]) < 0.02


@pytest.mark.parametrize(
    ("settings", "needed"),
    [
        ({"dropout": 1.0}, "dropout = 1.0; it must be 0 .. 0.999"),
        ({"dropout": "often"}, "dropout = 'often'"),
        ({"dropout": 0.8, "burst": 2.0}, "0.666667 of them are lost; a greater share needs a greater burst"),
        ({"dropout": 0.1, "burst": 0.5}, "burst = 0.5; it must be 1 .. 1e"),
        ({"latency": (0.3, 0.1)}, r"latency = \(0.3, 0.1\); it must be a time \[s\], or \(least, greatest\)"),
        ({"latency": (0.1, 0.2, 0.3)}, "it must be a time"),
        ({"latency": (0.1, None)}, "latency = None; it must be 0 .. 60 s"),
        ({"latency": (0.0, 0.15)}, "latency = 0.15 s is not a whole number of steps of 0.1 s"),
        ({"part": []}, "is empty"),
        ({"part": ["pose", "velocty"]}, "did you mean 'velocity'"),
        ({"part": [Sensed("pose", 0.1)]}, "has errors of its own"),
    ],
)
def test_what_cannot_be_is_refused(settings, needed):
    with pytest.raises(EnvOptionError, match=needed):
        gym.make("sitl/Navigate-v1", observation=[{"part": "pose", **settings}], **OPEN)
