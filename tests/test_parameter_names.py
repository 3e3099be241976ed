# SPDX-License-Identifier: BSD-3-Clause
"""A parameter that is misspelt is an error that names the one that may be meant, wherever it is given."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import gymnasium
import pytest

import sitl.envs  # noqa: F401 - registers the ids
from sitl.autopilot.params.parm_files import FileValues
from sitl.errors import SitlError
from sitl.fleet import Fleet
from sitl.missions.testing.setup import Defaults, setup
from sitl.scenario import Scenario
from sitl.simulation import Simulation
from sitl.swarm import Swarm

WRONG = {"WPNAV_SPED": 1.0}


@pytest.mark.parametrize(
    "make",
    [
        lambda: Simulation("erle_copter", params=WRONG),
        lambda: Fleet("erle_copter", 2, params=WRONG),
        lambda: Swarm("erle_copter", 2, params=WRONG),
        lambda: Simulation(Scenario.from_json(Scenario("erle_copter", params=WRONG).to_json())),
        lambda: gymnasium.make("sitl/CopterHover-v0", params=WRONG),
        lambda: gymnasium.make_vec("sitl/CopterHover-v0", num_envs=2, params=WRONG),
        lambda: setup(Defaults(), "copter", params=WRONG).build(),
    ],
)
def test_wherever_it_is_given(make: Callable[[], Any]) -> None:
    with pytest.raises(SitlError) as failure:
        make()
    assert str(failure.value) == "the copter has no parameters WPNAV_SPED (did you mean 'WPNAV_SPEED'?)"


@pytest.mark.parametrize(
    ("params", "why"),
    [
        ({"wpnav_speed": 100.0}, r"no parameters wpnav_speed \(did you mean 'WPNAV_SPEED'\?\)"),
        ({"RTL_ALTT": 1.0, "XQZ": 2.0}, r"no parameters RTL_ALTT \(did you mean 'RTL_ALT'\?\), XQZ$"),
        ({f"XQZ{k}": 1.0 for k in range(50)}, r"no parameters XQZ0, XQZ1, XQZ2, XQZ3, XQZ4, XQZ5, \.\.\.$"),
        ({3: 1.0}, "no parameters 3$"),
        ({"WPNAV_SPEED": math.nan}, "WPNAV_SPEED: nan is not a finite number"),
        ({"WPNAV_SPEED": math.inf}, "WPNAV_SPEED: inf is not a finite number"),
        ({"WPNAV_SPEED": 1e9}, r"WPNAV_SPEED: 1e\+09 is outside 10 \.\. 10000 cm/s"),
        ({"WPNAV_SPEED": "fast"}, "WPNAV_SPEED: 'fast' is not a number"),
        (3, "params = 3: values by name or a file of parameters are needed"),
    ],
)
def test_what_is_said(params: Any, why: str) -> None:
    with pytest.raises(SitlError, match=why):
        Simulation("erle_copter", params=params)


def test_names_in_files_are_passed_over() -> None:
    simulation = Simulation("erle_copter", params=FileValues({"WPNAV_SPED": 1.0, "WPNAV_SPEED": 500.0}))
    assert simulation.parameters["WPNAV_SPEED"] == 500.0
    simulation.close()
