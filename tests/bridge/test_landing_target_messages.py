# SPDX-License-Identifier: BSD-3-Clause
"""What a companion computer tells of a landing target."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl import Simulation
from sitl.autopilot.landing_target.state import LEVEL_SENSOR, SENSOR
from sitl.bridge.services.landing_target import LandingTargetMessage, landing_target
from sitl.core.mavlink import MavFrame
from sitl.simulation import Core
from tests.bridge.fakes import Bench, filled


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


def _told(v: Any, **fields: Any) -> Any:
    """What the vehicle makes of a message about a target."""
    landing_target(filled(LandingTargetMessage, **{"frame": MavFrame.BODY_FRD, "angle_x": 0.1, **fields}), v, 1)
    return v.autopilot.landing_target


@pytest.mark.parametrize(
    ("enabled", "kind", "is_taken"), [(1.0, 1.0, True), (0.0, 1.0, False), (1.0, 0.0, False), (1.0, 2.0, False)]
)
def test_targets_are_taken_with_precision_landing_by_messages(
    bench: Bench, enabled: float, kind: float, is_taken: bool
) -> None:
    v = bench.vehicle.v
    v.time_us = 5_000_000
    v.autopilot.params.PLND.ENABLED, v.autopilot.params.PLND.TYPE = enabled, kind
    assert (_told(v).line_us == 5_000_000) == is_taken


def test_frames_of_targets_and_one_text_about_others(bench: Bench) -> None:
    """By angles from the vehicle or from its level, or by a position; of another frame is said once that it is not."""
    v = bench.vehicle.v
    v.autopilot.params.PLND.ENABLED = v.autopilot.params.PLND.TYPE = 1.0
    v.autopilot.events.count = 0
    assert _told(v, frame=MavFrame.LOCAL_FRD).frame == LEVEL_SENSOR
    assert _told(v).frame == SENSOR
    t = _told(v, position_valid=1, x=0.0, y=3.0, z=4.0, distance=5.0)
    assert tuple(t.line) == pytest.approx((0.0, 0.6, 0.8)) and t.distance == 5.0
    assert v.autopilot.events.count == 0
    for frame in (MavFrame.LOCAL_NED, MavFrame.BODY_NED):
        assert tuple(_told(v, frame=frame).line) == pytest.approx((0.0, 0.6, 0.8))
    assert v.autopilot.events.count == 1, "said once"
