# SPDX-License-Identifier: BSD-3-Clause
"""Random legal commands: finite, known modes, an estimate near the truth, and HOLD always stops (``rover_soak``)."""

from __future__ import annotations

import pytest

from sitl.simulation import Core
from tests.drives.rover_driver import AIRFRAMES
from tests.drives.rover_soak import RoverChaos, RoverSoak

ALL = pytest.mark.parametrize("frame", AIRFRAMES)


@pytest.mark.parametrize("kind", [RoverSoak, RoverChaos])
@pytest.mark.parametrize("frame", ["erle_rover", "skid_rover"])
def test_two_minutes(core: Core, frame: str, kind: type[RoverSoak]) -> None:
    kind(core, frame, 0).go(120.0)


@pytest.mark.slow
@ALL
@pytest.mark.parametrize("kind", [RoverSoak, RoverChaos])
def test_twenty_minutes(core: Core, frame: str, kind: type[RoverSoak]) -> None:
    kind(core, frame, 1000).go(1200.0)


@pytest.mark.slow
def test_a_soak_repeats_to_the_bit(core: Core) -> None:
    drives = []
    for _ in range(2):
        soak = RoverSoak(core, "erle_rover", 7)
        soak.go(120.0)
        drives.append(soak.simulation.fleet.tobytes())
    assert drives[0] == drives[1]
