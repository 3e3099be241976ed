# SPDX-License-Identifier: BSD-3-Clause
"""A rover's modes at their edges: the way back of LOITER, ACRO without a speed, the steering stick, home."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.arming_checks import DISARMED, ArmingMethod
from sitl.autopilot.home import set_here
from sitl.autopilot.modes import ModeReason
from sitl.autopilot.navigation.state import GO_ON, LEG_ENDING
from sitl.autopilot.rover import pilot
from sitl.autopilot.rover.modes import acro, decisions, loiter
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.loiter import LOITER
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.mode_list import MODES
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.rover.modes.state import LoiterState
from sitl.core.algebra import ZERO2
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover

BY_NUMBER = {mode.number: mode for mode in MODES}


@pytest.mark.parametrize(
    ("kind", "place", "yaw", "heading", "speed"),
    (
        (0, (0.0, 6.0), 0.0, 90.0, 0.5),  # at a right angle at half the speed
        (0, (6.0, 0.0), 0.0, 0.0, 1.0),
        (0, (-6.0, 0.0), 0.0, 0.0, -1.0),  # backwards: it is nearer
        (1, (-6.0, 0.0), 0.0, 180.0, 0.5),
        (2, (6.0, 0.0), 0.0, 180.0, -0.5),
        (2, (-6.0, 0.0), 0.0, 0.0, -1.0),
        (0, (60.0, 0.0), 0.0, 0.0, 5.0),  # no faster than WP_SPEED
        (0, (0.0, 6.0), math.pi / 2, 90.0, 1.0),  # it points there
        (0, (0.0, 6.0), -math.pi / 2, -90.0, -1.0),
        (0, (0.0, 6.0), math.pi / 4, 90.0, 0.75),
    ),
)
def test_the_way_back_of_loiter(
    rover: Rover, kind: int, place: tuple[float, float], yaw: float, heading: float, speed: float
) -> None:
    """LOIT_TYPE; 4 m beyond LOIT_RADIUS 2 m with LOIT_SPEED_GAIN 0.25 are 1 m/s."""
    p, state = rover.ap.params, LoiterState()
    p.LOIT.TYPE, p.LOIT.RADIUS, p.LOIT.SPEED_GAIN = float(kind), 2.0, 0.25
    state.hold_pos, state.distance = Vec2(*place), math.hypot(*place)
    loiter.aim(state, ZERO2, yaw, p)
    assert abs(math.remainder(math.degrees(state.heading) - heading, 360.0)) == pytest.approx(0.0, abs=1e-6)
    assert state.speed == pytest.approx(speed)


@pytest.mark.parametrize(("away", "drives"), ((2.0, False), (2.01, True)))
def test_within_loit_radius_it_stays(rover: Rover, away: float, drives: bool) -> None:
    rover.ap.params.LOIT.RADIUS = 2.0
    assert request(rover.v, LOITER, ModeReason.GCS) == 0
    state = rover.ap.modes.loiter
    state.hold_pos, state.speed = Vec2(away, 0.0), 3.0
    rover.ap.control.speed.last_tick = -1000
    loiter.run(rover.v)
    assert (state.speed > 0.0) == drives and state.distance == pytest.approx(away)


def test_modes_without_a_path_take_no_speed(rover: Rover) -> None:
    for number in (MANUAL, HOLD, LOITER):
        request(rover.v, number, ModeReason.GCS)
        assert not BY_NUMBER[number].change_speed(rover.v, 2.0)


def test_acro_drives_by_its_sticks_also_while_its_speed_is_not_known(rover: Rover) -> None:
    request(rover.v, acro.ACRO, ModeReason.GCS)
    rover.sticks(steering=1900, throttle=1800)
    rover.run(1.0)
    assert rover.speed > 0.5 and rover.heading > 0.1
    control = rover.ap.control
    control.speed.forward_ok, control.motors.throttle = 0, 0.0
    acro.run(rover.v)
    wanted = pilot.limited_sticks(rover.ap.modes.pilot, control.motors.throttle_last, rover.ap.params)
    assert control.motors.throttle == pytest.approx(wanted.throttle) and wanted.throttle > 0.1


def test_the_end_of_a_detour_is_told_to_the_shell(rover: Rover) -> None:
    rover.ap.modes.nav.request_pending = GO_ON
    decisions.update([rover.v], 0)
    assert LEG_ENDING in [code for code, _, _ in rover.events()]


def test_the_steering_stick_arms_and_disarms_after_two_seconds() -> None:
    rover = Rover()
    rover.run(1.1)
    rover.ap.params.ARMING.RUDDER = 2.0
    rover.sticks(steering=2000, throttle=1500)
    rover.run(1.9)
    assert not rover.ap.arming.armed
    rover.run(0.3)
    assert rover.ap.arming.armed
    rover.sticks(steering=1500)
    rover.run(0.1)
    rover.events()
    rover.sticks(steering=1000)
    rover.run(2.3)
    assert not rover.ap.arming.armed
    assert (DISARMED, float(ArmingMethod.RUDDER)) in [(code, a) for code, a, _ in rover.events()]


@pytest.mark.parametrize(
    ("armed", "locked", "located", "moves"), ((0, 0, 1, True), (1, 0, 1, False), (0, 1, 1, False), (0, 0, 0, False))
)
def test_home_follows_a_disarmed_rover(armed: int, locked: int, located: int, moves: bool) -> None:
    rover = Rover()
    home, est = rover.ap.home, rover.ap.estimate
    set_here(home, est)
    home.locked, est.position_ok = locked, located
    est.pos = Vec3(50.0, 0.0, 0.0)
    decisions.follow_home(home, est, bool(armed))
    assert (home.pos.x == 50.0) == moves
    est.pos = Vec3(50.0 + (decisions.HOME_MOVES - 0.01), 0.0, -99.0)
    decisions.follow_home(home, est, bool(armed))
    assert home.pos.x != est.pos.x, "not for less than its step"
    est.pos = Vec3(50.0 + decisions.HOME_MOVES, 0.0, 0.0)
    decisions.follow_home(home, est, bool(armed))
    assert (home.pos.x == est.pos.x) == moves


@pytest.mark.parametrize(("armed", "failed", "ok"), ((0, 0, True), (0, 4, False), (1, 4, True), (1, 0, True)))
def test_whether_it_may_be_armed_is_known_before_it_is_asked(
    rover: Rover, armed: int, failed: int, ok: bool, monkeypatch: Any
) -> None:
    monkeypatch.setattr(decisions, "check", lambda v: failed)
    rover.ap.arming.armed, rover.v.tick = armed, 0
    decisions.update([rover.v], 0)
    assert bool(rover.ap.arming.prearm_ok) == ok


def test_each_part_of_a_period_runs_as_often_as_it_says(rover: Rover, monkeypatch: Any) -> None:
    """50 periods a second, eight ticks each."""
    times = dict.fromkeys(("sense", "read_transmitter", "take_asked"), 50)
    times |= {"check_slowly": 10, "check": 4, "keep_path": 3, "follow_home": 1}
    counts = dict.fromkeys(times, 0)

    def counted(name: str) -> Any:
        def count(*args: Any) -> int:
            counts[name] += 1
            return -1 if name == "take_asked" else 0

        return count

    for name in times:
        monkeypatch.setattr(decisions, name, counted(name))
    rover.ap.arming.armed = 0
    rover.v.tick = 0
    for _ in range(50):
        decisions.update([rover.v], 0)
        rover.v.tick += 8
    assert counts == times
