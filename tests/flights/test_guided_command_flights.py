# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: commands on the way - pause, speed, heading, places - and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import (
    AIRFRAMES,
    GUIDED,
    LAND,
    LOITER,
    POSITION,
    POSITION_YAW,
    VELOCITY,
    Aviator,
    estimate,
    stream,
    target,
)

BOTH = pytest.mark.parametrize("frame", AIRFRAMES)
DENIED = 2


@BOTH
def test_pause_and_continue(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    target(p, POSITION, x=60.0, z=-10.0)
    p.fly(5.0)
    assert p.ask(193, 0) == 0
    p.fly(6.0)
    assert np.linalg.norm(p.vel) < 0.3
    assert p.pos[0] < 52.0
    assert p.ask(193, 1) == 0
    p.fly(15.0)
    assert estimate(p)[0] == pytest.approx(60.0, abs=0.4)


def test_speed_limit(core: Core) -> None:
    p = Aviator(core).hover()
    target(p, POSITION, z=-10.0)
    p.fly(0.1)
    assert p.ask(178, 1, 3) == 0
    start = p.now
    target(p, POSITION, x=30.0, z=-10.0)
    p.fly(15.0)
    assert np.linalg.norm(p.since(start)[:, 4:6], axis=1).max() == pytest.approx(3.0, abs=0.3)
    for speed in (0.0, -1.0, math.nan):
        assert p.ask(178, 1, speed) == DENIED


@pytest.mark.parametrize(
    ("params", "turned"),
    [
        ((90, 0, 1, 0), 90.0),
        ((0, 30, -1, 0), -360.0),
        ((45, 30, 1, 1), 45.0),
        ((45, 30, -1, 1), -45.0),
        ((350, 0, 0, 0), -10.0),
        ((350, 0, 1, 0), 350.0),
    ],
)
def test_condition_yaw(core: Core, params: tuple[float, ...], turned: float) -> None:
    """From heading 0 or a little more: counter-clockwise to 0 is then nearly no turn, clockwise a full circle."""
    p = Aviator(core, "ardupilot_quad").hover()
    target(p, POSITION_YAW, z=-10.0, yaw=-0.02 if turned == -360.0 else 0.0)
    p.fly(6.0)
    start = p.now
    if turned == -360.0:
        params = (358, 30, -1, 0)  # the heading target is 358.85: nearly nothing to the left
        turned = -0.9
    assert p.ask(115, *params) == 0
    p.fly(15.0)
    yaw = np.unwrap(np.radians(p.since(start)[:, 9]))
    assert math.degrees(yaw[-1] - yaw[0]) == pytest.approx(turned, abs=2.5)


def test_condition_yaw_to_where_it_is_turns_the_full_circle(core: Core) -> None:
    """Direction +1 and a heading target a little beyond, as recorded from ArduPilot."""
    p = Aviator(core, "ardupilot_quad").hover()
    target(p, POSITION_YAW, z=-10.0, yaw=0.02)
    p.fly(6.0)
    start = p.now
    p.ask(115, 0, 0, 1, 0)
    p.fly(15.0)
    yaw = np.unwrap(np.radians(p.since(start)[:, 9]))
    assert math.degrees(yaw[-1] - yaw[0]) == pytest.approx(359.0, abs=3.0)


@BOTH
def test_roi_keeps_the_nose_on_a_place(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    lat, lon = p.lat_lon(0.0, 20.0)
    p.send("COMMAND_INT", frame=6, command=195, x=lat, y=lon, z=0.0)
    p.fly(5.0)
    assert p.euler[2] == pytest.approx(90.0, abs=2.5)
    target(p, 0xDF8, x=20.0, y=20.0, z=-10.0)
    p.fly(15.0)
    assert p.ask(197) == 0


@BOTH
def test_reposition_changes_the_mode_only_when_told(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    p.sticks(0.5)
    p.set_mode(LOITER)
    lat, lon = p.lat_lon(-10.0, -10.0)
    place: dict[str, Any] = {"x": lat, "y": lon, "z": 15.0, "frame": 6, "command": 192, "param1": -1}
    p.send("COMMAND_INT", **place)
    p.sticks(2.0)
    assert p.mode == LOITER
    p.send("COMMAND_INT", param2=1, **place)
    p.sticks(15.0)
    assert p.mode == GUIDED
    assert estimate(p) == pytest.approx([-10.0, -10.0, -15.0], abs=0.4)


def test_a_copter_goes_at_its_own_speed_whatever_a_reposition_says(core: Core) -> None:
    p = Aviator(core).hover()
    p.simulation.parameters["WPNAV_SPEED"] = 300.0
    for north, speed in ((30.0, 2.0), (0.0, 5.0)):
        lat, lon = p.lat_lon(north, 0.0)
        place: dict[str, Any] = {"x": lat, "y": lon, "z": 10.0, "frame": 6, "command": 192, "param1": speed}
        start = p.now
        p.send("COMMAND_INT", **place)
        p.fly(20.0)
        assert np.linalg.norm(p.since(start)[:, 4:6], axis=1).max() == pytest.approx(3.0, abs=0.3)


@BOTH
def test_numbers_that_are_none_stop_the_vehicle(core: Core, frame: str) -> None:
    p = Aviator(core, frame).hover()
    here = p.pos
    for bad in ({"x": math.nan}, {"y": math.inf}, {"z": -math.inf}):
        target(p, POSITION, **{"z": -10.0, **bad})
        p.fly(1.0)
    stream(p, 2.0, VELOCITY, vx=math.nan, vy=3.0)
    p.fly(1.0)
    assert np.linalg.norm(p.pos - here) < 0.5


def test_take_off_edge_cases(core: Core) -> None:
    p = Aviator(core).ready()
    assert p.ask(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 10.0) == 4, "disarmed"
    target(p, POSITION, x=5.0, z=-5.0)
    p.arm()
    target(p, POSITION, x=5.0, z=-5.0)
    p.fly(3.0)
    assert p.on_ground, "a position does not lift off"
    p.take_off(0.7)
    assert p.height == pytest.approx(0.7, abs=0.3)
    assert p.ask(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 10.0) == 4, "in the air"
    p.set_mode(LAND)
    p.wait_disarmed(20.0)


def test_avoid_adsb_stops_and_holds_and_takes_no_set_points(core: Core) -> None:
    p = Aviator(core).hover(10.0)
    stream(p, 4.0, VELOCITY, vx=4.0)
    assert p.vel[0] > 3.0
    assert p.set_mode(19)
    p.fly(6.0)
    place = p.pos.copy()
    stream(p, 4.0, VELOCITY, vx=4.0)
    assert np.linalg.norm(p.pos - place) < 0.5 and p.mode == 19
