# SPDX-License-Identifier: BSD-3-Clause
"""Who may enter which mode, when."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot import smart_rtl_path
from sitl.autopilot.copter.modes import set_mode
from sitl.autopilot.copter.modes.alt_hold import ALT_HOLD
from sitl.autopilot.copter.modes.auto import AUTO, AUTO_RTL
from sitl.autopilot.copter.modes.autotune import AUTOTUNE
from sitl.autopilot.copter.modes.avoid_adsb import AVOID_ADSB
from sitl.autopilot.copter.modes.brake import BRAKE
from sitl.autopilot.copter.modes.circle import CIRCLE
from sitl.autopilot.copter.modes.drift import DRIFT
from sitl.autopilot.copter.modes.flip import FLIP
from sitl.autopilot.copter.modes.flowhold import FLOWHOLD
from sitl.autopilot.copter.modes.follow import FOLLOW
from sitl.autopilot.copter.modes.guided import GUIDED
from sitl.autopilot.copter.modes.land import LAND
from sitl.autopilot.copter.modes.loiter import LOITER
from sitl.autopilot.copter.modes.mode_list import NAMES
from sitl.autopilot.copter.modes.poshold import POSHOLD
from sitl.autopilot.copter.modes.rtl import RTL
from sitl.autopilot.copter.modes.smart_rtl import SMART_RTL
from sitl.autopilot.copter.modes.stabilize import STABILIZE
from sitl.autopilot.copter.modes.systemid import SYSTEMID
from sitl.autopilot.copter.modes.throw import THROW
from sitl.autopilot.copter.modes.turtle import TURTLE
from sitl.autopilot.copter.modes.zigzag import ZIGZAG
from sitl.autopilot.followed_vehicle import FOLLOW_OFF
from sitl.autopilot.modes import MODE_CHANGED, MODE_REFUSED, ModeReason, ModeResult
from tests.autopilot.copter.steady_copter import codes, fly, snapshot

OTHERS = (FLIP, SMART_RTL, THROW, AUTO_RTL, SYSTEMID, FLOWHOLD, TURTLE, AUTOTUNE)
"""Modes with conditions of their own."""
ALL = tuple(number for number in NAMES if number not in OTHERS)


@pytest.mark.parametrize("number", ALL)
def test_disarmed_any_mode_may_be_selected_even_without_position_or_mission(vehicle, number):
    vehicle.autopilot.estimate.position_ok = vehicle.autopilot.home.is_set = 0
    vehicle.autopilot.params.FOLL_ENABLE = 1.0
    assert set_mode.request(vehicle, number, ModeReason.GCS) == ModeResult.ACCEPTED
    assert vehicle.autopilot.modes.number == number


@pytest.mark.parametrize("number", (-1, 8, 10, 13, 99, 2**40))
def test_unknown_modes_are_refused_and_change_nothing_but_the_event(vehicle, number):
    assert set_mode.request(vehicle, number, ModeReason.GCS) == ModeResult.NO_SUCH_MODE
    assert vehicle.autopilot.modes.number == STABILIZE
    assert codes(vehicle) == [MODE_REFUSED]


@pytest.mark.parametrize("number", ALL)
def test_in_flight_without_position_only_modes_that_do_without(flying, number):
    fly(flying, STABILIZE)
    ap = flying.autopilot
    ap.modes.mission_count, ap.estimate.position_ok = 5, 0
    ap.params.FOLL_ENABLE = 1.0
    needs = number in (AUTO, GUIDED, LOITER, RTL, CIRCLE, DRIFT, POSHOLD, BRAKE, AVOID_ADSB, FOLLOW, ZIGZAG)
    assert set_mode.request(flying, number, ModeReason.GCS) == (
        ModeResult.REQUIRES_POSITION if needs else ModeResult.ACCEPTED
    )


@pytest.mark.parametrize("number", ALL)
def test_in_flight_with_position_and_mission_everything_goes(flying, number):
    flying.autopilot.modes.mission_count = 5
    flying.autopilot.params.FOLL_ENABLE = 1.0
    assert set_mode.request(flying, number, ModeReason.GCS) == ModeResult.ACCEPTED
    assert flying.autopilot.modes.number == number


@pytest.mark.parametrize(
    ("mode", "landed", "throttle_zero", "roll", "cause"),
    (
        (STABILIZE, False, False, 0.0, ModeResult.ACCEPTED),
        (STABILIZE, False, True, 0.0, ModeResult.INIT_FAILED),
        (ALT_HOLD, False, True, 0.0, ModeResult.ACCEPTED),
        (ALT_HOLD, True, False, 0.0, ModeResult.INIT_FAILED),
        (ALT_HOLD, False, False, 0.8, ModeResult.INIT_FAILED),
        (LOITER, False, False, 0.0, ModeResult.INIT_FAILED),
    ),
)
def test_a_flip_begins_in_flight_near_level_in_some_modes(flying, mode, landed, throttle_zero, roll, cause):
    ap = fly(flying, mode).autopilot
    ap.arming.landed, ap.modes.pilot.throttle_zero = landed, throttle_zero
    ap.estimate.q = ap.estimate.q.replace(w=math.cos(roll / 2), x=math.sin(roll / 2))
    assert set_mode.request(flying, FLIP, ModeReason.GCS) == cause
    assert ap.modes.number == (FLIP if cause == ModeResult.ACCEPTED else mode)


def test_auto_needs_a_mission_in_flight(flying):
    before = snapshot(flying.autopilot.modes)
    assert set_mode.request(flying, AUTO, ModeReason.GCS) == ModeResult.INIT_FAILED
    assert snapshot(flying.autopilot.modes) == before


def test_auto_armed_on_the_ground_needs_a_take_off_first(flying):
    ap = flying.autopilot
    ap.arming.landed, ap.modes.mission_count = 1, 5
    assert set_mode.request(flying, AUTO, ModeReason.GCS) == ModeResult.MISSING_TAKEOFF
    ap.modes.mission_takes_off = 1
    assert set_mode.request(flying, AUTO, ModeReason.GCS) == ModeResult.ACCEPTED


def test_follow_has_to_be_enabled(vehicle):
    assert set_mode.request(vehicle, FOLLOW, ModeReason.GCS) == ModeResult.INIT_FAILED
    assert codes(vehicle) == [FOLLOW_OFF, MODE_REFUSED]


def test_rtl_needs_a_home_in_flight(flying):
    flying.autopilot.home.is_set = 0
    assert set_mode.request(flying, RTL, ModeReason.GCS) == ModeResult.INIT_FAILED


def test_smart_rtl_needs_a_path(flying):
    assert set_mode.request(flying, SMART_RTL, ModeReason.GCS) == ModeResult.INIT_FAILED
    ap = flying.autopilot
    smart_rtl_path.begin(ap.modes.path, ap.estimate.pos, True, flying.time_us, ap.params.SRTL)
    ap.estimate.position_ok = 0
    assert set_mode.request(flying, SMART_RTL, ModeReason.GCS) == ModeResult.REQUIRES_POSITION
    ap.estimate.position_ok = 1
    assert set_mode.request(flying, SMART_RTL, ModeReason.GCS) == ModeResult.ACCEPTED


def test_a_throw_begins_disarmed(vehicle, flying):
    assert set_mode.request(vehicle, THROW, ModeReason.GCS) == ModeResult.ACCEPTED
    assert set_mode.request(flying, THROW, ModeReason.GCS) == ModeResult.INIT_FAILED


@pytest.mark.parametrize("number", [STABILIZE, DRIFT])
def test_on_the_ground_the_stick_does_not_take_a_raised_throttle(flying, number):
    ap = flying.autopilot
    ap.arming.landed, ap.modes.pilot.throttle_filtered = 1, 0.6
    assert set_mode.request(flying, number, ModeReason.GCS) == ModeResult.THROTTLE_TOO_HIGH
    ap.arming.landed = 0
    assert set_mode.request(flying, number, ModeReason.GCS) == ModeResult.ACCEPTED


def test_leaving_stabilize_needs_a_height(flying):
    fly(flying, STABILIZE)
    flying.autopilot.estimate.attitude_ok = 0
    assert set_mode.request(flying, ALT_HOLD, ModeReason.GCS) == ModeResult.NEEDS_ALTITUDE


def test_same_mode_again_is_no_change(flying):
    assert set_mode.request(flying, GUIDED, ModeReason.GCS) == ModeResult.ACCEPTED
    assert codes(flying) == []


def test_a_change_is_told(flying):
    set_mode.request(flying, LAND, ModeReason.GCS)
    assert codes(flying) == [MODE_CHANGED]
    ring = flying.autopilot.events
    assert (ring.a[0], ring.b[0]) == (LAND, ModeReason.GCS)
    assert flying.autopilot.modes.previous == GUIDED


def test_texts_are_those_that_users_know():
    assert set_mode.refusal_texts(99, ModeResult.NO_SUCH_MODE) == ["No such mode 99"]
    assert set_mode.refusal_texts(AUTO, ModeResult.INIT_FAILED) == ["Mode change to AUTO failed: init failed"]
    assert set_mode.refusal_texts(LOITER, ModeResult.REQUIRES_POSITION) == [
        "Mode change to LOITER failed: requires position"
    ]
    assert set_mode.refusal_texts(GUIDED, ModeResult.ACCEPTED) == []
