# SPDX-License-Identifier: BSD-3-Clause
"""Airframes on a bench: which they are, and that only native physics has one."""

from __future__ import annotations

import pytest

from sitl import Simulation, vehicles
from sitl.physics.engine import EngineError


def test_names_can_leave_them_out() -> None:
    benches = set(vehicles.names()) - set(vehicles.names(on_bench=False))
    assert benches == {"calibration_copter", "calibration_rover"}
    assert "calibration_rover" in vehicles.names("rover") and "calibration_rover" not in vehicles.names(
        "rover", on_bench=False
    )


def test_other_engines_have_none() -> None:
    with pytest.raises(
        EngineError, match="physics 'pybullet' has no bench for airframe 'calibration_rover'; 'native' has"
    ):
        Simulation("calibration_rover", physics="pybullet")
