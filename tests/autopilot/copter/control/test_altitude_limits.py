# SPDX-License-Identifier: BSD-3-Clause
"""Where height control starts from, its limits, and how a vibrating vehicle is held."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.control.pid import Blocked
from sitl.autopilot.control.shaping import Motion
from sitl.autopilot.copter.control import altitude, altitude_start, position
from sitl.autopilot.copter.control.state import DT, AltitudeState
from sitl.core.constants import GRAVITY
from sitl.core.vectors import Vec3
from tests.autopilot.copter.control.level_autopilot import moving, parts

POS_GAINS = position.PositionGains(1.0, position.Gains(2.0, 0.5, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("gain", "accel", "vel", "wanted"),
    (
        (1.0, 1.0, -1.0, -31.0),
        (1.0, 1.0, 1.0, -29.0),
        (1.0, 1.0, -9.0, -33.0),  # 3 m up at the most
        (1.0, 1.0, 9.0, -28.0),  # 2 m down
        (0.0, 1.0, 1.0, -30.0),
        (1.0, 0.0, 1.0, -30.0),
    ),
)
def test_the_height_where_it_stops(ap: Any, gain: float, accel: float, vel: float, wanted: float) -> None:
    control = moving(ap)
    ap.params.PSC.POSZ_P, control.pos_d.accel_max = gain, accel
    ap.estimate.vel = Vec3(0.0, 0.0, vel)
    assert altitude_start.stopping_point_d(control.pos_d, ap.estimate, ap.params.PSC) == wanted


@pytest.mark.parametrize(("vel", "acc", "kept"), ((1.5, 0.5, (0.0, 0.0)), (-1.5, -0.5, (-1.5, -0.5))))
def test_a_start_without_a_descent_keeps_a_climb(ap: Any, vel: float, acc: float, kept: tuple[float, float]) -> None:
    control = moving(ap)
    ap.estimate.vel, ap.estimate.acc_ned = Vec3(0.0, 0.0, vel), Vec3(0.0, 0.0, acc)
    altitude_start.init_d_no_descent(*parts(ap))
    c = control.pos_d
    assert (c.vel_desired, c.vel_target) == (kept[0], kept[0])
    assert (c.accel_desired, c.accel_target) == (kept[1], kept[1])


@pytest.mark.parametrize(("measured", "kept"), ((0.4, 0.4), (9.0, 1.0), (-9.0, -1.0), (math.nan, 0.0)))
def test_height_control_starts_with_the_present_acceleration_within_its_limit(
    ap: Any, measured: float, kept: float
) -> None:
    control = moving(ap)
    ap.estimate.acc_ned = Vec3(0.0, 0.0, measured)
    c = control.pos_d
    c.pos_error, c.limit, c.vel.integrator, c.vel.started, c.accel.started = 1.0, 1.0, 1.0, True, True
    altitude_start.init_d(*parts(ap))
    assert (c.pos_desired, c.vel_desired, c.vel_target) == (-30.0, -1.5, -1.5)
    assert (c.accel_target, c.accel_desired) == (kept, kept)
    assert (c.pos_error, c.limit, c.vel.integrator, c.vel.started, c.accel.started) == (0.0, 0.0, 0.0, 0, 0)
    assert (c.reset_count, c.last_tick) == (4, 100)


@pytest.mark.parametrize(("measured", "feed_forward"), ((0.4, 0.0), (9.0, 0.0), (-0.5, 0.3), (0.0, 0.3)))
def test_height_control_starts_without_a_jump_of_the_throttle(ap: Any, measured: float, feed_forward: float) -> None:
    """Whatever P and feed-forward give at once."""
    moving(ap)
    ap.control.attitude.throttle_in = 0.42
    ap.params.PSC.ACCZ.FF, ap.params.PSC.ACCZ.I = feed_forward, 1e-9
    ap.params.PSC.ACCZ.FLTE = ap.params.PSC.ACCZ.FLTT = 0.0
    ap.estimate.acc_ned = Vec3(0.0, 0.0, measured)
    altitude_start.init_d(*parts(ap))
    altitude.update_d(*parts(ap))
    assert ap.control.attitude.throttle_in == pytest.approx(0.42, abs=1e-6)


def test_on_the_ground_the_throttle_decays_to_what_is_asked_for(ap: Any) -> None:
    control = moving(ap)
    control.attitude.throttle_in = 0.4
    altitude_start.relax_d(*parts(ap), 0.1)
    hover = ap.params.MOT.THST_HOVER
    decayed = 0.4 + (0.1 - 0.4) * DT / (DT + 0.16)
    assert hover - control.pos_d.accel.integrator == pytest.approx(decayed, abs=1e-6)


@pytest.mark.parametrize(
    ("jerk", "target_hz", "error_hz", "accel", "wanted"),
    (
        (5.0, 0.0, 0.0, 1.0, 5.0),
        (0.0, 0.0, 0.0, 1.0, 0.01),
        (50.0, 2.0, 0.0, 1.0, 2.0 * math.tau / 5.0),
        (50.0, 0.0, 3.0, 1.0, 3.0 * math.tau / 5.0),
        (50.0, 2.0, 1.0, 1.0, 1.0 * math.tau / 5.0),
        (500.0, 2.0, 0.0, 99.0, 2.0 * GRAVITY * math.tau / 5.0),
        (1.0, 20.0, 20.0, 1.0, 1.0),
    ),
)
def test_vertical_jerk_is_what_the_acceleration_loop_lets_through(
    ap: Any, jerk: float, target_hz: float, error_hz: float, accel: float, wanted: float
) -> None:
    p = ap.params.PSC
    p.JERK_Z, p.ACCZ.FLTT, p.ACCZ.FLTE = jerk, target_hz, error_hz
    assert altitude_start.jerk_limit_d(p, accel) == pytest.approx(wanted)


def test_vertical_limits_are_sizes(ap: Any) -> None:
    c = ap.control.pos_d
    altitude_start.set_max_speed_accel_d(c, ap.params.PSC, -1.5, -2.5, -1.0)
    assert (c.speed_down, c.speed_up, c.accel_max) == (1.5, 2.5, 1.0)
    assert (c.correction_speed_down, c.correction_speed_up, c.correction_accel) == (1.5, 2.5, 1.0)
    altitude_start.set_max_speed_accel_d(c, ap.params.PSC, 1.5, 2.5, 0.0)
    assert (c.accel_max, c.correction_accel) == (0.01, 0.0)


@pytest.mark.parametrize(
    ("vel", "down", "up", "gain"),
    ((3.0, 1.5, 2.5, 4.0), (-5.0, 1.5, 2.5, 4.0), (1.5, 1.5, 2.5, 1.0), (-2.5, 1.5, 2.5, 1.0), (3.0, 0.0, 2.5, 1.0)),
)
def test_above_its_speed_the_path_brakes_harder(vel: float, down: float, up: float, gain: float) -> None:
    c = AltitudeState()
    c.vel_desired, c.speed_down, c.speed_up, c.accel_max, c.jerk_max = vel, down, up, 1.0, 10.0
    assert altitude.overspeed_gain(c) == pytest.approx(gain)
    limits = altitude.shaping_limits_d(c, 2.0, 1.0)
    assert limits == pytest.approx((-2.0, 1.0, -gain, min(gain, 7.5), 10.0 * gain))


def test_it_never_falls_faster_than_three_quarters_of_gravity() -> None:
    c = AltitudeState()
    c.accel_max = 20.0
    assert altitude.shaping_limits_d(c, 2.0, 1.0)[2:4] == (-20.0, 7.5)


@pytest.mark.parametrize(
    ("error", "down", "up", "kept"),
    (
        (9.0, 2.0, 3.0, 2.5),  # sqrt law: 0.5 + 4 / 2
        (-9.0, 2.0, 3.0, -5.0),
        (9.0, 0.0, 3.0, 9.0),  # no limit
        (-9.0, 2.0, 0.0, -9.0),
        (1.0, 2.0, 3.0, 1.0),
        (math.nan, 2.0, 3.0, 0.0),
    ),
)
def test_the_path_in_height_waits_for_a_vehicle_that_cannot_keep_up(
    error: float, down: float, up: float, kept: float
) -> None:
    c = AltitudeState()
    c.pos_desired, c.correction_speed_down, c.correction_speed_up, c.correction_accel = 4.0 + error, down, up, 1.0
    altitude.control_altitude(c, 4.0, 1.0)
    assert c.pos_error == pytest.approx(kept)
    if math.isfinite(error):
        assert c.pos_desired == pytest.approx(4.0 + kept)


@pytest.mark.parametrize(("ignore", "kept"), ((True, 0.0), (False, 1.0)))
def test_a_landing_may_go_on_at_the_least_throttle(ignore: bool, kept: float) -> None:
    c = AltitudeState()
    c.accel_max, c.jerk_max, c.limit = 1.0, 5.0, 1.0
    altitude.land_at_rate_d(c, 0.5, ignore)
    assert c.limit == kept and c.accel_desired == pytest.approx(5.0 * DT)
    c.limit = -1.0
    altitude.land_at_rate_d(c, 0.5, True)
    assert c.limit == -1.0, "not at the greatest"


@pytest.mark.parametrize(
    ("blocked", "limit"), ((Blocked(False, False), 0.0), (Blocked(True, False), 1.0), (Blocked(False, True), -1.0))
)
def test_a_vibrating_vehicle_is_held_by_its_speed(blocked: Blocked, limit: float) -> None:
    c = AltitudeState()
    gains = altitude.AltitudeGains(1.0, POS_GAINS.vel, POS_GAINS.vel)
    c.pos_desired, c.speed_down, c.control_ratio = -1.0, 1.5, 1.0
    off = altitude.control_vibrating(c, Motion(0.0, 0.5, 9.0), blocked, gains, 0.35)
    assert off < 0.0, "more throttle: it is below its path and sinks"
    assert c.vel_target == -1.0 and c.limit == limit
    assert c.control_ratio == pytest.approx(1.0 - 0.05 * DT), "falls while a descent is not held"


def test_a_vehicle_that_vibrates_is_controlled_by_the_rate_of_its_height(ap: Any) -> None:
    moving(ap)
    ap.estimate.vel, ap.estimate.acc_ned = Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 50.0)
    ap.control.vibration.found, ap.control.vibration.vel = True, -2.0
    altitude_start.init_d(*parts(ap))
    altitude.update_d(*parts(ap))
    assert ap.control.pos_d.vel.error == pytest.approx(2.0)
    assert ap.control.attitude.throttle_in < ap.params.MOT.THST_HOVER, "it climbs"


def test_height_control_filters_its_throttle_at_two_hertz_and_keeps_the_lift_in_a_lean(ap: Any) -> None:
    moving(ap)
    ap.control.attitude.cos_lean, ap.control.attitude.throttle_in = 0.5, 0.3
    altitude.update_d(*parts(ap))
    assert ap.control.motors.throttle_filter_hz == 2.0
    assert ap.control.motors.throttle_in == pytest.approx(2.0 * ap.control.attitude.throttle_in)
