# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE flown with a ground station's sticks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES, BRAKE, CIRCLE, Aviator
from tests.pilots.witness import MIDDLE


def circling(core: Core, frame: str, seconds: float, **params: float) -> tuple[Aviator, np.ndarray]:
    """A copter that has circled for some time with centred sticks, and the point 10 m ahead of where it began."""
    p = Aviator(core, frame, **params).hover(20.0)
    p.sticks(0.5)
    yaw = math.radians(p.euler[2])
    centre = p.pos[:2] + 10.0 * np.array((math.cos(yaw), math.sin(yaw)))
    assert p.set_mode(CIRCLE)
    p.sticks(seconds)
    return p, centre


def off_centre(p: Aviator, centre: np.ndarray) -> float:
    """Angle between the nose and the centre [deg]."""
    n, e = centre - p.pos[:2]
    return float((p.euler[2] - math.degrees(math.atan2(e, n)) + 180.0) % 360.0 - 180.0)


@pytest.mark.parametrize("frame", AIRFRAMES)
def test_it_circles_the_point_ahead_and_looks_at_it(core: Core, frame: str) -> None:
    p, centre = circling(core, frame, 12.0)
    start = p.now
    p.sticks(18.0)
    away = p.since(start)[:, 1:3] - centre
    radius = np.hypot(away[:, 0], away[:, 1])
    assert radius.min() > 9.0 and radius.max() < 10.2 and radius.mean() < 9.9, "behind its target: inside of the circle"
    speed = float(np.hypot(*p.vel[:2]))
    assert speed == pytest.approx(3.3, abs=0.15), "a real ArduPilot with these parameters: 3.3 m/s"
    assert abs(off_centre(p, centre)) < (6.5 if frame == "ardupilot_quad" else 5.0), "its heading is a degree off"
    turned = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    assert turned[-1] - turned[0] == pytest.approx(2.0 * math.pi, abs=0.2), "clockwise, 20 deg/s"
    assert abs(p.height - 20.0) < 0.7


def test_a_negative_rate_turns_the_other_way_and_the_nose_may_lead(core: Core) -> None:
    p, centre = circling(core, "erle_copter", 12.0, CIRCLE_RATE=-15.0, CIRCLE_OPTIONS=2.0)
    assert off_centre(p, centre) == pytest.approx(90.0, abs=6.0), "the centre is to the left"
    n, e = p.vel[:2]
    assert math.degrees(math.atan2(e, n)) % 360.0 == pytest.approx(p.euler[2] % 360.0, abs=8.0)


def test_around_where_it_is(core: Core) -> None:
    p = Aviator(core, CIRCLE_OPTIONS=4.0, CIRCLE_RADIUS=500.0).hover(15.0)
    centre = p.pos[:2]
    assert p.set_mode(CIRCLE)
    p.sticks(12.0, roll=2000, pitch=2000)
    away = p.pos[:2] - centre
    assert np.hypot(*away) == pytest.approx(5.0, abs=0.5), "and the sticks change nothing"


def test_sticks_change_radius_rate_height_and_heading(core: Core) -> None:
    p, centre = circling(core, "erle_copter", 4.0)
    p.sticks(2.0, pitch=2000, throttle=1900)
    assert p.ap.modes.circle.radius == pytest.approx(30.0, abs=0.5), "WPNAV_SPEED 10 m/s"
    p.sticks(12.0)
    assert np.hypot(*(p.pos[:2] - centre)) == pytest.approx(28.1, abs=1.0), "inside of the circle"
    assert p.height > 22.0
    p.sticks(5.0, roll=1000)
    limited = math.degrees(math.sqrt(0.5 * 2.5 * 30.0) / 30.0)
    assert math.degrees(p.ap.modes.circle.rate) == pytest.approx(limited - 5.0, abs=0.3)
    p.sticks(10.0, roll=1000)
    assert p.ap.modes.circle.rate == 0.0
    p.sticks(4.0)
    assert np.hypot(*p.vel[:2]) < 0.3
    p.sticks(8.0, roll=1000)
    assert math.degrees(p.ap.modes.circle.rate) == pytest.approx(-8.0, abs=0.3)
    p.sticks(2.0, yaw=1700)
    p.sticks(2.0)
    yaw = p.euler[2]
    p.sticks(4.0)
    assert p.euler[2] == pytest.approx(yaw, abs=1.5), "the heading is the pilot's from then on"


def test_it_is_no_mode_to_arm_in_and_can_be_left(core: Core) -> None:
    p, _ = circling(core, "erle_copter", 6.0)
    assert p.set_mode(BRAKE)
    p.fly(5.0)
    assert np.hypot(*p.vel[:2]) < 0.2
    ground = Aviator(core).ready()
    assert ground.set_mode(CIRCLE)
    ground.hold(throttle=MIDDLE)
    assert ground.ask(400, 1) == 4
    assert ground.said("not armable")
