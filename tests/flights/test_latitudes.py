# SPDX-License-Identifier: BSD-3-Clause
"""Positions at all latitudes: ArduPilot's simulator uses GPS 41.5 s after boot at each of them, at the poles, too."""

from __future__ import annotations

import pytest

from sitl.client import Client
from sitl.simulation import Core, Simulation


@pytest.mark.parametrize("lat", [-90.0, -60.0, 60.0, 75.0, 85.0, 89.9, 90.0])
def test_a_position_in_time(core: Core, lat: float) -> None:
    client = Client(Simulation("erle_copter", core=core, seed=1, home=(lat, 10.0, 100.0, 0.0)))
    client.wait_ready(50.0)
    assert any(text.text == "EKF3 IMU0 is using GPS" and text.time < 42.5 for text in client.texts)
    assert client.location[:2] == pytest.approx((lat, 10.0), abs=1e-2)
    client.close()


@pytest.mark.parametrize("lat", [75.0, 89.0])
def test_a_flight_in_the_far_north(core: Core, lat: float) -> None:
    client = Client(Simulation("erle_copter", core=core, seed=1, home=(lat, 10.0, 100.0, 0.0)))
    client.wait_ready(50.0)
    client.take_off(10)
    client.goto(20.0, 10.0)
    client.goto(0.0, 0.0)
    true = client.simulation.v.physics.body.pos
    assert (true.x, true.y) == pytest.approx((0.0, 0.0), abs=3.0)
    client.close()
