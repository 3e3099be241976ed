# SPDX-License-Identifier: BSD-3-Clause
"""Arguments of tasks with targets: the last number that can be, the first that cannot, and how it is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.envs.options import EnvOptionError
from sitl.envs.targets.among import Among
from sitl.envs.targets.gates import Gate, Gates
from sitl.envs.targets.hold import Hold
from sitl.envs.targets.landing import Land
from sitl.envs.targets.moving import Follow, Trajectory
from sitl.envs.targets.parking import Park
from sitl.envs.targets.waypoints import Waypoints
from sitl.envs.tasks import ReachGoal, Task

TINY = 1e-9
ABOVE_0: dict[Any, tuple[str, ...]] = {
    Hold: ("radius", "hold", "scale", "half"), Waypoints: ("radius",), Among: ("radius", "ceiling"), Gates: ("far",),
    Trajectory: ("radius", "scale", "lost", "half", "size", "speed"), Land: ("pad", "far", "lost"),
    Follow: ("radius", "scale", "lost", "half", "size", "speed"), Park: ("radius", "angle", "speed"),
    ReachGoal: ("radius",),
}  # fmt: skip
FROM_0: dict[Any, tuple[str, ...]] = {
    Hold: ("far",), Waypoints: ("apart",), Among: ("apart",), Land: ("offset", "speed"), Follow: ("height",),
    Task: ("crash_range",),
}  # fmt: skip


def pairs(table: dict[Any, tuple[str, ...]]) -> list[tuple[Any, str]]:
    return [(task, name) for task, names in table.items() for name in names]


@pytest.mark.parametrize(("task", "name"), pairs(ABOVE_0))
def test_what_must_be_above_zero_is_not_zero(task: Any, name: str) -> None:
    given = {"gates": [Gate(1.0, 2.0, 3.0, 0.0)]} if task is Gates else {}
    task(**given, **{name: TINY})
    for refused in (0.0, -TINY, math.nan):
        with pytest.raises(EnvOptionError, match=rf"{name} ?=.*above 0"):
            task(**given, **{name: refused})


@pytest.mark.parametrize(("task", "name"), pairs(FROM_0))
def test_what_may_be_zero_is_not_below_it(task: Any, name: str) -> None:
    for allowed in (0.0, TINY):
        task(**{name: allowed})
    for refused in (-TINY, math.nan):
        with pytest.raises(EnvOptionError, match=rf"{name} ?="):
            task(**{name: refused})


@pytest.mark.parametrize(("task", "name", "most"), [(Waypoints, "count", 1000), (Among, "count", 1000),
                                                    (Gates, "laps", 100)])  # fmt: skip
def test_numbers_of_targets_have_both_limits(task: Any, name: str, most: int) -> None:
    given = {"gates": [Gate(1.0, 2.0, 3.0, 0.0)]} if task is Gates else {}
    for allowed in (1, most):
        task(**given, **{name: allowed})
    for refused in (0, most + 1, -1):
        with pytest.raises(EnvOptionError, match=rf"\({name}={refused}\); it must be 1 \.\. {most}$"):
            task(**given, **{name: refused})


@pytest.mark.parametrize(
    ("speed", "drawn"),
    [((1.0, 1.0), (1.0, 1.0)), ([0.25, 3.0], (0.25, 3.0)), (2, (2.0, 2.0)), (np.float32(0.5), (0.5, 0.5)),
     (np.int64(3), (3.0, 3.0)), (np.array([1.0, 2.0]), (1.0, 2.0))],
)  # fmt: skip
def test_a_trajectorys_speed_is_one_or_a_range(speed: Any, drawn: tuple[float, float]) -> None:
    assert Trajectory(speed=speed).speed == drawn


@pytest.mark.parametrize("offset", [(1.0,), (1.0, 2.0, 3.0), 2.0, (math.nan, 1.0), (1.0, math.inf), (-1.0, 1.0)])
def test_an_offset_is_two_distances(offset: Any) -> None:
    Hold(offset=(0.0, 1.5))
    with pytest.raises(EnvOptionError, match=r"Hold\(offset=.*it must be two numbers, 0 m or more"):
        Hold(offset=offset)


@pytest.mark.parametrize("speed", [(0.0, 1.0), (2.0, 1.0), (-1.0, 1.0), (1.0, 2.0, 3.0), (), (1.0, math.inf)])
def test_a_range_of_speeds_begins_above_zero_and_does_not_fall(speed: Any) -> None:
    with pytest.raises(EnvOptionError, match="they must be above 0"):
        Trajectory(speed=speed)


@pytest.mark.parametrize(
    "gate", [(1.0, 2.0, 3.0), (1.0, 2.0, 3.0, 0.0, 0.0), (1.0, 2.0, 3.0, 0.0, 2.0, 0.0), (1.0, 2.0, 3.0, 0.0, -1.0),
             (math.inf, 2.0, 3.0, 0.0), "gate"]
)  # fmt: skip
def test_a_gate_has_a_position_a_heading_and_a_size(gate: Any) -> None:
    with pytest.raises(EnvOptionError, match=r"it must be \(x, y, z, yaw\[, width, height\]\), one at least"):
        Gates([gate])


@pytest.mark.parametrize("bays", [[], [(1.0, 2.0)], [(1.0, 2.0, 3.0, 4.0)], (1.0, 2.0, 3.0),
                                  [(1.0, 2.0, 3.0), (1.0, math.nan, 0.0)], [(math.inf, 2.0, 3.0)]])  # fmt: skip
def test_a_bay_has_a_position_and_a_heading(bays: Any) -> None:
    with pytest.raises(EnvOptionError, match=r"it must be \(x, y, yaw\) \[m, rad\], one at least, finite numbers"):
        Park(bays)


@pytest.mark.parametrize("places", [[], [(1.0, 2.0)], (1.0, 2.0, 3.0), [(1.0, 2.0, 3.0), (math.nan, 0.0, 0.0)],
                                    [(1.0, 2.0, -math.inf)]])  # fmt: skip
def test_a_waypoint_has_three_numbers(places: Any) -> None:
    with pytest.raises(EnvOptionError, match=r"it must be one \(x, y, z\) \[m\] at least, finite numbers"):
        Waypoints(places=places)


@pytest.mark.parametrize("goal", [(1.0,), (1.0, 2.0, 3.0), (math.inf, 0.0), (0.0, math.nan)])
def test_a_goal_is_two_finite_numbers(goal: Any) -> None:
    with pytest.raises(EnvOptionError, match=r"it must be \(x, y\): two finite numbers"):
        ReachGoal(goal)
