# SPDX-License-Identifier: BSD-3-Clause
"""STABILIZE, ALT_HOLD and LOITER flown with a ground station's sticks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM, FlightError
from sitl.physics.native import truth
from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES, ALT_HOLD, GUIDED, LOITER, STABILIZE, Aviator
from tests.pilots.witness import LOW

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)


def turn_rate(p: Aviator) -> float:
    """True yaw rate [deg/s]."""
    return float(np.degrees(truth.read(p.simulation.v).rates[2]))


def with_sticks(core: Core, frame: str, mode: int, **params: float) -> Aviator:
    """Booted, in ``mode``, throttle closed."""
    p = Aviator(core, frame, **params)
    p.boot()
    assert p.set_mode(mode)
    p.sticks(1.0, throttle=LOW)
    return p


def hover(core: Core, frame: str, mode: int, height: float = 15.0, **params: float) -> Aviator:
    """Hovering in ``mode`` with centred sticks."""
    p = Aviator(core, frame, **params).hover(height)
    p.sticks(0.5)
    assert p.set_mode(mode)
    p.sticks(4.0)
    return p


@BOTH
@pytest.mark.parametrize("mode", [ALT_HOLD, LOITER])
def test_take_off_and_land_by_throttle(core: Core, frame: str, mode: int) -> None:
    p = with_sticks(core, frame, mode)
    p.arm(3.0)
    assert p.on_ground
    p.sticks(6.0, throttle=1700)
    assert 3.0 < p.height < 5.0
    p.sticks(3.0)
    assert abs(p.vel[2]) < 0.1, "centred throttle holds the height"
    p.hold(throttle=LOW)
    assert p.fly(20.0, lambda: bool(p.ap.arming.landed))
    p.wait_disarmed(12.0)


@BOTH
def test_stabilize_flies_by_throttle_and_lean(core: Core, frame: str) -> None:
    p = with_sticks(core, frame, STABILIZE)
    p.arm(3.0)
    p.sticks(2.0, throttle=1600)
    assert p.height > 2.0
    for axis, name in ((0, "roll"), (1, "pitch")):
        for pulse, lean in ((1900, 30.0), (1100, -30.0), (1700, 14.2)):
            p.sticks(1.5, throttle=1550, **{name: pulse})
            assert math.degrees(p.ap.estimate.euler[axis]) == pytest.approx(lean, abs=1.0)
        p.sticks(1.0, throttle=1550)
        assert abs(p.euler[axis]) < 1.0


@BOTH
def test_throttle_stick_is_a_climb_rate(core: Core, frame: str) -> None:
    p = hover(core, frame, ALT_HOLD, 30.0)
    for pulse, climb in ((2000, 2.5), (1000, -2.5), (1540, 0.0)):
        p.sticks(4.0, throttle=pulse)
        assert -p.vel[2] == pytest.approx(climb, abs=0.2)
    p.set_parameter("PILOT_SPEED_UP", 400)
    p.set_parameter("PILOT_SPEED_DN", 100)
    p.sticks(4.0, throttle=2000)
    assert -p.vel[2] == pytest.approx(4.0, abs=0.2)
    p.sticks(6.0, throttle=1000)
    assert p.vel[2] == pytest.approx(1.0, abs=0.2)


@BOTH
def test_alt_hold_keeps_height_through_leaning_and_turning(core: Core, frame: str) -> None:
    p = hover(core, frame, ALT_HOLD)
    start = p.now
    p.sticks(4.0, roll=1900)
    p.sticks(4.0, pitch=1100, yaw=1800)
    p.sticks(4.0)
    assert np.ptp(p.since(start)[:, 3]) < 0.6


@BOTH
def test_yaw_stick_turns_and_its_release_holds(core: Core, frame: str) -> None:
    p = hover(core, frame, LOITER)
    p.sticks(4.0, yaw=1600)
    assert turn_rate(p) == pytest.approx(202.5 * 80 / 380, abs=3.0)
    p.sticks(3.0)
    heading = p.euler[2]
    p.sticks(4.0)
    assert abs(turn_rate(p)) < 2.0
    assert p.euler[2] == pytest.approx(heading, abs=1.5)


@BOTH
def test_loiter_flies_fast_and_brakes(core: Core, frame: str) -> None:
    p = hover(core, frame, LOITER)
    p.sticks(8.0, pitch=1000)
    assert np.linalg.norm(p.vel[:2]) > 7.0
    release, here = p.now, p.pos
    p.sticks(7.0)
    assert np.linalg.norm(p.vel) < 0.2
    assert np.linalg.norm(p.pos - here) < 30.0
    assert np.abs(p.since(release)[:, 7:9]).max() < 31.0
    here = p.pos
    p.sticks(10.0)
    assert np.linalg.norm(p.pos - here) < 0.6


@BOTH
def test_loiter_holds_in_gusty_wind(core: Core, frame: str) -> None:
    p = hover(core, frame, LOITER, SIM_WIND_SPD=5, SIM_WIND_TURB=1)
    p.sticks(20.0)
    start = p.now
    p.sticks(60.0)
    assert np.ptp(p.since(start)[:, 1:4], axis=0).max() < 1.0


@BOTH
def test_loiter_landing_in_strong_wind_is_noticed(core: Core, frame: str) -> None:
    """On the ground the position controller still leans against the wind."""
    p = hover(core, frame, LOITER, 8.0, SIM_WIND_SPD=10, SIM_WIND_TURB=2, ANGLE_MAX=4500)
    p.hold(throttle=LOW)
    p.wait_disarmed(30.0)


def test_overrides_run_out_and_the_receiver_takes_over(core: Core) -> None:
    p = hover(core, "erle_copter", ALT_HOLD, 30.0)
    p.let_go()
    p.fly(2.8)
    assert int(p.ap.rc.channels[2]) == 1500
    p.fly(0.4)
    assert int(p.ap.rc.channels[2]) == LOW, "the transmitter's throttle is closed"
    p.fly(2.0)
    assert p.vel[2] > 1.0


def test_manual_control_is_sticks_too(core: Core) -> None:
    p = hover(core, "erle_copter", LOITER)
    p.let_go()
    heading = np.radians(p.euler[2])
    for _ in range(50):
        p.send("MANUAL_CONTROL", target=1, x=500, y=0, z=500, r=0, buttons=0)
        p.fly(0.1)
    forward = p.vel[:2] @ [np.cos(heading), np.sin(heading)]
    assert forward > 2.0
    for _ in range(40):
        p.send("MANUAL_CONTROL", target=1, x=0, y=0, z=1000, r=500, buttons=0)
        p.fly(0.1)
    assert -p.vel[2] == pytest.approx(2.5, abs=0.2)
    assert turn_rate(p) > 60.0


def test_rudder_arms_after_two_seconds_and_not_in_guided(core: Core) -> None:
    p = with_sticks(core, "erle_copter", ALT_HOLD)
    p.sticks(1.8, throttle=LOW, yaw=2000)
    assert not p.armed
    p.sticks(1.5, throttle=LOW, yaw=2000)
    assert p.armed
    p.sticks(1.0, throttle=LOW)
    p.sticks(3.2, throttle=LOW, yaw=1000)
    assert not p.armed
    p = with_sticks(core, "erle_copter", GUIDED)
    p.sticks(4.0, throttle=LOW, yaw=2000)
    assert not p.armed
    assert p.said("GUIDED mode not armable")


def test_rudder_does_not_disarm_in_the_air(core: Core) -> None:
    p = hover(core, "erle_copter", ALT_HOLD, 30.0)
    p.sticks(4.0, throttle=LOW, yaw=1000)
    assert not p.on_ground
    assert p.armed


def test_raised_throttle_refuses_arming(core: Core) -> None:
    p = with_sticks(core, "erle_copter", STABILIZE)
    p.hold(throttle=1500)
    p.fly(0.5)
    with pytest.raises(FlightError, match="Throttle too high"):
        p.arm()


def test_mode_switch(core: Core) -> None:
    p = hover(core, "erle_copter", LOITER, FLTMODE1=ALT_HOLD, FLTMODE4=GUIDED)
    for pulse, mode in ((1100, ALT_HOLD), (1550, GUIDED), (1100, ALT_HOLD)):
        p._pulses = (1500, 1500, 1500, 1500, pulse)
        p.fly(0.5)
        assert p.mode == mode
    p.set_mode(LOITER)
    p.fly(1.0)
    assert p.mode == LOITER, "a switch that did not move changes nothing"


def test_idle_vehicle_disarms_after_ten_seconds(core: Core) -> None:
    p = with_sticks(core, "erle_copter", STABILIZE)
    p.arm(2.0)
    start = p.now
    p.wait_disarmed(12.0)
    assert p.now - start + 2.0 == pytest.approx(10.0, abs=1.2)
    p.set_parameter("DISARM_DELAY", 0)
    p.arm(20.0)
    assert p.armed
    assert p.ask(ARM, 0) == 0
