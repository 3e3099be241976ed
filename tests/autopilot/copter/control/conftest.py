# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures of the controllers' tests."""

from __future__ import annotations

from typing import Any

import pytest

from tests.autopilot.copter.control.level_autopilot import make_actuators, make_autopilot


@pytest.fixture
def ap() -> Any:
    """One autopilot, level at the origin, disarmed."""
    return make_autopilot()


@pytest.fixture
def actuators() -> Any:
    """An actuators record."""
    return make_actuators()
