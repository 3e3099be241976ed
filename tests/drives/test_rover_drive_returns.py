# SPDX-License-Identifier: BSD-3-Clause
"""RTL, SMART_RTL, LOITER and CIRCLE, and stopping in HOLD, judged by the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.simulation import Core
from tests.drives import rover_driver as rover
from tests.drives.rover_driver import Driver, path_error

ALL = pytest.mark.parametrize("frame", rover.AIRFRAMES)
ROLL_OUT = {"erle_rover": 0.80, "erle_rover_small": 0.14, "ardupilot_rover": 10.65, "skid_rover": 0.43}
"""From WP_SPEED in HOLD [m]; docs/vehicles.md says the same."""


def back_home(d: Driver, seconds: float = 120.0) -> None:
    assert d.fly(seconds, lambda: d.said("Reached destination"))
    d.wait_until_it_stands()
    home = np.array(d.ap.home.pos)[:2]
    assert d.away(*home) < max(0.5 * float(d.ap.params.WP_RADIUS), 0.05 + d.cruise / 3.0)


def go(d: Driver, *places: tuple[float, float]) -> None:
    """To places [m] in GUIDED."""
    for north, east in places:
        d.telemetry.reached.clear()
        d.target(rover.POSITION, x=north, y=east)
        assert d.fly(120.0, lambda: bool(d.reached))


@ALL
def test_hold_rolls_out(core: Core, frame: str) -> None:
    d = Driver(core, frame, estimator="truth").armed_in()
    d.get_going(seconds=10.0)
    place, heading, start = d.place, d.heading, d.now
    assert d.set_mode(rover.HOLD)
    d.wait_until_it_stands(60.0)
    assert np.hypot(*(d.place - place)) == pytest.approx(ROLL_OUT[frame], rel=0.05)
    assert d.heading == pytest.approx(heading, abs=5.0)
    assert d.now - start < 13.0
    place = d.place
    d.fly(20.0)
    assert np.hypot(*(d.place - place)) < 0.05, "the recorded airframe has no rolling resistance"


@ALL
@pytest.mark.parametrize("estimator", ["truth", "ekf"])
def test_rtl(core: Core, frame: str, estimator: str) -> None:
    d = Driver(core, frame, estimator=estimator).armed_in()
    d.get_going(seconds=10.0)
    d.stream(10.0, rover.VELOCITY, vy=d.cruise)
    assert d.set_mode(rover.RTL)
    back_home(d)
    assert d.mode == rover.RTL and d.armed
    d.fly(10.0)
    assert sum("Reached destination" in said for _, _, said in d.texts) == 1


@ALL
def test_rtl_speed(core: Core, frame: str) -> None:
    d = Driver(core, frame, estimator="truth").armed_in()
    d.set_parameter("RTL_SPEED", 0.5 * d.cruise)
    d.get_going(seconds=15.0)
    d.set_mode(rover.HOLD)
    d.wait_until_it_stands()
    start = d.now
    d.set_mode(rover.RTL)
    back_home(d)
    rows = d.since(start)
    assert np.hypot(rows[:, 4], rows[:, 5]).max() == pytest.approx(0.5 * d.cruise, rel=0.15)


@ALL
def test_smart_rtl_takes_the_way_back(core: Core, frame: str) -> None:
    """An L out, an L back, where RTL would cut the corner."""
    d = Driver(core, frame, estimator="truth").armed_in()
    side = 16.0 * max(d.cruise, 2.0 * d.radius)
    d.fly(4.0)
    corner, end = (side, 0.0), (side, side)
    go(d, corner, end)
    d.wait_until_it_stands()
    start = d.now
    assert d.set_mode(rover.SMART_RTL)
    back_home(d, 240.0)
    rows = d.since(start)
    far = np.hypot(rows[:, 1] - side, rows[:, 2] - side) > 5.0 * d.radius + 1.0  # where a car turns round first
    assert path_error(rows[far], (0.0, 0.0), corner, end).max() < max(0.12 * side, 3.0 * d.radius)


def test_smart_rtl_without_a_path_is_refused(core: Core) -> None:
    d = Driver(core, "erle_rover", SRTL_POINTS=0).armed_in()
    assert not d.set_mode(rover.SMART_RTL) and d.mode == rover.GUIDED
    assert d.said("Flight mode change failed")


@ALL
def test_loiter_stops_and_stays(core: Core, frame: str) -> None:
    """Within LOIT_RADIUS of where it stopped, as far as the estimate knows."""
    d = Driver(core, frame).armed_in()
    d.get_going(seconds=8.0)
    place = d.place
    assert d.set_mode(rover.LOITER)
    d.wait_until_it_stands()
    way = 0.5 * d.cruise**2 / float(d.ap.params.ATC_ACCEL_MAX)
    assert np.hypot(*(d.place - place)) == pytest.approx(way, rel=0.15, abs=0.75 * d.cruise)  # late by so much
    stood = np.array(d.ap.estimate.pos)[:2]
    d.fly(60.0)
    assert np.hypot(*(np.array(d.ap.estimate.pos)[:2] - stood)) < float(d.ap.params.LOIT_RADIUS) + 0.3


@ALL
@pytest.mark.parametrize("kind", [0, 1, 2])
def test_loiter_drives_back(core: Core, frame: str, kind: int) -> None:
    """Pushed away (the estimate jumps): back, whichever end first (LOIT_TYPE 0), nose first (1), tail first (2)."""
    d = Driver(core, frame, LOIT_TYPE=kind, LOIT_RADIUS=0.5).armed_in(rover.LOITER)
    d.fly(2.0)
    away = 6.0 * max(d.radius, d.cruise, 0.3)
    place = d.ap.modes.loiter.hold_pos
    d.ap.modes.loiter.hold_pos = (d.ap.estimate.pos.x - away, place.y)  # as if it stood so far ahead of it
    start = d.now
    d.fly(60.0 + 3.0 * away / d.cruise)
    nearest = away
    for _ in range(40):  # one that cannot turn on the spot comes by again and again
        d.fly(1.0)
        nearest = min(nearest, d.ap.modes.loiter.distance)
    assert nearest < max(1.2, 0.5 * d.radius)
    rows = d.since(start)
    heading = np.radians(rows[:, 9])
    forward = rows[:, 4] * np.cos(heading) + rows[:, 5] * np.sin(heading)
    if kind == 1:
        assert forward.max() > 0.3 * d.cruise and forward.min() > -0.3 * d.cruise
    else:
        assert forward.min() < -0.3 * d.cruise and forward.max() < 0.3 * d.cruise


@ALL
@pytest.mark.parametrize("way", [0, 1])
def test_circle(core: Core, frame: str, way: int) -> None:
    """On the circle around where it was, at WP_SPEED, clockwise (CIRC_DIR 0) or not (1)."""
    radius = {"erle_rover_small": 1.0}.get(frame, 5.0)
    d = Driver(core, frame, estimator="truth", CIRC_RADIUS=radius, CIRC_DIR=way).armed_in()
    assert d.set_mode(rover.CIRCLE)
    middle = np.array(d.ap.modes.circle.centre)
    d.fly(8.0 * math.pi * radius / d.cruise)
    start = d.now
    d.fly(2.0 * math.pi * radius / d.cruise)
    rows = d.since(start)
    distance = np.hypot(rows[:, 1] - middle[0], rows[:, 2] - middle[1])
    assert np.abs(distance - radius).max() < 0.07 * radius
    assert np.hypot(rows[:, 4], rows[:, 5]).mean() == pytest.approx(d.cruise, rel=0.05)
    turned = float(np.sum((np.diff(rows[:, 9]) + 180.0) % 360.0 - 180.0))
    assert turned == pytest.approx(-360.0 if way else 360.0, rel=0.06)


def test_a_circle_smaller_than_the_turning_radius_is_enlarged(core: Core) -> None:
    d = Driver(core, "erle_rover", estimator="truth", CIRC_RADIUS=0.5).armed_in()
    assert d.set_mode(rover.CIRCLE)
    d.fly(60.0)
    assert d.said("Circle: radius increased to TURN_RADIUS")
    assert np.hypot(*(d.place - np.array(d.ap.modes.circle.centre))) == pytest.approx(2.0, abs=0.5)


def test_modes_without_a_position_are_refused(core: Core) -> None:
    """Before GPS is used, armed in HOLD: nothing that needs to know where it is."""
    d = Driver(core, "erle_rover")
    d.fly(27.0)
    assert d.set_mode(rover.HOLD)
    d.arm(0.5)
    for mode in (rover.GUIDED, rover.RTL, rover.SMART_RTL, rover.LOITER, rover.CIRCLE):
        assert not d.set_mode(mode), mode
    assert d.mode == rover.HOLD and d.said("Flight mode change failed")
