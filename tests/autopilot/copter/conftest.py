# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures: a vehicle that stands, and one that hovers."""

from __future__ import annotations

from typing import Any

import pytest

from tests.autopilot.copter.steady_copter import fly, make


@pytest.fixture
def vehicle() -> Any:
    """Disarmed and ready."""
    return make()


@pytest.fixture
def flying() -> Any:
    """Hovering in GUIDED at 10 m."""
    return fly(make())
