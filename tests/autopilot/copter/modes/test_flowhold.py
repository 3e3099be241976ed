# SPDX-License-Identifier: BSD-3-Clause
"""FLOWHOLD: what flow it believes, how it brakes, and how it learns the wind."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control.attitude import Lean
from sitl.autopilot.copter.modes import flowhold
from sitl.autopilot.modes import ModeResult
from sitl.autopilot.optical_flow import is_healthy
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.steady_copter import fly, make, turn_to, wait

CENTRED = Lean(0.0, 0.0)
HELD = Lean(0.2, 0.0)


def holding() -> Any:
    """A vehicle with a sensor that works, in FLOWHOLD since now."""
    v = fly(make(), 2)
    ap = v.autopilot
    ap.params.FLOW.TYPE = 10.0

    ap.flow.quality = 255
    return v


def advance(v: Any, stick: Lean, vel: Vec2) -> Lean:
    """One tick."""
    ap = v.autopilot
    return flowhold.advance(ap.modes.flowhold, stick, vel, ap.estimate, v.time_us, ap.params)


def test_velocity_is_flow_times_height_and_not_less_than_that_of_10_cm() -> None:
    v = holding()
    state = v.autopilot.modes.flowhold
    state.shown = Vec2(0.2, 0.5)
    assert tuple(flowhold.velocity(state, 4.0)) == pytest.approx((2.0, -0.8))
    assert tuple(flowhold.velocity(state, -3.0)) == tuple(flowhold.velocity(state, 0.1)) == pytest.approx((0.05, -0.02))


@pytest.mark.parametrize("vel", (0.29, 0.31))
def test_let_go_it_brakes_until_it_is_slow(vel: float) -> None:
    v = holding()
    state = v.autopilot.modes.flowhold
    advance(v, HELD, Vec2(2.0, 0.0))
    assert state.braking and state.brake_us == v.time_us
    wait(v, 0.1)
    advance(v, CENTRED, Vec2(0.0, vel))
    assert bool(state.braking) == (vel > 0.3)


def test_it_brakes_for_three_seconds_at_most() -> None:
    v = holding()
    state = v.autopilot.modes.flowhold
    advance(v, Lean(0.0, 0.1), Vec2(2.0, 0.0))
    wait(v, 3.0)
    advance(v, CENTRED, Vec2(2.0, 0.0))
    assert state.braking
    v.time_us += 1
    advance(v, CENTRED, Vec2(2.0, 0.0))
    assert not state.braking


def test_under_the_stick_a_lean_in_proportion_to_the_speed_drags() -> None:
    v = holding()
    p = v.autopilot.params
    p.FHLD.XY_P, p.ANGLE_MAX = 0.2, 3000.0
    lean = advance(v, HELD, Vec2(1.0, 0.5))
    most = math.radians(30.0)
    assert (lean.roll, lean.pitch) == pytest.approx((0.2 - 0.2 * most * 0.5, 0.2 * most * 1.0))
    fast = advance(v, HELD, Vec2(30.0, 0.0))
    assert fast.pitch == pytest.approx(0.5 * most)  # no more than half of ANGLE_MAX
    assert tuple(v.autopilot.modes.flowhold.against_wind) == (0.0, 0.0)


def test_the_wind_is_learnt_at_rest_in_north_and_east_with_limits() -> None:
    v = holding()
    ap = v.autopilot
    p, state = ap.params, ap.modes.flowhold
    p.ANGLE_MAX, p.FHLD.XY_I, p.FHLD.XY_IMAX, p.FHLD.XY_P = 3000.0, 0.3, 1000.0, 0.0
    turn_to(v, 0.5 * math.pi)
    state.braking = False
    wait(v, 10.0)
    lean = advance(v, CENTRED, Vec2(0.2, 0.0))  # forward is east
    most = math.radians(30.0)
    assert tuple(state.against_wind) == pytest.approx((0.0, 0.0025 * 0.3 * most * 0.2), abs=1e-12)
    assert (lean.roll, lean.pitch) == pytest.approx((0.0, 0.0025 * 0.3 * most * 0.2), abs=1e-12)
    for imax, limit in ((1000.0, 10.0), (9000.0, 30.0)):
        p.FHLD.XY_IMAX = imax
        state.against_wind = Vec2(9.0, 0.0)
        flowhold.learn_wind(state, Vec2(0.0, 0.0), most, p.FHLD)
        assert tuple(state.against_wind) == pytest.approx((math.radians(limit), 0.0))


def test_while_it_brakes_it_does_not_learn() -> None:
    v = holding()
    state = v.autopilot.modes.flowhold
    advance(v, HELD, Vec2(2.0, 0.0))
    wait(v, 0.5)
    lean = advance(v, CENTRED, Vec2(2.0, -1.0))
    assert tuple(state.against_wind) == (0.0, 0.0)
    assert lean.pitch > 0.0 and lean.roll > 0.0  # nose up and to the right, against a way ahead and to the left


@pytest.mark.parametrize(("quality", "least", "believed"), ((100, 100.0, True), (99, 100.0, False)))
def test_flow_of_poor_quality_fades(
    quality: int, least: float, believed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    v = holding()
    ap = v.autopilot
    state, flow, p = ap.modes.flowhold, ap.flow, ap.params.FHLD
    monkeypatch.setattr(flowhold, "is_healthy", lambda flow, time_us: True)
    flow.quality, p.QUAL_MIN, p.FILT_HZ, p.FLOW_MAX = quality, least, 5.0, 0.6
    flow.rate, flow.body = Vec2(0.5, 0.2), Vec2(0.2, 0.2)
    state.shown = Vec2(0.1, 0.0)
    flowhold.filter_flow(state, flow, v.time_us, p)
    gain = 0.0025 / (0.0025 + 1.0 / (2.0 * math.pi * 5.0))
    assert tuple(state.shown) == pytest.approx((0.1 + gain * ((0.3 if believed else 0.0) - 0.1), 0.0))
    flow.rate = Vec2(0.2, 5.0)
    state.shown = Vec2(0.0, 0.0)
    flowhold.filter_flow(state, flow, v.time_us, p)
    assert tuple(state.shown) == pytest.approx((0.0, gain * 0.6 if believed else 0.0))


@pytest.mark.parametrize("healthy", (True, False))
def test_it_needs_a_sensor_that_works_to_begin_and_begins_level(healthy: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    v = holding()
    state = v.autopilot.modes.flowhold
    monkeypatch.setattr(flowhold, "is_healthy", lambda flow, time_us: healthy)
    state.shown, state.against_wind = Vec2(1.0, 1.0), Vec2(1.0, 1.0)
    assert flowhold.start(v) == (ModeResult.ACCEPTED if healthy else ModeResult.INIT_FAILED)
    assert (tuple(state.shown) == tuple(state.against_wind) == (0.0, 0.0)) == healthy
    if healthy:
        assert state.braking and state.brake_us == v.time_us


def test_a_vehicle_without_flow_has_none() -> None:
    assert not is_healthy(make().autopilot.flow, 60_000_000)


@pytest.mark.parametrize(("landed", "flies"), ((0, True), (1, False)))
def test_on_the_ground_it_forgets_what_it_learnt(landed: int, flies: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    v = holding()
    ap = v.autopilot
    ap.arming.landed, ap.modes.pilot.throttle = landed, 0.5
    state = ap.modes.flowhold
    state.shown, state.against_wind = Vec2(1.0, 1.0), Vec2(0.1, 0.1)
    ap.estimate.pos, ap.ekf.ground_d = Vec3(0.0, 0.0, -5.0), 0.0
    flowhold.run(v)
    assert (tuple(state.against_wind) != (0.0, 0.0)) == flies
    assert (tuple(state.shown) != (0.0, 0.0)) == flies
