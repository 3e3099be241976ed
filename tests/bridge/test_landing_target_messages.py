# SPDX-License-Identifier: BSD-3-Clause
"""What a companion computer tells of a landing target."""

from __future__ import annotations

import math

import pytest

from sitl import Simulation
from sitl.bridge.services.landing_target import LandingTargetMessage, landing_target
from sitl.core.mavlink import MavFrame
from sitl.simulation import Core


def test_directions_that_are_no_numbers_are_passed_over(core: Core) -> None:
    v = Simulation("ardupilot_quad", params={"PLND_ENABLED": 1, "PLND_TYPE": 1}, core=core).v
    m = LandingTargetMessage()
    m.frame, m.distance = MavFrame.BODY_FRD, 5.0
    for m.angle_x, m.angle_y in ((math.inf, 0.1), (0.1, -math.inf), (math.nan, 0.1), (0.1, 1.6), (-3.0, 0.0)):
        landing_target(m, v, 1)
        assert v.autopilot.landing_target.distance == 0.0
    m.angle_x, m.angle_y = 0.1, -0.2
    landing_target(m, v, 1)
    seen = v.autopilot.landing_target
    assert seen.distance == 5.0 and seen.line.x / seen.line.z == pytest.approx(math.tan(0.2), rel=1e-6)
