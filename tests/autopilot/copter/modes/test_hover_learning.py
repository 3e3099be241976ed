# SPDX-License-Identifier: BSD-3-Clause
"""When the throttle counts as that of hovering (MOT_THST_HOVER)."""

from __future__ import annotations

from typing import Any

import pytest

from sitl import vehicles
from sitl.autopilot.copter.modes.decisions import hovers
from sitl.vehicle.copter import apply_sim_parameters


@pytest.mark.parametrize(
    ("at_rest", "climb", "learns"),
    [(False, 0.005, True), (False, 0.02, False), (True, 0.005, False), (True, 1e-6, False), (True, 1e-8, True)],
)
def test_the_path_has_to_be_slow_or_to_stand_still(flying: Any, at_rest: bool, climb: float, learns: bool) -> None:
    """ArduPilot waits until the path's climb is 0: after a take-off to 20 m that is 5 s after the vehicle stopped."""
    control = flying.autopilot.control
    control.motors.throttle, control.motors.learns_at_rest = 0.4, at_rest
    for sign in (1.0, -1.0):
        control.pos_d.vel_desired = sign * climb
        assert hovers(control, 0.0) == learns


@pytest.mark.parametrize(("frame", "at_rest"), [("ardupilot_quad", True), ("erle_copter", False)])
def test_the_airframe_says_which(vehicle: Any, frame: str, at_rest: bool) -> None:
    vehicle.physics.airframe.learns_at_rest = vehicles.load(frame).value("learns_at_rest")
    apply_sim_parameters(vehicle)
    assert vehicle.autopilot.control.motors.learns_at_rest == at_rest
