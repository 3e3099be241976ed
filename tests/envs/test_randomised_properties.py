# SPDX-License-Identifier: BSD-3-Clause
"""Domain randomisation without a simulation: ranges and their errors, what a robot is given, intervals, faults."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.envs import EnvOptionError
from sitl.envs.randomisation import Randomisation, ranges_of
from sitl.envs.robots.robot import Volume
from sitl.errors import OptionError
from sitl.vehicle.faults import Failure
from sitl.vehicles.properties.property import Property


class Robot:
    """Keeps what it is given."""

    name = "toy"
    count = 2

    def __init__(self) -> None:
        self.properties = {
            "mass": Property("mass", "kg", "", 0.1, 10.0, 1.0),
            "centre": Property("centre", "m", "", -1.0, 1.0, length=2),
            "range_max": Property("range_max", "m", "", 0.1, 100.0, 5.0),
            "radius": Property("radius", "m", "", 0.01, 5.0, 0.2),
        }
        self.given: list[tuple[int, str, Any]] = []
        self.range_max = 5.0
        self.volume = Volume(0.2, 0.0, 0.1)

    def set_property(self, index: int, name: str, value: Any) -> None:
        self.given.append((index, name, value))


class Failing(Robot):
    """One whose faults are "gps" and "wind" up to 10."""

    def __init__(self) -> None:
        super().__init__()
        self.failed: list[tuple[int, Failure]] = []

    def check_failure(self, failure: Failure) -> None:
        if failure.unit not in ("gps", "wind") or (failure.amount or 0.0) > 10.0:
            raise OptionError(f"fault {failure.unit}: not here")

    def fail(self, index: int, failure: Failure) -> None:
        self.failed.append((index, failure))


def toy() -> Any:
    return Robot()


def failing() -> Any:
    return Failing()


def randomisation(ranges: Any, robot: Any = None, latency: Any = None) -> Randomisation:
    return Randomisation(ranges_of(ranges), robot or toy(), latency)


def test_nothing_is_drawn_where_nothing_is_said() -> None:
    robot = toy()
    ways: tuple[Any, ...] = (None, {})
    for nothing in ways:
        randomisation(nothing, robot).draw(0, robot, (1, 2))
    assert robot.given == []


@pytest.mark.parametrize(
    ("ranges", "error"),
    [
        ("idetified", r"randomise = 'idetified'; it must map properties to \(low, high\), or be 'identified' or None"),
        (3, "randomise = 3; it must map"),
        ({"mas": (1, 2)}, "randomise: property 'mas'.*mass"),
        ({"mass": (2, 1)}, r"mass = \(2, 1\); it must be low <= high within 0.1 .. 10 kg"),
        ({"mass": (0.05, 1)}, "it must be low <= high within"),
        ({"mass": (1, 10.1)}, "it must be low <= high within"),
        ({"mass": (1, float("nan"))}, "it must be low <= high within"),
        ({"mass": 3}, r"mass = 3; it must be \(low, high\) or a function"),
        ({"mass": (1, 2, 3)}, "it must be"),
        ({"mass": ("a", "b")}, "it must be"),
        ({"centre": (0.0, 0.5)}, r"it must be \(low, high\), of 2 numbers each, or a function"),
        ({"centre": ((0.0, 0.0), (0.5, 1.5))}, "it must be low <= high within -1 .. 1 m"),
        ({"draws": 0}, "draws = 0; it must be a whole number 1 .. 100000"),
        ({"draws": 100_001}, "draws = 100001; it must be a whole number"),
        ({"draws": True}, "draws = True; it must be"),
        ({"draws": 1.0}, "draws = 1.0; it must be"),
        ({"identified": 1}, "identified = 1; it must be True or False"),
        ("identified", "identified: robot 'toy' has no intervals: give the frame of a file"),
        ({"gps": (0, 1)}, "randomise: gps: robot 'toy' has no faults; vehicles with an autopilot do"),
    ],
)
def test_ranges_that_are_none_are_named(ranges: Any, error: str) -> None:
    with pytest.raises(EnvOptionError, match=error):
        randomisation(ranges)


@pytest.mark.parametrize("ends", [(0.1, 10.0), (3.0, 3.0), [1, 2]])
def test_limits_themselves_may_be_drawn(ends: Any) -> None:
    robot = toy()
    randomisation({"mass": ends}, robot).draw(1, robot, (1, 2))
    ((index, name, value),) = robot.given
    assert (index, name) == (1, "mass") and ends[0] <= value <= ends[1] and isinstance(value, float)


def test_draws_follow_from_the_seed_and_fill_the_range() -> None:
    robot = toy()
    drawn = randomisation({"mass": (1.0, 2.0), "centre": ((-1.0, 0.0), (0.0, 0.5))}, robot)
    for seed in range(200):
        drawn.draw(0, robot, (seed, 7))
    first = list(robot.given)
    robot.given.clear()
    for seed in range(200):
        drawn.draw(0, robot, (seed, 7))
    assert robot.given == first
    masses = [value for _, name, value in first if name == "mass"]
    assert 1.0 <= min(masses) < 1.05 and 1.95 < max(masses) < 2.0
    centres = [value for _, name, value in first if name == "centre"]
    assert all(-1.0 <= x <= 0.0 <= y <= 0.5 and isinstance(x, float) for x, y in centres)


def test_functions_draw_with_the_episodes_generator() -> None:
    robot = toy()
    randomisation({"mass": lambda rng: rng.integers(3, 5), "centre": lambda rng: [0.5, rng.random()]}, robot).draw(
        0, robot, (4, 5)
    )  # fmt: skip
    rng = np.random.default_rng((4, 5))
    assert robot.given == [(0, "mass", float(rng.integers(3, 5))), (0, "centre", (0.5, rng.random()))]


def test_sets_are_drawn_once_and_are_always_the_same() -> None:
    def values(seed: int) -> list[Any]:
        robot = toy()
        drawn = randomisation({"mass": (1.0, 2.0), "draws": 3}, robot)
        for episode in range(40):
            drawn.draw(0, robot, (seed, episode))
        return [value for _, _, value in robot.given]

    rng = np.random.default_rng(0)
    three = {rng.uniform(1.0, 2.0) for _ in range(3)}
    assert set(values(1)) == three == set(values(2)) and values(1) != values(2)


@pytest.mark.parametrize(("high", "seen"), [(4.0, 5.0), (9.0, 9.0)])
def test_the_greatest_range_of_a_lidar_is_the_observations(high: float, seen: float) -> None:
    robot = toy()
    randomisation({"range_max": (1.0, high)}, robot)
    assert robot.range_max == seen and robot.volume.radius == 0.2


@pytest.mark.parametrize(("high", "radius"), [(0.1, 0.2), (0.6, 0.6)])
def test_positions_are_drawn_with_clearance_for_the_widest_robot(high: float, radius: float) -> None:
    robot = toy()
    randomisation({"radius": (0.05, high)}, robot)
    assert robot.volume.radius == radius and robot.range_max == 5.0


def test_measured_intervals_hold_but_for_what_is_given_otherwise() -> None:
    robot = toy()
    robot.airframe = SimpleNamespace(intervals={"mass": (1.0, 1.1), "radius": (0.3, 0.3)}, title="airframe x")
    assert randomisation("identified", robot).ranges == {"mass": (1.0, 1.1), "radius": (0.3, 0.3)}
    found = randomisation({"identified": True, "mass": (2.0, 3.0)}, robot)
    assert found.ranges == {"mass": (2.0, 3.0), "radius": (0.3, 0.3)}
    assert randomisation({"identified": False, "mass": (2.0, 3.0)}, robot).ranges == {"mass": (2.0, 3.0)}
    robot.airframe.intervals = {}
    with pytest.raises(EnvOptionError, match="identified: airframe x has no intervals"):
        randomisation("identified", robot)


def test_latency_is_set_where_there_is_one() -> None:
    robot = toy()
    told: list[tuple[int, float]] = []
    latency = SimpleNamespace(set=lambda index, seconds: told.append((index, seconds)))
    randomisation({"latency": (0.1, 0.1)}, robot, latency).draw(1, robot, (1, 1))
    randomisation({"latency": (0.1, 0.1)}, robot).draw(1, robot, (1, 1))
    assert told == [(1, 0.1)] and robot.given == []


def test_a_fault_fails_as_the_episode_begins_with_the_amount_that_was_drawn() -> None:
    robot = failing()
    drawn = randomisation({"wind": (2.0, 4.0), "mass": (1.0, 1.0)}, robot)
    drawn.draw(0, robot, (1, 1))
    drawn.draw(1, robot, (1, 2))
    assert robot.failed == [] and [name for _, name, _ in robot.given] == ["mass", "mass"]
    drawn.begin(0, robot)
    drawn.begin(0, robot)
    ((index, failure),) = robot.failed
    assert (index, failure.unit, failure.begin, failure.end) == (0, "wind", 0.0, None)
    assert failure.amount is not None and 2.0 <= failure.amount <= 4.0
    drawn.begin(1, robot)
    assert [k for k, _ in robot.failed] == [0, 1]


@pytest.mark.parametrize(
    ("ranges", "error"),
    [
        ({"baro": (0, 1)}, "randomise: fault baro: not here"),
        ({"wind": (5.0, 10.1)}, "randomise: fault wind: not here"),
        ({"wind": (5.0, 4.0)}, r"fault 'wind': \(5.0, 4.0\) is not \(low, high\)"),
        ({"wind=3": (5.0, 6.0)}, "amounts are drawn, and it begins with the episode: neither is said"),
        ({"wind@3": (5.0, 6.0)}, "amounts are drawn, and it begins with the episode: neither is said"),
    ],
)
def test_faults_that_cannot_be_drawn_are_named(ranges: Any, error: str) -> None:
    with pytest.raises(EnvOptionError, match=error):
        randomisation(ranges, failing())


def test_an_amount_that_a_function_draws_is_checked_when_it_is_drawn() -> None:
    robot = failing()
    drawn = randomisation({"wind": lambda rng: 11.0}, robot)
    with pytest.raises(EnvOptionError, match="randomise: fault wind: not here"):
        drawn.draw(0, robot, (1, 1))
