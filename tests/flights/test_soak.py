# SPDX-License-Identifier: BSD-3-Clause
"""Random legal commands: finite, known modes, an estimate near the truth, and LAND always lands (see ``soak``)."""

from __future__ import annotations

import pytest

from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES
from tests.flights.soak import Chaos, Soak


@pytest.mark.parametrize("frame", AIRFRAMES)
@pytest.mark.parametrize("seed", range(3))
def test_ten_minutes(core: Core, frame: str, seed: int) -> None:
    soak = Soak(core, frame, seed)
    soak.go(600.0)
    assert soak.landings >= 4


@pytest.mark.parametrize("frame", AIRFRAMES)
@pytest.mark.parametrize("seed", range(3))
def test_ten_minutes_in_which_things_fail(core: Core, frame: str, seed: int) -> None:
    chaos = Chaos(core, frame, seed)
    chaos.go(600.0)
    assert chaos.landings >= 3


@pytest.mark.slow
@pytest.mark.parametrize("frame", AIRFRAMES)
def test_two_hours(core: Core, frame: str) -> None:
    soak = Soak(core, frame, 1000)
    soak.go(7200.0)
    assert soak.landings > 40


@pytest.mark.slow
def test_a_soak_repeats_to_the_bit(core: Core) -> None:
    flights = []
    for _ in range(2):
        soak = Soak(core, "erle_copter", 7)
        soak.go(300.0)
        flights.append(soak.simulation.fleet.tobytes())
    assert flights[0] == flights[1]
