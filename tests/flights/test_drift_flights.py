# SPDX-License-Identifier: BSD-3-Clause
"""DRIFT flown with a ground station's sticks. Values are those of a real ArduPilot's default quadrotor."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import DRIFT, Aviator
from tests.pilots.witness import LOW

SOME_RIGHT, SOME_FORWARD = 1662, 1338
"""0.375 of the stick [us], as 1700 and 1300 were there."""


def drifting(core: Core, **params: float) -> Aviator:
    """In DRIFT at 20 m, nose north, sticks centred."""
    p = Aviator(core, "ardupilot_quad", **params).hover(20.0)
    p.sticks(0.5)
    assert p.set_mode(DRIFT)
    p.sticks(2.0)
    return p


def sideways(p: Aviator) -> float:
    """True speed to the right [m/s]."""
    yaw = math.radians(p.euler[2])
    return float(p.vel[1] * math.cos(yaw) - p.vel[0] * math.sin(yaw))


def test_the_pitch_stick_leans_and_letting_go_brakes(core: Core) -> None:
    p = drifting(core)
    p.sticks(6.0, pitch=1000)
    assert p.euler[1] == pytest.approx(-30.0, abs=1.0) and p.vel[0] == pytest.approx(10.2, abs=1.5)
    start, place = p.now, p.pos.copy()
    p.sticks(4.0)
    assert p.since(start)[:, 8].max() == pytest.approx(38.4, abs=6.0)
    assert p.pos[0] - place[0] == pytest.approx(10.0, abs=2.0), "a real one stops in 10.0 m"
    assert float(np.hypot(*p.vel[:2])) < 0.15


def test_the_roll_stick_turns_it_and_it_leans_against_the_slip(core: Core) -> None:
    p = drifting(core)
    p.sticks(4.0, pitch=SOME_FORWARD)
    start = p.now
    p.sticks(3.0, roll=SOME_RIGHT, pitch=SOME_FORWARD)
    turned = p.since(start)
    rate = (turned[-1, 9] - turned[-26, 9]) % 360.0 / (turned[-1, 0] - turned[-26, 0])
    assert rate == pytest.approx(46.0, abs=4.0), "deg/s"
    assert p.euler[0] == pytest.approx(11.6, abs=2.5)
    assert abs(sideways(p)) < 2.0, "it flies where the nose points"


def test_a_full_roll_stick_turns_it_on_the_spot(core: Core) -> None:
    p = drifting(core)
    place = p.pos.copy()
    p.sticks(3.0, roll=2000)
    before = p.euler[2]
    p.sticks(1.0, roll=2000)
    assert (p.euler[2] - before) % 360.0 == pytest.approx(137.0, abs=8.0)
    assert float(np.hypot(*(p.pos - place)[:2])) < 0.5


def test_the_yaw_stick_asks_for_a_speed_sideways(core: Core) -> None:
    p = drifting(core)
    yaw = p.euler[2]
    p.sticks(4.0, yaw=SOME_RIGHT)
    assert sideways(p) == pytest.approx(1.72, abs=0.25) and abs(p.euler[2] - yaw) < 1.5
    place = p.pos[1]
    p.sticks(3.0)
    assert p.pos[1] - place == pytest.approx(1.25, abs=0.4) and abs(sideways(p)) < 0.1


def test_the_throttle_is_assisted_around_its_middle(core: Core) -> None:
    p = drifting(core)
    p.sticks(4.0, throttle=1661)  # 0.69 of the stick, as 1700 was there
    assert -p.vel[2] == pytest.approx(1.47, abs=0.7), "a real one climbs at 1.47 m/s"
    p.sticks(3.0)
    assert abs(p.vel[2]) < 0.4


def test_a_closed_throttle_lands_it(core: Core) -> None:
    p = drifting(core)
    p.hold(throttle=1350)
    assert p.fly(40.0, lambda: p.height < 1.5)
    p.hold(throttle=1420)
    assert p.fly(20.0, lambda: p.on_ground)
    p.sticks(1.0, throttle=LOW)
    p.fly(15.0)
    assert p.on_ground and not p.ap.arming.armed
