# SPDX-License-Identifier: BSD-3-Clause
"""One description of a simulation: what is refused, and its way through JSON."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import Any

import pytest

from sitl import vehicles
from sitl.errors import OptionError
from sitl.scenario import DEFAULT_HOME, Options, Scenario
from sitl.simulation import Core, Simulation
from sitl.vehicles import AirframeError


def test_its_options_as_keywords_are_its_fields() -> None:
    assert [f.name for f in fields(Scenario)] == ["frame", *Options.__annotations__]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"estimator": "gps"}, "estimator 'gps' is not known; it is one of ekf, truth"),
        ({"home": (1.0, 2.0)}, r"home \(1.0, 2.0\) is not \(latitude, longitude, altitude, heading\)"),
        ({"home": (91.0, 0.0, 0.0, 0.0)}, "latitude is within"),
        ({"home": (0.0, 0.0, 45000.0, 0.0)}, "altitude is within -2000 to 11000 m above mean sea level"),
        ({"home": (0.0, 0.0, -2001.0, 0.0)}, "altitude is within -2000 to 11000 m above mean sea level"),
        ({"seed": 1.5}, "seed 1.5 is not a whole number"),
        ({"sed": 1}, "option 'sed' is none of frame, home, seed, .*; did you mean 'seed'"),
    ],
)
def test_what_cannot_be_taken_is_named(options: dict[str, Any], message: str) -> None:
    with pytest.raises(OptionError, match=message):
        Scenario.of("erle_copter", **options)
    with pytest.raises(OptionError, match=message):
        Simulation("erle_copter", **options)


@pytest.mark.parametrize("altitude", [-2000.0, 11000.0])
def test_home_may_be_as_low_and_as_high_as_the_air_is_modelled(altitude: float) -> None:
    assert Scenario(home=(0.0, 0.0, altitude, 0.0)).home == (0.0, 0.0, altitude, 0.0)


def test_airframe_and_start_are_refused_when_they_are_looked_up() -> None:
    with pytest.raises(AirframeError, match="airframe 'glider' is not known"):
        Scenario("glider").airframe  # noqa: B018
    with pytest.raises(OptionError, match="start 'north' needs a world"):
        Scenario(start="north").load_world()


def test_a_simulation_is_made_of_one_or_of_its_fields(core: Core) -> None:
    scenario = Scenario("erle_copter", seed=4, home=(10.0, 20.0, 30.0, 40.0))
    one = Simulation(scenario, core=core)
    other = Simulation("erle_copter", seed=4, home=(10.0, 20.0, 30.0, 40.0), core=core)
    third = Simulation(scenario, seed=5, core=core)
    assert one.scenario is scenario and third.seed == 5
    records = [bytes(simulation.snapshot().record) for simulation in (one, other, third)]
    assert records[0] == records[1] != records[2]


@pytest.mark.parametrize(
    "scenario",
    [
        Scenario(),
        Scenario("skid_rover", (1.0, 2.0, 3.0, 4.0), 7, "truth", {"WP_SPEED": 2.0}, physics="jsbsim"),
        Scenario("erle_rover", world="maze_erlerover", start=[0.0, 1.0, 0.0, 90.0]),
        Scenario(vehicles.load("erle_copter").changed(mass=1.5)),
    ],
)
def test_it_comes_back_from_json(scenario: Scenario) -> None:
    data = json.loads(json.dumps(scenario.to_json()))
    again = Scenario.from_json(data)
    assert again.to_json() == scenario.to_json()
    assert again.home == (scenario.home or DEFAULT_HOME)
    assert again.airframe.record().tobytes() == scenario.airframe.record().tobytes()


def test_what_is_given_stands_over_json() -> None:
    data = Scenario("erle_rover", physics="pybullet").to_json()
    again = Scenario.from_json(data, frame="skid_rover", physics="native", world=None)
    assert again.frame == "skid_rover" and again.physics == "native"


def test_json_of_a_world_made_by_a_program_needs_the_world_again() -> None:
    data = {**Scenario().to_json(), "world": {"file": None, "name": "mine"}}
    with pytest.raises(OptionError, match="world 'mine' was made by a program"):
        Scenario.from_json(data)
