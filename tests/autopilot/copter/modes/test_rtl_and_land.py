# SPDX-License-Identifier: BSD-3-Clause
"""The way home and the descent."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.arming_checks import DISARMED
from sitl.autopilot.copter.modes import descent, land, rtl, set_mode
from sitl.autopilot.copter.modes.land import LAND
from sitl.autopilot.copter.modes.loiter import LOITER
from sitl.autopilot.copter.modes.rtl import RTL
from sitl.autopilot.copter.modes.state import PilotState
from sitl.autopilot.copter.parameters.flight_modes import Rtl
from sitl.autopilot.modes import ModeReason
from sitl.autopilot.navigation.state import LEG_ENDING
from tests.autopilot.copter.steady_copter import codes, wait


def way_home(wanted: float, climb: float, slope: float) -> Rtl:
    """Parameters of RTL: heights [m]."""
    p = Rtl()
    p.ALT, p.CLIMB_MIN, p.CONE_SLOPE = wanted * 100.0, climb * 100.0, slope
    return p


@pytest.mark.parametrize(
    ("height", "distance", "wanted", "climb", "slope", "result"),
    (
        (10.0, 36.0, 15.0, 0.0, 3.0, 15.0),
        (20.0, 36.0, 15.0, 0.0, 3.0, 20.0),
        (20.0, 36.0, 15.0, 5.0, 3.0, 25.0),
        (10.0, 4.0, 15.0, 0.0, 3.0, 12.0),
        (10.0, 1.0, 15.0, 0.0, 3.0, 10.0),
        (10.0, 1.0, 15.0, 0.0, 0.0, 15.0),
        (0.0, 0.0, 15.0, 0.0, 3.0, 0.3),
        (-5.0, 0.0, 15.0, 0.0, 3.0, 0.3),
    ),
)
def test_height_of_the_way_home(height, distance, wanted, climb, slope, result):
    assert rtl.return_height(height, 0.0, distance, way_home(wanted, climb, slope)) == pytest.approx(result)


@pytest.mark.parametrize(
    ("options", "reposition", "state", "heeds"),
    (
        (0, 1, rtl.RETURN, True),
        (4, 1, rtl.RETURN, False),
        (4, 1, rtl.FINAL_DESCENT, True),
        (4, 0, rtl.FINAL_DESCENT, False),
        (4, 0, rtl.LANDING, True),
    ),
)
def test_the_yaw_stick_may_be_forbidden_on_the_way_home(flying, options, reposition, state, heeds):
    p = flying.autopilot.params
    p.RTL.OPTIONS, p.LAND.REPOSITION = options, reposition
    assert rtl.heeds_yaw_stick(state, p) == heeds


@given(st.floats(-100, 1000), st.floats(0, 1e4), st.floats(0.3, 3000), st.floats(0, 30), st.floats(0, 10))
def test_the_way_home_is_never_below_the_vehicle(height, distance, wanted, climb, slope):
    assert rtl.return_height(height, 0.0, distance, way_home(wanted, climb, slope)) >= height


def test_it_asks_for_both_legs_and_keeps_its_heading(flying):
    ap = flying.autopilot
    ap.estimate.pos = (20.0, 30.0, -10.0)
    assert set_mode.request(flying, RTL, ModeReason.GCS) == 0
    assert codes(flying)[0] == LEG_ENDING
    assert list(ap.modes.nav.request) == pytest.approx([20.0, 30.0, -15.0])
    assert ap.modes.auto_yaw.mode == 0
    rtl.run(flying)  # no leg yet: it holds
    assert ap.control.motors.desired_spool == 2


@pytest.mark.parametrize(("on", "kinds", "height"), ((1, 1, 13.0), (0, 1, 15.0), (1, 2, 15.0)))
def test_the_way_home_stays_below_a_fence_that_is_on(flying, on, kinds, height):
    """FENCE_ALT_MAX less FENCE_MARGIN, where FENCE_TYPE has the greatest height."""
    ap = flying.autopilot
    ap.estimate.pos = (20.0, 30.0, -10.0)
    ap.params.FENCE.ALT_MAX, ap.params.FENCE.MARGIN, ap.params.FENCE.TYPE = 15.0, 2.0, kinds
    ap.fence.on = on
    assert set_mode.request(flying, RTL, ModeReason.GCS) == 0
    assert ap.modes.rtl.return_d == pytest.approx(-height)


@pytest.mark.parametrize(("final", "state"), ((0.0, rtl.LANDING), (500.0, rtl.FINAL_DESCENT)))
def test_over_home_it_waits_then_lands_or_stays(flying, final, state):
    ap = flying.autopilot
    set_mode.request(flying, RTL, ModeReason.GCS)
    ap.params.RTL_ALT_FINAL = final
    ap.modes.rtl.state, ap.modes.rtl.loiter_us = rtl.LOITER, flying.time_us
    wait(flying, 4.9)
    rtl.run(flying)
    assert ap.modes.rtl.state == rtl.LOITER
    wait(flying, 0.2)
    rtl.run(flying)
    assert ap.modes.rtl.state == state


def settled_descent(v, seconds=6.0):
    """Desired descent [m/s] once the shaping has settled."""
    ap = v.autopilot
    height = ap.home.pos.z - ap.estimate.pos.z
    for _ in range(round(seconds * 400)):
        descent.sink(ap.control.pos_d, ap.modes.land, height, False, ap.params)
    return float(ap.control.pos_d.vel_desired)


@pytest.mark.parametrize(
    ("height", "fast", "speed"),
    ((30.0, 0.0, 1.5), (30.0, 100.0, 1.0), (9.0, 0.0, 0.5), (10.0, 0.0, 0.5), (-2.0, 0.0, 0.5)),
)
def test_descent(flying, height, fast, speed):
    set_mode.request(flying, LAND, ModeReason.GCS)
    flying.autopilot.params.LAND_SPEED_HIGH = fast
    flying.autopilot.estimate.pos = flying.autopilot.estimate.pos.replace(z=-height)
    assert settled_descent(flying) == pytest.approx(speed, abs=0.01)


def test_a_landing_after_a_failsafe_waits_four_seconds(flying):
    set_mode.request(flying, LAND, ModeReason.GCS)
    flying.autopilot.modes.land.pause = 1
    wait(flying, 3.9)
    land.run(flying)
    assert flying.autopilot.modes.land.pause == 1
    wait(flying, 0.2)
    land.run(flying)
    assert flying.autopilot.modes.land.pause == 0


def test_it_disarms_when_landed_and_idling(flying):
    ap = flying.autopilot
    set_mode.request(flying, LAND, ModeReason.GCS)
    ap.arming.landed = 1
    land.run(flying)
    assert ap.arming.armed == 1 and ap.control.motors.desired_spool == 1
    ap.control.motors.spool_state = 1
    land.run(flying)
    assert ap.arming.armed == 0
    assert DISARMED in codes(flying)


def test_sticks_move_the_landing_place_in_the_direction_of_the_nose(flying):
    sticks, params = PilotState(), flying.autopilot.params
    sticks.pitch = -1.0
    assert descent.stick_velocity(sticks, math.pi / 2, params) == pytest.approx((0.0, 1.25))
    params.LAND_REPOSITION = 0.0
    assert descent.stick_velocity(sticks, math.pi / 2, params) == (0.0, 0.0)


def test_a_high_throttle_cancels_the_landing_only_with_the_option(flying):
    ap = flying.autopilot
    set_mode.request(flying, LAND, ModeReason.GCS)
    ap.modes.pilot.throttle = 0.8
    land.run(flying)
    assert ap.modes.wanted == 0
    ap.params.PILOT_THR_BHV = 2.0
    land.run(flying)
    assert ap.modes.wanted == LOITER + 1
