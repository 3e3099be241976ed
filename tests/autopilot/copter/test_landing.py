# SPDX-License-Identifier: BSD-3-Clause
"""Landing detector, throttle priority, crash check."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.copter import crash, landing
from sitl.autopilot.copter.control.state import AttitudeState
from sitl.autopilot.copter.crash import CRASH_DISARM
from sitl.autopilot.copter.landing import LANDED
from sitl.autopilot.copter.modes.state import LandingState
from sitl.autopilot.state import Arming
from sitl.core.vectors import Vec3
from tests.autopilot.copter.steady_copter import codes, fly

STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, LAND, BRAKE = 0, 2, 3, 4, 5, 6, 9, 17


def test_rest_is_counted_and_lands_the_vehicle() -> None:
    arming = Arming()
    told = [landing.count_rest(arming, True) for _ in range(landing.TRIGGER_TICKS)]
    assert told == [False] * (landing.TRIGGER_TICKS - 1) + [True]
    assert (arming.landed, arming.landed_maybe) == (True, True)
    arming.landed, arming.landed_ticks = False, 300
    assert not landing.count_rest(arming, False)
    assert (arming.landed_ticks, arming.landed_maybe) == (0, False)


def test_a_crash_is_a_lean_far_off_without_speed() -> None:
    attitude, detector = AttitudeState(), LandingState()
    attitude.thrust_error_angle, attitude.cos_lean = math.radians(40.0), 0.5
    assert crash.is_crashed(attitude, detector, Vec3(1.0, 0.0, 0.0))
    assert not crash.is_crashed(attitude, detector, Vec3(11.0, 0.0, 0.0))
    detector.acc = Vec3(0.0, 0.0, 4.0)
    assert not crash.is_crashed(attitude, detector, Vec3(1.0, 0.0, 0.0))


def touch(v):
    """All signs of the ground."""
    ap = v.autopilot
    ap.control.motors.limit_throttle_lower = 1
    ap.control.attitude.mix = ap.params.ATC_THR_MIX_MIN
    return v


def ticks(v, n, law=landing.detect):
    for _ in range(n):
        law(v)


@pytest.mark.parametrize(
    ("mode", "behaviour", "armed"),
    ((LOITER, 0, True), (LOITER, 4, False), (ALT_HOLD, 4, False), (STABILIZE, 4, True), (LAND, 4, True)),
)
def test_a_landing_may_disarm(flying, mode, behaviour, armed):
    touch(fly(flying, mode))
    flying.autopilot.params.PILOT.THR_BHV = behaviour
    ticks(flying, 400)
    assert flying.autopilot.arming.landed == 1
    assert flying.autopilot.arming.armed == armed


def test_landed_after_a_second_on_the_ground(flying):
    touch(fly(flying, LAND))
    arming = flying.autopilot.arming
    ticks(flying, 79)
    assert (arming.landed, arming.landed_maybe) == (0, 0)
    ticks(flying, 1)
    assert (arming.landed, arming.landed_maybe) == (0, 1)
    ticks(flying, 319)
    assert arming.landed == 0
    ticks(flying, 1)
    assert arming.landed == 1
    assert codes(flying) == [LANDED]


@pytest.mark.parametrize(
    "lift",
    (
        lambda ap: setattr(ap.control.motors, "limit_throttle_lower", 0),
        lambda ap: setattr(ap.control.attitude, "mix", 0.5),
        lambda ap: setattr(ap.estimate, "vel", ap.estimate.vel.replace(z=1.1)),
        lambda ap: setattr(ap.estimate, "acc_ned", ap.estimate.acc_ned.replace(z=9.8)),
    ),
)
def test_any_sign_of_flight_starts_the_second_again(flying, lift):
    touch(fly(flying, LAND))
    ticks(flying, 300)
    lift(flying.autopilot)
    ticks(flying, 300)
    assert flying.autopilot.arming.landed == 0
    assert flying.autopilot.arming.landed_ticks < 300


LEANS = (
    lambda ap: setattr(ap.control.attitude, "target_euler", (math.radians(16.0), 0.0, 0.0)),
    lambda ap: setattr(ap.control.attitude, "thrust_error_angle", math.radians(31.0)),
)


@pytest.mark.parametrize("lean", LEANS)
@pytest.mark.parametrize(
    ("mode", "throttle_zero", "landed"),
    [(LAND, 0, 1), (GUIDED, 1, 0), (LOITER, 1, 1), (LOITER, 0, 0), (ALT_HOLD, 1, 1)],
)
def test_leaning_counts_as_flight_unless_it_is_meant_to_land(flying, lean, mode, throttle_zero, landed):
    """On the ground the position controller leans against the wind."""
    touch(fly(flying, mode))
    flying.autopilot.modes.pilot.throttle_zero = throttle_zero
    lean(flying.autopilot)
    ticks(flying, 400)
    assert flying.autopilot.arming.landed == landed


def test_a_disarmed_vehicle_is_landed(flying):
    flying.autopilot.arming.armed = 0
    landing.detect(flying)
    assert flying.autopilot.arming.landed == 1


def test_throttle_above_half_of_hover_takes_off_but_not_while_a_take_off_ramps(flying):
    ap = flying.autopilot
    ap.arming.landed = 1
    ap.control.motors.throttle = 0.3
    ap.modes.guided.submode = 0  # TAKEOFF
    landing.detect(flying)
    assert ap.arming.landed == 1
    ap.modes.number = ALT_HOLD
    landing.detect(flying)
    assert ap.arming.landed == 0


@pytest.mark.parametrize(
    ("mode", "throttle", "descent", "mix"),
    (
        (STABILIZE, 0.0, 0.0, "ATC_THR_MIX_MIN"),
        (STABILIZE, 0.4, 0.0, "ATC_THR_MIX_MAN"),
        (GUIDED, 0.0, 0.0, "ATC_THR_MIX_MAX"),
        (GUIDED, 0.0, 0.5, "ATC_THR_MIX_MIN"),
        (LAND, 0.0, 0.0, "ATC_THR_MIX_MIN"),
    ),
)
def test_throttle_priority(flying, mode, throttle, descent, mix):
    fly(flying, mode)
    ap = flying.autopilot
    ap.modes.pilot.throttle, ap.control.pos_d.vel_desired, ap.control.pos_d.control_ratio = (
        throttle,
        descent,
        1.0,
    )
    landing.detect(flying)
    landing.set_priority(ap.control, ap.arming, ap.modes, ap.estimate.vel.z, ap.params.ATC)
    assert ap.control.attitude.mix_desired == pytest.approx(float(ap.params[mix]))


def tumble(v):
    attitude = v.autopilot.control.attitude
    attitude.thrust_error_angle, attitude.cos_lean = math.radians(40.0), 0.5
    return v


def test_two_seconds_on_its_side_disarm(flying):
    tumble(flying)
    ticks(flying, 799, crash.check)
    assert flying.autopilot.arming.armed == 1
    ticks(flying, 1, crash.check)
    assert flying.autopilot.arming.armed == 0
    assert codes(flying)[0] == CRASH_DISARM
    assert crash.text(40.2, 0.04) == "Crash: Disarming: AngErr=40>30, Accel=0.0<3.0"


@pytest.mark.parametrize(
    "well",
    (
        lambda ap: setattr(ap.control.attitude, "thrust_error_angle", 0.5),
        lambda ap: setattr(ap.control.attitude, "cos_lean", 0.97),
        lambda ap: setattr(ap.modes.landing, "acc", Vec3(0.0, 0.0, 3.1)),
        lambda ap: setattr(ap.estimate, "vel", ap.estimate.vel.replace(x=11.0)),
        lambda ap: setattr(ap.params, "FS_CRASH_CHECK", 0.0),
        lambda ap: setattr(ap.arming, "landed", 1),
    ),
)
def test_no_crash(flying, well):
    tumble(flying)
    well(flying.autopilot)
    ticks(flying, 900, crash.check)
    assert flying.autopilot.arming.armed == 1


def lie(v):
    """Level on the ground with motors at their least, asked for a lean of 31 degrees."""
    ap = v.autopilot
    ap.control.motors.limit_throttle_lower = 1
    ap.control.attitude.thrust_error_angle, ap.control.attitude.cos_lean = math.radians(31.0), 1.0
    ap.estimate.vel = ap.estimate.rates = Vec3(0.0, 0.0, 0.0)
    ap.modes.landing.acc = Vec3(0.0, 0.0, 0.0)
    return v


def test_five_seconds_of_lying_still_disarm(flying):
    lie(flying)
    ticks(flying, 1999, crash.check)
    assert flying.autopilot.arming.armed == 1
    ticks(flying, 1, crash.check)
    assert flying.autopilot.arming.armed == 0
    assert codes(flying)[0] == CRASH_DISARM
    assert crash.text(20.0, 0.04) == "Crash: Disarming: at rest, AngErr=20"


@pytest.mark.parametrize(
    "moves",
    (
        lambda ap: setattr(ap.control.motors, "limit_throttle_lower", 0),
        lambda ap: setattr(ap.control.attitude, "thrust_error_angle", 0.1),
        lambda ap: setattr(ap.modes.landing, "acc", Vec3(0.0, 0.0, 0.6)),
        lambda ap: setattr(ap.estimate, "vel", Vec3(0.0, 0.4, 0.0)),
        lambda ap: setattr(ap.estimate, "rates", Vec3(0.0, 0.0, 0.1)),
        lambda ap: setattr(ap.params, "FS_CRASH_CHECK", 0.0),
    ),
)
def test_what_lifts_or_moves_does_not_lie_still(flying, moves):
    lie(flying)
    moves(flying.autopilot)
    ticks(flying, 2100, crash.check)
    assert flying.autopilot.arming.armed == 1
