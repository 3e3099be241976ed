# SPDX-License-Identifier: BSD-3-Clause
"""Limits of GUIDED's set-points at their edges, and that leaving them sets none."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.command_results import CommandResult
from sitl.autopilot.copter.modes import guided, guided_setpoints
from sitl.autopilot.copter.modes.state import GuidedState
from sitl.core.vectors import Quat, Vec3


@pytest.mark.parametrize(("norm", "taken"), ((0.4, False), (0.51, True), (1.0, True), (1.99, True), (2.1, False)))
def test_a_quaternion_is_taken_when_its_norm_is_near_one(flying: Any, norm: float, taken: bool) -> None:
    half = norm * math.sqrt(0.5)
    code = guided_setpoints.set_attitude(flying, True, Quat(half, 0.0, 0.0, half), Vec3(0.0, 0.0, 0.0), 0.5)
    assert code == (CommandResult.OK if taken else CommandResult.OUT_OF_RANGE)


def test_cleared_limits_are_none() -> None:
    state = GuidedState()
    state.limit_us, state.limit_low, state.limit_high, state.limit_distance = 5, 1.0, 2.0, 3.0
    guided.clear_limits(state)
    assert (state.limit_us, state.limit_low, state.limit_high, state.limit_distance) == (0, 0.0, 0.0, 0.0)
    assert not guided.is_at_limit(state, 10**12, Vec3(1000.0, 0.0, -1000.0))
