# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures: a rover that was armed once, for many tests."""

from __future__ import annotations

import pytest

from tests.autopilot.rover.modes.driven_rover import DrivenRover, Rover


@pytest.fixture(scope="session")
def armed_once() -> tuple[Rover, DrivenRover]:
    """Armed, at its origin, heading north; and its record, to go on from."""
    made = Rover()
    made.run(1.1)
    made.arm()
    made.events()
    kept = DrivenRover()
    kept.assign(made.v)
    return made, kept


@pytest.fixture
def rover(armed_once: tuple[Rover, DrivenRover]) -> Rover:
    """The same for each test."""
    made, kept = armed_once
    made.v.assign(kept)
    made.heading = made.speed = 0.0
    made.heard = int(made.ap.events.count)
    return made
