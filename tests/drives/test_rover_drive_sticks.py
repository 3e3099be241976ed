# SPDX-License-Identifier: BSD-3-Clause
"""MANUAL, ACRO, STEERING, SIMPLE and HOLD by sticks, judged by the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.simulation import Core
from tests.drives.rover_driver import ACRO, AIRFRAMES, HOLD, MANUAL, SIMPLE, STEERING, Driver

ALL = pytest.mark.parametrize("frame", AIRFRAMES)
TOP = {"erle_rover": 1.5875, "erle_rover_small": 0.3175, "ardupilot_rover": 20.0, "skid_rover": 2.0}
"""Speed at full stick on the flat [m/s]."""


def turned(d: Driver, since: float) -> float:
    """By how much the heading changed [deg], right positive."""
    return float(np.sum((np.diff(d.since(since)[:, 9]) + 180.0) % 360.0 - 180.0))


def share(d: Driver, pulse: int, channel: int) -> float:
    """-1 .. 1 that a pulse [us] of a centred channel stands for, with its travel and dead zone.

    The throttle stick (channel 3) counts in whole percent.
    """
    end = float(getattr(d.ap.params, f"RC{channel}_{'MAX' if pulse > 1500 else 'MIN'}"))
    dead = 30.0
    value = math.copysign((abs(pulse - 1500) - dead) / (abs(end - 1500.0) - dead), pulse - 1500)
    return math.trunc(100.0 * value) / 100.0 if channel == 3 else value


@ALL
@pytest.mark.parametrize("way", [1, -1])
def test_manual_at_full_stick(core: Core, frame: str, way: int) -> None:
    """Straight on, at the speed that the airframe is said to have."""
    d = Driver(core, frame).armed_in(MANUAL)
    heading = d.heading
    d.sticks(12.0, throttle=1500 + way * 500)
    assert d.speed == pytest.approx(way * TOP[frame], rel=0.01)
    assert d.heading == pytest.approx(heading, abs=0.1)


@ALL
@pytest.mark.parametrize(("steering", "side"), [(2000, 1), (1000, -1)])
@pytest.mark.parametrize("way", [1, -1])
def test_manual_circles(core: Core, frame: str, steering: int, side: int, way: int) -> None:
    """Full lock drives the tightest circle. Backing up, a car's tail goes to the stick's side; a skid rover's nose."""
    d = Driver(core, frame).armed_in(MANUAL)
    d.sticks(3.0, throttle=1500 + way * 100)
    start = d.now
    d.sticks(6.0, steering=steering, throttle=1500 + way * 100)
    rows = d.since(start + 3.0)
    rate = math.radians((rows[-1, 9] - rows[-2, 9] + 180.0) % 360.0 - 180.0) / (rows[-1, 0] - rows[-2, 0])
    assert math.copysign(1.0, rate) == side * (1 if d.is_skid or way > 0 else -1) * (way if d.is_skid else 1)
    if not d.is_skid:
        ahead = float(d.simulation.v.physics.airframe.rear_axle)
        size = math.hypot(d.vel[0], d.vel[1])
        expected = {"erle_rover": 2.0, "erle_rover_small": 0.4, "ardupilot_rover": 0.9}[frame]
        assert abs(size / rate) == pytest.approx(math.hypot(expected, ahead), rel=0.03)


def test_skid_steering_turns_on_the_spot(core: Core) -> None:
    d = Driver(core, "skid_rover").armed_in(MANUAL)
    place, start = d.place, d.now
    d.sticks(2.0, steering=1600)
    assert turned(d, start) > 90.0
    assert np.hypot(*(d.place - place)) < 0.01


@ALL
def test_released_sticks_let_it_roll_out(core: Core, frame: str) -> None:
    """MANUAL with centred sticks is what HOLD is: the motors' zero."""
    ways = []
    for mode in (MANUAL, HOLD):
        d = Driver(core, frame).armed_in(MANUAL)
        d.sticks(6.0, throttle=1600)
        d.hold()
        d.set_mode(mode)
        place = d.place
        d.wait_until_it_stands(60.0)
        ways.append(float(np.hypot(*(d.place - place))))
    assert ways[0] == pytest.approx(ways[1], rel=0.1)
    d.sticks(1.0, throttle=2000)
    assert d.stands(), "HOLD holds whatever the sticks do"


def test_disarmed_sticks_steer_but_do_not_drive(core: Core) -> None:
    d = Driver(core, "erle_rover").ready()
    d.set_mode(MANUAL)
    d.sticks(2.0, steering=1900, throttle=1900)
    assert d.stands()
    assert float(d.simulation.v.physics.wheels.angle) > 0.5


@ALL
@pytest.mark.parametrize("stick", [1700, 1350])
def test_acro_turns_at_the_stick_s_rate(core: Core, frame: str, stick: int) -> None:
    """A share of ACRO_TURN_RATE, here 30 degrees a second, and of the top speed."""
    d = Driver(core, frame, ACRO_TURN_RATE=30.0).armed_in(ACRO)
    throttle = 1600 if frame == "ardupilot_rover" else 1800
    d.sticks(6.0, throttle=throttle)
    straight, start = d.speed, d.now
    d.sticks(5.0, steering=stick, throttle=throttle)
    assert turned(d, start + 1.0) == pytest.approx(4.0 * 30.0 * share(d, stick, 1), rel=0.1)
    assert d.speed == pytest.approx(straight, rel=0.1)
    top = float(d.ap.params.CRUISE_SPEED) / (0.01 * float(d.ap.params.CRUISE_THROTTLE))
    assert straight == pytest.approx(top * share(d, throttle, 3), rel=0.06, abs=0.03)


@ALL
def test_steering_mode_backwards_and_forwards(core: Core, frame: str) -> None:
    """The stick is the side to which the path bends: right backwards turns the nose left."""
    d = Driver(core, frame).armed_in(STEERING)
    sign = []
    for throttle in (1650, 1350):
        d.sticks(4.0, throttle=throttle)
        start = d.now
        d.sticks(3.0, steering=1600, throttle=throttle)
        sign.append(math.copysign(1.0, turned(d, start + 1.0)))
        d.sticks(5.0)
        assert abs(d.speed) < 0.05 * TOP[frame]
    assert sign == [1.0, -1.0]


@ALL
@pytest.mark.parametrize("kind", [0, 1])
def test_simple_drives_where_the_stick_points(core: Core, frame: str, kind: int) -> None:
    """Seen from the heading when armed (0), or from north (1)."""
    d = Driver(core, frame, SIMPLE_TYPE=kind).armed_in(SIMPLE)
    first = d.heading if kind == 0 else 0.0
    for steering, throttle, direction in ((1500, 1700, 0.0), (1700, 1700, 45.0), (1700, 1500, 90.0)):
        d.sticks(10.0, steering=steering, throttle=throttle)
        course = math.degrees(math.atan2(d.vel[1], d.vel[0]))
        assert (course - first - direction + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=6.0)
        assert d.speed > 0.2 * TOP[frame]
    d.sticks(1.0)
    held = d.heading
    d.wait_until_it_stands()
    assert d.heading == pytest.approx(held, abs=10.0), "the last heading stays"
