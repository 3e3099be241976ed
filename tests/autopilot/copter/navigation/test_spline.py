# SPDX-License-Identifier: BSD-3-Clause
"""Curves to spline waypoints, flown by a point mass in plain Python."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.autopilot.mission.item import MissionItem
from sitl.core.mavlink import MavCmd
from tests.autopilot.copter.navigation.pointmass import DT
from tests.autopilot.copter.navigation.test_waypoint import item, path, reached, vehicle

SPEED, ACCEL = 10.0, 1.25
"""WPNAV_SPEED, and half of WPNAV_ACCEL, as they are when nothing is set [m/s, m/s^2]."""


def curve(n: float, e: float, up: float = 10.0, delay: float = 0.0) -> MissionItem:
    """A spline waypoint."""
    return item(n, e, up, delay)._replace(command=MavCmd.NAV_SPLINE_WAYPOINT)


def assert_smooth(rows: np.ndarray) -> None:
    """Velocity is the change of position, and within its limits; acceleration stays below the two limits together.

    Where one path goes over into the next, a part of a tick is lost.
    """
    vel, acc = rows[:, 3:6], rows[:, 6:9]
    missing = np.abs(np.diff(rows[:, 0:3], axis=0) / DT - vel[1:]).max(axis=1)
    assert np.sort(missing)[-4] < 0.05
    assert missing.max() < SPEED
    assert np.linalg.norm(vel[:, :2], axis=1).max() <= SPEED + 1e-6
    assert np.abs(np.diff(vel, axis=0)).max() < 2.01 * ACCEL * DT
    assert np.linalg.norm(acc[:, :2], axis=1).max() < 2.01 * ACCEL


def test_from_rest_to_rest() -> None:
    """Alone it is a straight line, flown with WPNAV_ACCEL."""
    p = vehicle(curve(40.0, 0.0, 20.0), follow=False)
    rows = path(p, 12.0)
    assert_smooth(rows)
    assert np.abs(rows[:, 1]).max() < 0.01
    assert reached(p, 1) == pytest.approx(2.0 * (40.0 / ACCEL) ** 0.5, rel=0.05)
    assert rows[-1, :6] == pytest.approx([40.0, 0.0, -20.0, 0.0, 0.0, 0.0], abs=0.02)


def test_joins_legs_and_curves() -> None:
    """A leg goes over into a curve along itself, curves into each other, the last one into a leg, without a stop."""
    p = vehicle(item(40.0, 0.0), curve(80.0, 20.0), curve(80.0, 60.0), item(40.0, 60.0), follow=False)
    rows = path(p, 45.0)
    assert_smooth(rows)
    times = [reached(p, seq) for seq in (1, 2, 3, 4)]
    assert all(t is not None for t in times)
    at = [rows[np.argmin(np.abs(rows[:, 9] - float(t or 0.0)))] for t in times]
    assert [row[:2] for row in at[:3]] == [pytest.approx(w, abs=0.1) for w in ((40, 0), (80, 20), (80, 60))]
    speeds = [float(np.linalg.norm(row[3:5])) for row in at]
    assert min(speeds[:3]) > 2.0
    assert speeds[3] == pytest.approx(0.0, abs=0.01)
    courses = [row[3:5] / np.linalg.norm(row[3:5]) for row in at[:3]]
    assert courses[0] == pytest.approx([1.0, 0.0], abs=0.02)  # along the leg
    assert courses[1] == pytest.approx(np.array([40.0, 60.0]) / np.hypot(40.0, 60.0), abs=0.02)  # past the waypoint
    assert courses[2] == pytest.approx([-1.0, 0.0], abs=0.02)  # along the leg that follows


def test_waits_for_a_delay() -> None:
    """With a delay it ends at rest, and the next command begins after it."""
    p = vehicle(curve(20.0, 0.0, delay=3.0), curve(20.0, 20.0), follow=False)
    rows = path(p, 20.0)
    there = rows[np.linalg.norm(rows[:, :2] - (20.0, 0.0), axis=1) < 0.05]
    assert np.ptp(there[:, 9]) > 3.0
    assert rows[-1, :2] == pytest.approx([20.0, 20.0], abs=0.02)


def test_change_of_speed_on_the_way() -> None:
    """DO_CHANGE_SPEED holds on the curve under way, and is come to with the acceleration of legs."""
    p = vehicle(curve(100.0, 0.0), follow=False)
    path(p, 4.0)
    assert p.sequencer.change_speed(p.v, 0, 3.0)
    rows = path(p, 10.0)
    assert_smooth(rows)
    assert rows[-1, 3] == pytest.approx(3.0, abs=0.01)


def test_a_place_under_the_vehicle() -> None:
    """A curve of no length is there at once."""
    p = vehicle(curve(0.0, 0.0), curve(0.0, 0.0, 15.0), follow=False)
    path(p, 8.0)
    assert reached(p, 1) == pytest.approx(0.0, abs=0.05)
    assert p.v.autopilot.modes.nav.pos.z == pytest.approx(-15.0, abs=0.02)


def test_mission_changed_before_the_curve_ends() -> None:
    """What follows is gone when the curve comes to its end at a speed: the vehicle stops behind it and stays there."""
    p = vehicle(curve(40.0, 0.0), curve(80.0, 0.0))
    path(p, 4.0, 100)
    shorter = p.mission.items[:2]
    p.sequencer.set_mission(p.v, type(p.mission)(shorter))
    rows = path(p, 20.0, 20)
    assert reached(p, 1) is not None
    assert np.linalg.norm(rows[-1, 3:6]) == pytest.approx(0.0, abs=0.01)
    assert 38.0 < rows[-1, 0] < 65.0


def test_a_pause_stops_it_at_once_and_it_waits_before_it_goes_on() -> None:
    """As ArduPilot's: from 4.9 m/s it stands after 0.9 m, and moves on 5 s after DO_PAUSE_CONTINUE; on a straight leg
    it brakes with WPNAV_ACCEL."""
    p = vehicle(curve(100.0, 0.0), follow=False)
    before = path(p, 4.0)[-1]
    assert before[3] > 4.0
    p.v.autopilot.modes.nav.paused = True
    stopped = path(p, 6.0)
    assert stopped[-1, 0] - before[0] < 1.5
    assert stopped[400, 3] < 0.1
    p.v.autopilot.modes.nav.paused = False
    gone_on = path(p, 12.0)
    assert 2.5 < np.argmax(gone_on[:, 3] > 0.5) * DT < 6.5
    assert gone_on[-1, 3] > 4.0
