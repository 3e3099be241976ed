# SPDX-License-Identifier: BSD-3-Clause
"""FOLLOW behind another vehicle, and the simulated wheel encoders."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.simulation import Core
from tests.drives.rover_driver import MANUAL, Driver

FOLLOW = 6


def lead(d: Driver, seconds: float, north: float, east: float, speed: float = 0.0) -> None:
    """Another vehicle drives north at a speed [m/s] from a place [m], and tells twice a second."""
    for k in range(round(2 * seconds)):
        lat, lon = d.lat_lon(north + 0.5 * k * speed, east)
        fields: dict[str, Any] = {"lat": lat, "lon": lon, "alt": 584_000, "hdg": 0, "vx": round(100 * speed)}
        d.send("GLOBAL_POSITION_INT", **fields)
        d.fly(0.5)


@pytest.mark.parametrize("frame", ["erle_rover_small", "skid_rover"])
def test_it_follows_another_vehicle(core: Core, frame: str) -> None:
    d = Driver(core, frame, FOLL_OFS_X=-2).armed_in()
    assert not d.set_mode(FOLLOW) and d.said("Set FOLL_ENABLE = 1")
    d.set_parameter("FOLL_ENABLE", 1)
    assert d.set_mode(FOLLOW)
    d.fly(2.0)
    assert d.stands()
    speed = 0.6 * d.cruise
    lead(d, 60.0, 4.0, 1.0, speed)
    assert d.speed == pytest.approx(speed, rel=0.2)
    behind = 4.0 + 59.5 * speed - d.place[0]
    assert 1.0 < behind < 2.0 + 2.5 / 0.1 * speed and abs(d.place[1] - 1.0) < 1.0
    d.fly(8.0)
    assert d.stands()  # the lead is silent


def test_simulated_encoders_tell_how_far_the_wheels_rolled(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", WENC_TYPE=10).armed_in(MANUAL)
    d.sticks(8.0, throttle=1600)
    found = d.message("WHEEL_DISTANCE")
    assert found.count == 1 and found.distance[0] == pytest.approx(float(np.hypot(*d.place)), rel=0.02)
    step = 2.0 * math.pi * 0.05 / 3200.0
    assert math.remainder(found.distance[0], step) == pytest.approx(0.0, abs=1e-6)
    second = Driver(core, "ardupilot_rover", WENC_TYPE=10, WENC2_TYPE=10).ready()
    assert second.message("WHEEL_DISTANCE").count == 2
