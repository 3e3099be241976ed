# SPDX-License-Identifier: BSD-3-Clause
"""Plants that stand at power-on, and stand-ins for programs whose code is built before somebody waits for it."""

from __future__ import annotations

import pytest

from sitl.plants.json_link import LOCAL
from sitl.plants.local import stand_alone
from sitl.scenario import DEFAULT_HOME
from sitl.simulation import Simulation
from tests.foreign import arducopter_stand_in, px4_stand_in


@pytest.fixture
def copter_plant():
    plant = stand_alone("erle_copter", home=DEFAULT_HOME)
    yield plant
    plant.close()


@pytest.fixture
def rover_plant():
    plant = stand_alone("erle_rover", home=DEFAULT_HOME)
    yield plant
    plant.close()


def built(name: str) -> None:
    """Compile what the stand-in needs: the physics it asks is not there."""
    Simulation(arducopter_stand_in.FRAMES[name], physics=f"json:{LOCAL}:9").close()


@pytest.fixture
def arducopter(tmp_path):
    """A program."""
    built("arducopter")
    return arducopter_stand_in.install(tmp_path, "arducopter")


@pytest.fixture
def ardurover(tmp_path):
    built("ardurover")
    return arducopter_stand_in.install(tmp_path, "ardurover")


@pytest.fixture
def px4(tmp_path):
    return px4_stand_in.install(tmp_path)
