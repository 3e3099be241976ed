# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles of environments wait in the worlds that their episodes have left; the layout of a page places the world."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sitl.client.connection import InProcess
from sitl.envs.options import EnvOptionError
from sitl.envs.page.page import EnvPage
from sitl.envs.robots.in_process import MAX_ELSEWHERE, InProcessVehicles


class Waiting(InProcess):
    """A link to a vehicle that does nothing."""

    def __init__(self) -> None:
        self.closed = 0

    def close(self) -> None:
        self.closed += 1


def world(k: int) -> Any:
    return SimpleNamespace(name=f"world {k}")


def in_worlds(robots: int = 1, gcs: Any = None) -> Any:
    vehicles: Any = InProcessVehicles.__new__(InProcessVehicles)
    vehicles._gcs, vehicles._elsewhere = gcs, {}
    vehicles.worlds, vehicles.links = [world(0)] * robots, [Waiting() for _ in range(robots)]
    return vehicles


def test_a_world_that_is_new_has_no_vehicle_yet_and_one_that_is_known_has_its_own() -> None:
    vehicles = in_worlds()
    first = vehicles.links[0]
    vehicles.enter(0, world(1))
    assert vehicles.links == [None] and vehicles.worlds[0].name == "world 1"
    vehicles.links[0] = second = Waiting()
    vehicles.enter(0, world(0))
    assert vehicles.links == [first]
    vehicles.enter(0, world(1))
    assert vehicles.links == [second] and first.closed == second.closed == 0


def test_each_robot_has_vehicles_of_its_own() -> None:
    vehicles = in_worlds(2)
    first, other = vehicles.links
    vehicles.enter(0, world(1))
    assert vehicles.links == [None, other] and [w.name for w in vehicles.worlds] == ["world 1", "world 0"]
    vehicles.enter(1, world(1))
    assert vehicles.links == [None, None]
    vehicles.enter(1, world(0))
    vehicles.enter(0, world(0))
    assert vehicles.links == [first, other]


def test_the_vehicle_that_has_waited_longest_is_given_up() -> None:
    vehicles = in_worlds()
    made = [vehicles.links[0]]
    for k in range(1, MAX_ELSEWHERE + 3):
        vehicles.enter(0, world(k))
        vehicles.links[0] = Waiting()
        made.append(vehicles.links[0])
        assert sum(link.closed for link in made) == max(k - MAX_ELSEWHERE, 0)
    assert MAX_ELSEWHERE == 8 and [link.closed for link in made] == [1, 1] + [0] * 9
    vehicles.enter(0, world(2))
    assert vehicles.links == [made[2]]
    vehicles.enter(0, world(1))
    assert vehicles.links == [None]


def test_a_world_without_a_vehicle_leaves_none_behind() -> None:
    vehicles = in_worlds()
    vehicles.links[0] = None
    vehicles.enter(0, world(1))
    assert vehicles._elsewhere == {}


def test_a_vehicle_that_a_ground_station_sees_stays() -> None:
    vehicles = in_worlds(gcs=object())
    with pytest.raises(EnvOptionError, match="world 'world 1': the vehicle that a ground station"):
        vehicles.enter(0, world(1))
    assert vehicles.worlds[0].name == "world 0"


@pytest.mark.parametrize("layout, copies", [("grid", 4), ("one world", None)])
def test_robots_of_one_world_have_it_once(layout: str, copies: int | None) -> None:
    page: Any = EnvPage.__new__(EnvPage)
    placed: list[Any] = []
    chosen: list[Any] = []
    page.env_source = SimpleNamespace(stage=SimpleNamespace(copies=4), layout="")
    page.scene = SimpleNamespace(place_world=placed.append)
    page.cameras = SimpleNamespace(view="above", choose=chosen.append)
    page._lay_out(layout)
    assert page.env_source.layout == layout and placed == [copies] and chosen == ["above"]
