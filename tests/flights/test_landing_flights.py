# SPDX-License-Identifier: BSD-3-Clause
"""BRAKE, LAND and RTL."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM, VELOCITY_ONLY
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES, BRAKE, GUIDED, LAND, LOITER, RTL, Aviator, Item

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)
FAILED = 4


@BOTH
def test_brake_stops_and_holds(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    p.stream_setpoint(6.0, VELOCITY_ONLY, (6.0, 0.0, 0.0))
    here, start = p.pos, p.now
    assert p.set_mode(BRAKE)
    p.fly(6.0)
    assert np.linalg.norm(p.vel) < 0.2
    assert 4.0 < p.pos[0] - here[0] < 13.0
    assert np.ptp(p.since(start)[:, 3]) < 0.3
    here = p.pos
    p.fly(5.0)
    assert np.linalg.norm(p.pos - here) < 0.6


@BOTH
def test_land_touches_gently_and_disarms_many_times(core: Core, frame: str) -> None:
    p = Aviator(core, frame).ready()
    for cycle in range(6):
        assert p.set_mode(GUIDED)
        p.arm()
        p.take_off(3.0 + cycle)
        here, start = p.pos, p.now
        assert p.set_mode(LAND)
        p.wait_disarmed(40.0)
        rows = p.since(start)
        touch = rows[np.argmax(rows[:, 3] > -0.01)]
        assert rows[-60:, 6].max() < 0.7
        assert p.now - touch[0] < 3.5, "disarmed soon after touching"
        assert np.linalg.norm(p.pos[:2] - here[:2]) < 0.8
        p.fly(1.0)


@BOTH
@pytest.mark.parametrize("mode", [LAND, RTL])
@pytest.mark.parametrize("wind", [8.0, 12.0])
def test_landing_in_strong_wind_disarms(core: Core, frame: str, mode: int, wind: float) -> None:
    """With ANGLE_MAX 45 deg: on the ground the controller still asks for 30 degrees of lean and more."""
    p = Aviator(core, frame, SIM_WIND_SPD=wind, SIM_WIND_TURB=wind / 6, ANGLE_MAX=4500).hover()
    assert p.set_mode(mode)
    p.wait_disarmed(60.0)
    assert np.linalg.norm(p.pos[:2]) < 4.0


def test_land_at_speed_stops_over_ground_first(core: Core) -> None:
    p = Aviator(core).hover()
    p.stream_setpoint(6.0, VELOCITY_ONLY, (8.0, 0.0, 0.0))
    here = p.pos
    p.set_mode(LAND)
    p.fly(8.0)
    assert np.linalg.norm(p.vel[:2]) < 0.3
    assert p.pos[0] - here[0] < 20.0
    p.wait_disarmed(40.0)


def test_the_pilot_moves_the_landing_place(core: Core) -> None:
    p = Aviator(core).hover(15.0)
    p.sticks(0.5)
    p.set_mode(LAND)
    p.sticks(1.0)
    here = p.pos
    p.sticks(6.0, pitch=1200)
    assert 2.0 < np.linalg.norm(p.pos[:2] - here[:2]) < 8.0
    p.hold()
    p.wait_disarmed(60.0)


@pytest.mark.parametrize("mode", [RTL, LAND, BRAKE])
def test_modes_that_cannot_be_armed(core: Core, mode: int) -> None:
    p = Aviator(core).ready()
    p.set_mode(mode)
    assert p.ask(ARM, 1) == FAILED
    assert p.said("mode not armable")


def test_disarming_in_the_air_needs_force(core: Core) -> None:
    p = Aviator(core).hover(5.0)
    assert p.disarm_result() == FAILED
    p.fly(1.0)
    assert p.armed
    assert p.ask(ARM, 0, 21196.0) == 0
    p.fly(3.0)
    assert not p.armed
    assert p.on_ground


@BOTH
@pytest.mark.parametrize(
    ("params", "height", "away", "top"),
    [
        ({}, 10.0, 30.0, 15.0),
        ({"RTL_ALT": 0}, 10.0, 30.0, 10.0),  # was refused as out of range
        ({"RTL_ALT": 3000}, 10.0, 30.0, 30.0),
        ({"RTL_ALT": 500}, 20.0, 30.0, 20.0),
        ({"RTL_CONE_SLOPE": 1}, 10.0, 8.0, 10.0),
        ({"RTL_CONE_SLOPE": 0}, 10.0, 8.0, 15.0),
        ({"RTL_CLIMB_MIN": 1000}, 10.0, 30.0, 20.0),
    ],
)
def test_rtl_height(core: Core, frame: str, params: dict, height: float, away: float, top: float) -> None:
    p = Aviator(core, frame, **params).hover(height)
    p.setpoint(0xDF8, position=(away, 0.0, -height))
    p.fly(15.0)
    start = p.now
    assert p.set_mode(RTL)
    p.wait_disarmed(100.0)
    assert -p.since(start)[:, 3].min() == pytest.approx(top, abs=0.6)
    assert np.linalg.norm(p.pos[:2]) < 1.2


def test_rtl_waits_over_home(core: Core) -> None:
    times = []
    for wait in (0, 5000):
        p = Aviator(core, "ardupilot_quad", RTL_LOIT_TIME=wait).hover()
        p.set_mode(RTL)
        start = p.now
        assert p.fly(80.0, lambda p=p: p.height < 1.0)
        times.append(p.now - start)
    assert times[1] - times[0] == pytest.approx(5.0, abs=0.3)


def test_rtl_stays_at_its_final_height(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", RTL_ALT_FINAL=500).hover()
    p.set_mode(RTL)
    p.fly(60.0)
    assert p.armed
    assert p.height == pytest.approx(5.0, abs=0.2)


def test_rtl_speed(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad", RTL_SPEED=200).hover()
    p.setpoint(0xDF8, position=(30.0, 0.0, -10.0))
    p.fly(15.0)
    start = p.now
    p.set_mode(RTL)
    p.fly(25.0)
    assert np.linalg.norm(p.since(start)[:, 4:6], axis=1).max() == pytest.approx(2.0, abs=0.15)


def test_rtl_goes_to_the_home_that_was_set(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").hover()
    lat, lon = p.lat_lon(25.0, 0.0)
    p.send("COMMAND_INT", frame=0, command=179, x=lat, y=lon, z=584.0)
    p.fly(0.5)
    p.set_mode(RTL)
    p.wait_disarmed(80.0)
    assert p.pos[:2] == pytest.approx([25.0, 0.0], abs=0.5)


@pytest.mark.parametrize("mode", [RTL, LAND, BRAKE])
def test_armed_on_the_ground_such_modes_end_disarmed(core: Core, mode: int) -> None:
    p = Aviator(core).ready()
    p.arm(3.0)
    assert p.set_mode(mode)
    p.wait_disarmed(12.0)
    assert p.on_ground


def test_loiter_can_follow_a_landing_that_was_broken_off(core: Core) -> None:
    p = Aviator(core).hover()
    p.hold()
    p.fly(0.5)
    p.set_mode(LAND)
    p.fly(6.0)
    assert p.set_mode(LOITER)
    p.sticks(3.0)
    height = p.height
    p.sticks(5.0)
    assert p.height == pytest.approx(height, abs=0.3)


def test_a_mission_may_be_loaded_while_landing(core: Core) -> None:
    p = Aviator(core).hover()
    p.set_mode(LAND)
    assert p.upload(Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0), 10.0)) == 0
    p.wait_disarmed(40.0)
