# SPDX-License-Identifier: BSD-3-Clause
"""Faults of episodes without a simulation: which is drawn, when it begins, what cannot be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.faults import NEVER, EpisodeFaults
from sitl.vehicle.faults import LATEST_S
from tests.envs.test_randomised_properties import failing, toy


@pytest.mark.parametrize(
    ("faults", "error"),
    [
        ({}, "faults = {}; it must map faults to their times"),
        (["gps"], "it must map faults to their times"),
        ({"gps": -0.1}, "'gps': -0.1 is neither a time"),
        ({"gps": (3.0, 2.0)}, "is neither a time"),
        ({"gps": (1.0, 2.0, 3.0)}, "is neither a time"),
        ({"gps": "soon"}, "is neither a time"),
        ({"gps": float("nan")}, "is neither a time"),
        ({"gps": LATEST_S * 1.001}, "is neither a time"),
        ({"gps@3": 1.0}, "its time stands behind it"),
        ({"gps@0..3": 1.0}, "its time stands behind it"),
        ({"baro": 1.0}, "faults: fault baro: not here"),
    ],
)
def test_faults_of_episodes_that_cannot_be_are_named(faults: Any, error: str) -> None:
    with pytest.raises(EnvOptionError, match=error):
        EpisodeFaults(faults, failing())


def test_a_robot_without_faults_is_named() -> None:
    with pytest.raises(EnvOptionError, match="faults: robot 'toy' has none; vehicles with an autopilot do"):
        EpisodeFaults({"gps": 1.0}, toy())


def test_each_fault_of_an_episode_is_as_likely_and_begins_at_its_time() -> None:
    robot = failing()
    faults = EpisodeFaults({"gps": (5.0, 20.0), "": 0.0, "wind=3": LATEST_S}, robot)
    rng, numbers = np.random.default_rng(1), []
    for _ in range(600):
        faults.begin(1, rng)
        numbers.append(int(faults.number[1]))
        if numbers[-1] == 0:
            assert faults.begins[1] == NEVER
        else:
            index, failure = robot.failed[-1]
            assert index == 1 and failure.begin == faults.begins[1]
            assert failure.unit == {1: "gps", 3: "wind"}[numbers[-1]]
    assert faults.number[0] == 0 and faults.begins[0] == NEVER
    assert {n: numbers.count(n) > 150 for n in set(numbers)} == {0: True, 1: True, 3: True}
    times = [failure.begin for _, failure in robot.failed if failure.unit == "gps"]
    assert 5.0 <= min(times) < 5.5 and 19.5 < max(times) < 20.0


def test_a_fault_is_seen_from_its_time_on() -> None:
    faults = EpisodeFaults({"gps": 5.0}, failing())
    faults.begin(0, np.random.default_rng(1))
    assert faults.seen(np.array([4.9, 99.0])).tolist() == [0, 0]
    assert faults.seen(np.array([5.0, 99.0])).tolist() == [1, 0]
    kept = faults.memory(0)
    other = EpisodeFaults({"gps": 5.0}, failing())
    other.recall(0, kept)
    assert kept == (1, 5.0) and other.seen(np.array([5.0, 5.0])).tolist() == [1, 0]


@pytest.mark.parametrize(
    ("steps", "told"),
    [(None, False), (-1, False), (51, False), (50, True), (10, True)],
)
def test_a_fault_that_begins_after_the_last_step_is_told(steps: int | None, told: bool) -> None:
    faults = EpisodeFaults({"": 0.0, "gps": (5.0, 9.0)}, failing())
    text = faults.unreached(steps, 0.1)
    assert bool(text) == told
    if told and steps is not None:
        last = f"an episode of {steps} steps ends at {steps * 0.1:g} s"
        assert text == f"faults: gps begins at 5 s, and {last}"
