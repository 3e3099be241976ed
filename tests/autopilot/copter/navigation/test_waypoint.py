# SPDX-License-Identifier: BSD-3-Clause
"""Corners, stops, pauses and circles, flown by a point mass in plain Python."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.autopilot.copter.navigation import waypoint
from sitl.autopilot.copter.navigation.planner import PLANNER
from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.navigation import path as paths
from sitl.autopilot.navigation.leg import LegError, Limits, plan
from sitl.autopilot.navigation.planner import end
from sitl.autopilot.notes import ItemReached
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.core.vectors import Vec3
from tests.autopilot.copter.navigation.pointmass import DT, ORIGIN, PointMass


def item(n: float, e: float, up: float = 10.0, delay: float = 0.0) -> MissionItem:
    """A waypoint at an offset from home."""
    lat, lon = add_offset(ORIGIN[0], ORIGIN[1], n, e)
    return MissionItem(MavCmd.NAV_WAYPOINT, MavFrame.GLOBAL_RELATIVE_ALT, p1=delay, x=round(lat), y=round(lon), z=up)


def vehicle(*items: MissionItem, follow: bool = True) -> PointMass:
    """A vehicle 10 m over home that has begun its mission; without ``follow`` it is on its target always."""
    p = PointMass(Mission.of([home_item(*ORIGIN), *items]), (0.0, 0.0, -10.0), follow=follow)
    p.note(p.sequencer.start(p.v))
    return p


def path(p: PointMass, seconds: float, every: int = 1) -> np.ndarray:
    """Target position, velocity, acceleration (9 columns) and time over some time."""
    nav = p.v.autopilot.modes.nav
    rows = []
    for k in range(int(seconds / DT)):
        p.tick()
        if k % every == 0:
            rows.append([*map(float, nav.pos), *map(float, nav.vel), *map(float, nav.acc), p.time])
    return np.array(rows)


def reached(p: PointMass, seq: int) -> float | None:
    """When an item was reached [s]."""
    return next((t for t, n in p.notes if n == ItemReached(seq)), None)


@pytest.mark.parametrize("degrees", [0.0, 90.0, 180.0])
def test_corner(degrees: float) -> None:
    """Whatever the angle, the target is smooth and rounds the corner within WPNAV_RADIUS, without a stop."""
    turn = math.radians(degrees)
    p = vehicle(item(12.0, 0.0), item(12.0 + 12.0 * math.cos(turn), 12.0 * math.sin(turn)), follow=False)
    rows = path(p, 10.0)
    v = rows[:, 3:5]
    assert np.abs(np.diff(rows[:, 0:2], axis=0) / DT - v[1:]).max() < 0.02
    assert np.abs(np.diff(v, axis=0) / DT - rows[1:, 6:8]).max() < 0.02
    assert np.linalg.norm(v, axis=1).max() <= 10.0
    assert np.linalg.norm(rows[:, 6:8], axis=1).max() <= 5.0
    away = np.linalg.norm(rows[:, 0:2] - (12.0, 0.0), axis=1)
    assert away.min() <= 2.0 + 1e-6
    t = reached(p, 1)
    assert t is not None and t < 7.0  # a stop would take until 7.66 s
    if degrees == 0.0:
        assert np.linalg.norm(v[np.abs(rows[:, 0] - 12.0) < 1.0], axis=1).min() > 2.0
    elif degrees < 180.0:
        assert away.min() > 0.5  # the corner is cut


def test_delay_stops_and_waits() -> None:
    """A waypoint with a delay is flown to its end and left after the delay, counted from the arrival."""
    p = vehicle(item(5.0, 0.0, delay=2.0), item(5.0, 5.0), follow=False)
    rows = path(p, 8.5)
    assert reached(p, 1) == pytest.approx(plan(5.0, Limits(10, 2.5, 1, 0.3)).duration + 2.0, abs=0.01)
    assert rows[:, 0].max() == pytest.approx(5.0, abs=0.005)


def test_places_take_the_default() -> None:
    """Latitude and longitude zero: where it was; altitude zero: as high as it was."""
    p = vehicle(
        MissionItem(MavCmd.NAV_WAYPOINT, MavFrame.GLOBAL_RELATIVE_ALT, z=12.0),
        MissionItem(MavCmd.NAV_WAYPOINT, MavFrame.GLOBAL_RELATIVE_ALT),
        follow=False,
    )
    path(p, 5.5)
    assert list(p.v.autopilot.modes.nav.target) == pytest.approx([0.0, 0.0, -12.0], abs=0.02)


def test_slow_vehicle_holds_back_the_target() -> None:
    """Path time slows down for a vehicle that does not follow, and recovers."""
    p = vehicle(item(50.0, 0.0))
    p.stuck = True
    path(p, 6.0, 100)
    nav = p.v.autopilot.modes.nav
    assert nav.time_scale < 0.2
    gone = float(nav.current.elapsed)
    path(p, 1.0, 100)
    assert nav.current.elapsed - gone < 0.2
    p.stuck = False
    path(p, 5.0, 100)
    assert nav.time_scale > 0.6


def test_pause() -> None:
    """A paused path stops within the acceleration limit and goes on to the same end."""
    p = vehicle(item(20.0, 0.0), follow=False)
    nav = p.v.autopilot.modes.nav
    path(p, 4.0)
    nav.paused = 1
    rows = path(p, 5.5)
    assert np.abs(rows[:, 6]).max() <= 2.5 * 1.2
    assert rows[-1, 3] == 0.0
    assert rows[-1, 0] < 19.0
    nav.paused = 0
    path(p, 7.5)
    assert reached(p, 1) is not None
    assert nav.pos[0] == pytest.approx(20.0, abs=0.02)


@pytest.mark.parametrize(("radius", "turns"), [(5.0, 1.0), (-8.0, 0.5)])
def test_circle(radius: float, turns: float) -> None:
    """Turns of the right radius and sense, entered at the nearest point."""
    lat, lon = add_offset(ORIGIN[0], ORIGIN[1], 20.0, 0.0)
    circle = MissionItem(
        MavCmd.NAV_LOITER_TURNS, MavFrame.GLOBAL_RELATIVE_ALT, p1=turns, p3=radius, x=round(lat), y=round(lon), z=10.0
    )
    p = vehicle(circle, follow=False)
    nav = p.v.autopilot.modes.nav
    points = []
    for _ in range(int(40.0 / DT)):
        p.tick()
        if nav.circle_running:
            points.append([float(nav.pos[0]) - 20.0, float(nav.pos[1])])
        if reached(p, 1) is not None:
            break
    seen = np.array(points)
    assert np.linalg.norm(seen, axis=1) == pytest.approx(abs(radius), abs=0.01)  # places are whole degE7
    angle = np.unwrap(np.arctan2(seen[:, 1], seen[:, 0]))
    assert angle[-1] - angle[0] == pytest.approx(math.copysign(2.0 * math.pi * turns, radius), abs=0.02)
    assert abs(abs(angle[0]) - math.pi) < 0.01


def test_leg_for_the_core() -> None:
    """``request_leg`` and ``request_legs``: the legs are there, started, when the shell has attended."""
    p = vehicle(item(50.0, 0.0), follow=False)
    path(p, 1.0)
    ap = p.v.autopilot
    waypoint.stop(ap.modes.nav)
    paths.request_legs(ap.modes.nav, ap.events, p.v.time_us, Vec3(0.0, 0.0, -15.0), Vec3(30.0, 0.0, -15.0))
    assert ap.events.attention == 1
    assert waypoint.advance(ap.modes.nav, ap.control, ap.estimate, ap.params, int(p.v.time_us)) == 0
    p.sequencer.attend()
    nav = ap.modes.nav
    assert nav.request_pending == 0
    assert nav.current.fast == 1
    assert end(nav.current) == pytest.approx((0.0, 0.0, -15.0), abs=1e-6)
    assert end(nav.next) == pytest.approx((30.0, 0.0, -15.0), abs=1e-6)
    assert nav.current.top_speed == pytest.approx(2.5, rel=0.1)


def test_change_of_speed() -> None:
    """DO_CHANGE_SPEED on the way: the target goes on smoothly, settles at the new speed, has the same end."""
    p = vehicle(item(60.0, 0.0), item(60.0, 20.0), follow=False)
    nav = p.v.autopilot.modes.nav
    path(p, 3.0)
    v, a = float(nav.vel[0]), float(nav.acc[0])
    assert p.sequencer.change_speed(p.v, 0, 3.0)
    assert not p.sequencer.change_speed(p.v, 0, math.nan)
    rows = path(p, 9.0)
    assert rows[0, 3] == pytest.approx(v, abs=0.01)
    assert rows[0, 6] == pytest.approx(a, abs=0.01)
    assert rows[-1, 3] == pytest.approx(3.0, abs=0.01)
    assert nav.current.fast == 1
    assert end(nav.current) == pytest.approx((60.0, 0.0, -10.0), abs=0.01)
    assert nav.next.top_speed == 3.0


@pytest.mark.parametrize("far", [1e-9, 1e7])
def test_odd_lengths(far: float) -> None:
    """Legs of no length and huge ones neither fail nor stand still."""
    p = vehicle(item(1.0, 0.0), follow=False)
    ap = p.v.autopilot
    PLANNER.begin(ap, p.v.time_us, Vec3(far, 0.0, -10.0))
    assert math.isfinite(ap.modes.nav.current.duration)
    with pytest.raises(LegError):
        PLANNER.begin(ap, p.v.time_us, Vec3(math.nan, 0.0, -10.0))


@pytest.mark.slow
def test_square_as_recorded() -> None:
    """The 30 m square of ArduPilot's recording: waypoints are reached at its times within 3 %, and as fast.

    Times count from MISSION_START, the take-off ended at 9.24 s.
    """
    start = 9.24
    square = [item(30.0, 0.0), item(30.0, 30.0), item(0.0, 30.0), item(0.0, 0.0)]
    p = vehicle(MissionItem(MavCmd.NAV_TAKEOFF, MavFrame.GLOBAL_RELATIVE_ALT, z=10.0), *square)
    fastest = 0.0
    while (last := reached(p, 5)) is None and p.time < 40.0:
        p.tick()
        fastest = max(fastest, math.hypot(*p.v.autopilot.estimate.vel[:2]))
    assert last is not None
    ours = [float(reached(p, seq) or 0.0) + start for seq in (2, 3, 4, 5)]
    assert ours == pytest.approx([17.92, 23.96, 30.00, 38.08], rel=0.03)
    assert fastest == pytest.approx(5.75, rel=0.03)
