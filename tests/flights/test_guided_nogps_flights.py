# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED_NOGPS: attitudes of a companion computer, also without a position."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler
from sitl.simulation import Core
from tests.flights.aviator import GUIDED_NOGPS, VELOCITY, Aviator


def lean(p: Aviator, seconds: float, roll: float, pitch: float, yaw: float, thrust: float) -> None:
    """SET_ATTITUDE_TARGET at 10 Hz [deg]."""
    q = tuple(quat_from_euler(Euler(*np.radians((roll, pitch, yaw)))))
    for _ in range(round(10 * seconds)):
        p.send("SET_ATTITUDE_TARGET", type_mask=0b111, q=q, thrust=thrust)
        p.fly(0.1)


def test_flies_attitudes_and_climb_rates_without_gps(core: Core) -> None:
    p = Aviator(core).ready()
    assert p.set_mode(GUIDED_NOGPS)
    p.arm()
    p.fly(2.0)
    assert p.on_ground, "it waits for an attitude"
    lean(p, 5.0, 0.0, 0.0, 0.0, 1.0)
    assert p.height > 5.0
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    lean(p, 4.0, 8.0, -5.0, 20.0, 0.5)
    assert p.euler == pytest.approx((8.0, -5.0, 20.0), abs=2.0)
    assert abs(p.vel[2]) < 0.3 and p.mode == GUIDED_NOGPS
    p.fly(5.0)
    assert np.abs(p.euler[:2]).max() < 1.5 and abs(p.vel[2]) < 0.3, "a stale attitude is level flight"


def test_takes_no_positions_and_velocities(core: Core) -> None:
    p = Aviator(core).hover(10.0)
    assert p.set_mode(GUIDED_NOGPS)
    p.stream(2.0, VELOCITY, vx=5.0)
    assert float(np.hypot(*p.vel[:2])) < 0.3
