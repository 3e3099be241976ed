# SPDX-License-Identifier: BSD-3-Clause
"""Rows that are taken seldom, seen late or lost, without a simulation; and commands that take effect late."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.latency import Latency
from sitl.envs.losses import Losses, LossRates, rates_of
from sitl.envs.past import Past

NOW = {"rate": None, "latency": 0.0}


def past(count: int = 1, **options: Any) -> Past:
    found = Past("scan", count, 2, 0.1, **{**NOW, **options})
    for index in range(count):
        found.start(index, 7 + index)
    found.begin(rows(0, count), None)
    return found


def rows(step: int, count: int = 1) -> Any:
    """What robot k has at the end of a step: (step, 100 k)."""
    return np.array([[float(step), 100.0 * k] for k in range(count)])


def seen(found: Past, steps: int) -> list[int]:
    """Steps of which rows were seen after 0, 1, .. steps."""
    out = [int(found.seen()[0, 0])]
    for step in range(1, steps + 1):
        found.note(rows(step, len(found.taken())), None)
        assert int(found.seen()[0, 0]) == int(found.taken()[0])
        out.append(int(found.seen()[0, 0]))
    return out


@pytest.mark.parametrize(
    ("options", "steps"),
    [
        ({}, [0, 1, 2, 3, 4, 5, 6, 7]),
        ({"latency": 0.1}, [0, 0, 1, 2, 3, 4, 5, 6]),
        ({"latency": 0.3}, [0, 0, 0, 0, 1, 2, 3, 4]),
        ({"rate": 10.0}, [0, 1, 2, 3, 4, 5, 6, 7]),
        ({"rate": 5.0}, [0, 0, 2, 2, 4, 4, 6, 6]),
        ({"rate": 10.0 / 3.0}, [0, 0, 0, 3, 3, 3, 6, 6]),
        ({"rate": 5.0, "latency": 0.1}, [0, 0, 0, 2, 2, 4, 4, 6]),
        ({"rate": 5.0, "latency": 0.2}, [0, 0, 0, 0, 2, 2, 4, 4]),
    ],
)
def test_rows_of_a_rate_and_latency(options: Any, steps: list[int]) -> None:
    assert seen(past(**options), 7) == steps


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"latency": 0.15}, "observation 'scan': latency = 0.15 s is not a whole number of steps of 0.1 s"),
        ({"latency": (0.1, 0.25)}, "latency = 0.25 s is not a whole number"),
        ({"latency": 0.01}, "latency = 0.01 s is not a whole number"),
        ({"rate": 20.0}, "1 / rate = 0.05 s is not a whole number"),
        ({"rate": 4.0}, "1 / rate = 0.25 s is not a whole number"),
    ],
)
def test_times_that_are_no_whole_steps_are_named(options: Any, error: str) -> None:
    with pytest.raises(EnvOptionError, match=error):
        past(**options)


def test_each_robot_goes_on_by_itself() -> None:
    found = past(2, latency=0.1)
    found.note(rows(1, 2), np.array([True, False]))
    found.note(rows(2, 2), np.array([True, False]))
    assert found.seen().tolist() == [[1.0, 0.0], [0.0, 100.0]] and found.taken().tolist() == [1, 0]
    found.start(0, 3)
    found.begin(rows(50, 2), np.array([True, False]))
    assert found.seen().tolist() == [[50.0, 0.0], [0.0, 100.0]] and found.taken().tolist() == [0, 0]
    assert found.arrives.tolist() == [True, True]


def test_what_is_seen_is_a_copy() -> None:
    found = past()
    found.seen()[0, 0] = 99.0
    assert found.seen()[0, 0] == 0.0


@pytest.mark.parametrize(("least", "most"), [(0.1, 0.3), (0.0, 0.2)])
def test_each_episode_draws_a_latency_of_whole_steps(least: float, most: float) -> None:
    found, ages = past(latency=(least, most)), []
    for seed in range(60):
        found.start(0, seed)
        found.begin(rows(0), None)
        for step in range(1, 6):
            found.note(rows(step), None)
        ages.append(5 - int(found.taken()[0]))
    assert set(ages) == set(range(round(10 * least), round(10 * most) + 1))
    assert min(ages.count(age) for age in set(ages)) > 10, "all of them as likely"


def test_noise_is_the_same_as_long_as_the_row_is() -> None:
    found = past(2, rate=5.0)

    def draws() -> list[float]:
        return [float(rng.random()) for rng in found.generators()]

    first = draws()
    found.note(rows(1, 2), None)
    assert draws() == first and first[0] != first[1]
    found.note(rows(2, 2), None)
    assert draws()[0] != first[0]


def test_a_memory_goes_on_and_another_kind_of_past_refuses_it() -> None:
    found = past(latency=0.2)
    seen(found, 4)
    film = found.memory(0)
    other = past(latency=0.2)
    other.recall(0, film)
    for one in (found, other):
        one.note(rows(5), None)
    assert found.seen().tolist() == other.seen().tolist() == [[3.0, 0.0]]
    for wrong in (past(latency=0.1), past(latency=0.2, losses=rates_of(0.1, None))):
        with pytest.raises(EnvOptionError, match="snapshot cannot be restored: 'scan' had another rate, latency or"):
            wrong.recall(0, film)


# ---------------------------------------------------------------- losses


@pytest.mark.parametrize(
    ("dropout", "burst", "rates"),
    [(0.0, None, (0.0, 0.0)), (0.3, None, (0.3, 0.3)), (0.5, 2.0, (0.5, 0.5)), (0.25, 4.0, (1.0 / 12.0, 0.75)),
     (0.5, 1.0, (1.0, 0.0))],
)  # fmt: skip
def test_rates_of_a_chain_of_losses(dropout: float, burst: float | None, rates: tuple[float, float]) -> None:
    """In the long run begin / (begin + 1 - go_on) are lost, 1 / (1 - go_on) in a row."""
    found = rates_of(dropout, burst)
    assert tuple(found) == pytest.approx(rates)
    assert found.begin / (found.begin + 1.0 - found.go_on) == pytest.approx(dropout)


def test_what_is_always_lost_leaves_the_first_row_and_what_never_is_the_last() -> None:
    for rates, last in ((LossRates(1.0, 1.0), 0), (LossRates(0.0, 0.0), 7), (LossRates(1.0, 0.0), 6)):
        assert seen(past(losses=rates), 7)[-1] == last


def test_a_row_that_was_lost_or_not_is_not_drawn_again() -> None:
    losses = Losses(LossRates(0.5, 0.5), 1, 1)
    losses.begin(np.zeros((1, 1)), None)
    one, seeds, robots = np.ones((1, 1)), np.array([5]), np.array([0])
    losses.receive(one, np.array([1]), seeds, robots)
    before = losses.memory(0)
    for _ in range(3):
        losses.receive(one, np.array([1]), seeds, robots)
    assert losses.memory(0)[:3] == before[:3]
    losses.begin(np.full((1, 1), 4.0), np.array([True]))
    assert losses.memory(0)[:3] == (False, 0, 0) and losses.rows.tolist() == [[4.0]]


# ---------------------------------------------------------------- commands that arrive late


def late(seconds: float, count: int = 1, step: float = 0.1) -> Latency:
    robot: Any = SimpleNamespace(name="toy", count=count, tick=0.01, advance_late=lambda: None)
    return Latency(robot, seconds, step, 1)


def posted(latency: Latency, steps: int) -> list[tuple[float, int]]:
    out = []
    for step in range(1, steps + 1):
        latency.post(np.full((len(latency.ticks), 1), float(step)), None)
        out.append((float(latency.due[0, 0]), int(latency.waits[0])))
    return out


@pytest.mark.parametrize(
    ("seconds", "waits"),
    [
        (0.0, [(1, 0), (2, 0), (3, 0)]),
        (0.03, [(1, 3), (2, 3), (3, 3)]),
        (0.1, [(None, 10), (1, 0), (2, 0)]),
        (0.13, [(None, 10), (1, 3), (2, 3)]),
        (0.2, [(None, 10), (None, 10), (1, 0)]),
    ],
)
def test_a_command_takes_effect_whole_ticks_later(seconds: float, waits: list[tuple[int | None, int]]) -> None:
    """Of a step of ten ticks; before the first command does, none takes effect in a whole step."""
    for (due, wait), (command, ticks) in zip(posted(late(seconds), 3), waits, strict=True):
        assert wait == ticks and (command is None or due == command)


@pytest.mark.parametrize("seconds", [-0.01, 60.01, 0.015, float("nan"), float("inf"), True, "soon", None])
def test_latencies_that_cannot_be_are_named(seconds: Any) -> None:
    with pytest.raises(EnvOptionError, match="latency = "):
        late(seconds)


def test_a_robot_that_takes_no_latency_is_named() -> None:
    robot: Any = SimpleNamespace(name="toy", count=1, tick=0.01)
    with pytest.raises(EnvOptionError, match=r"robot 'toy' takes none, its class has no advance_late\(\)"):
        Latency(robot, 0.0, 0.1, 1)


def test_a_latency_that_is_drawn_is_rounded_to_a_tick() -> None:
    latency = late(0.0, 2)
    latency.set(1, 0.034)
    assert latency.ticks.tolist() == [0, 3]
    latency.set(1, 60.0)
    assert latency.ticks.tolist() == [0, 6000]
    for wrong in (60.02, -0.02, float("nan"), float("inf")):
        with pytest.raises(EnvOptionError, match=r"it must be 0 \.\. 60 s"):
            latency.set(1, wrong)


def test_commands_under_way_stay_when_another_robots_latency_grows() -> None:
    latency = late(0.1, 2)
    assert posted(latency, 3)[-1] == (2.0, 0)
    latency.set(1, 0.55)
    latency.post(np.array([[4.0], [40.0]]), None)
    assert latency.due[0, 0] == 3.0 and latency.waits[0] == 0
    latency.post(np.array([[5.0], [50.0]]), np.array([True, False]))
    assert latency.due[0, 0] == 4.0


def test_an_episode_begins_without_commands() -> None:
    latency = late(0.1)
    posted(latency, 3)
    latency.begin(0)
    (_, whole_step), second = posted(latency, 2)
    assert whole_step == 10 and second == (1.0, 0), "what was under way never takes effect"


def test_a_memory_of_commands_goes_on() -> None:
    latency, other = late(0.25), late(0.0)
    posted(latency, 5)
    other.recall(0, latency.memory(0))
    for step in (6.0, 7.0, 8.0):
        for one in (latency, other):
            one.post(np.array([[step]]), None)
        assert (other.due.tolist(), other.waits.tolist()) == (latency.due.tolist(), latency.waits.tolist())
    assert latency.due[0, 0] == 6.0 and latency.waits[0] == 5
