# SPDX-License-Identifier: BSD-3-Clause
"""One made-up flight, played once for all tests that look at it."""

from __future__ import annotations

import pytest

from tests.autopilot.estimation import synthetic_flight as sf
from tests.autopilot.estimation.synthetic_flight import TAKE_OFF


@pytest.fixture(scope="session")
def truth() -> sf.Truth:
    return sf.fly(150.0, TAKE_OFF)


@pytest.fixture(scope="session")
def tick():
    return sf.updater()


@pytest.fixture(scope="session")
def flown(truth, tick):
    """[(fleet after the flight, outputs)] for a few seeds."""
    runs = []
    for seed in range(4):
        fleet = sf.new()
        runs.append((fleet, sf.play(sf.sense(truth, TAKE_OFF, seed), fleet, tick)))
    return runs


@pytest.fixture
def ap():
    """An autopilot record at power-on, with attribute access."""
    return sf.Copter.of(sf.new(), 0).autopilot
