# SPDX-License-Identifier: BSD-3-Clause
"""POSHOLD flown with a ground station's sticks. Values of a real ArduPilot are of its default quadrotor."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import POSHOLD, Aviator
from tests.pilots.witness import LOW


def holding(core: Core, frame: str = "ardupilot_quad", **params: float) -> Aviator:
    """Holding at 15 m, nose north, with centred sticks."""
    p = Aviator(core, frame, **params).hover(15.0)
    p.sticks(0.5)
    assert p.set_mode(POSHOLD)
    p.sticks(3.0)
    return p


def speed(p: Aviator) -> float:
    """True horizontal speed [m/s]."""
    return float(np.hypot(*p.vel[:2]))


def test_sticks_lean_and_letting_go_stops_and_holds(core: Core) -> None:
    p = holding(core)
    p.sticks(5.0, pitch=1341)
    assert p.euler[1] == pytest.approx(-11.2, abs=0.5), "a real ArduPilot flies so for 5 s,"
    assert speed(p) == pytest.approx(4.3, abs=0.5), "reaches 4.3 m/s,"
    start, place = p.now, p.pos.copy()
    p.sticks(10.0)
    braking = p.since(start)
    assert braking[:, 8].max() == pytest.approx(10.2, abs=1.5), "leans back by 10.2 degrees"
    assert float(np.hypot(*(p.pos - place)[:2])) == pytest.approx(7.5, abs=1.2), "and stops in 7.5 m"
    place = p.pos.copy()
    p.sticks(5.0)
    assert float(np.hypot(*(p.pos - place)[:2])) < 0.2 and speed(p) < 0.1
    assert abs(p.height - 15.0) < 0.5


def test_a_slower_brake_needs_more_room(core: Core) -> None:
    p = holding(core, PHLD_BRAKE_RATE=4.0)
    p.sticks(5.0, pitch=1300)
    place = p.pos.copy()
    p.sticks(12.0)
    assert 9.0 < float(np.hypot(*(p.pos - place)[:2])) < 16.0 and speed(p) < 0.15


def test_the_lean_against_the_wind_stays_while_it_is_flown(core: Core) -> None:
    p = holding(core, SIM_WIND_SPD=6.0, SIM_WIND_DIR=0.0)
    p.sticks(12.0)
    lean, place = p.euler[1], p.pos.copy()
    assert lean < -5.0 and speed(p) < 0.2
    p.sticks(3.0, roll=1600)
    assert p.euler[1] == pytest.approx(lean, abs=3.0)
    assert abs(p.pos[0] - place[0]) < 1.0, "the wind does not blow it away meanwhile"
    p.sticks(8.0)
    assert speed(p) < 0.2


def test_takes_off_lands_and_turns(core: Core) -> None:
    p = Aviator(core, PILOT_TKOFF_ALT=300.0)
    p.boot()
    assert p.set_mode(POSHOLD)
    p.sticks(1.0, throttle=LOW)
    p.arm(3.0)
    assert p.on_ground
    p.sticks(0.7, throttle=1710)
    p.sticks(8.0)
    assert p.height == pytest.approx(3.0, abs=0.5)
    place, yaw = p.pos.copy(), p.euler[2]
    p.sticks(1.0, yaw=1700)
    p.sticks(3.0)
    assert abs(p.euler[2] - yaw) > 20.0 and float(np.hypot(*(p.pos - place)[:2])) < 0.3
    p.hold(throttle=LOW)
    assert p.fly(20.0, lambda: bool(p.ap.arming.landed))
    p.wait_disarmed(12.0)
