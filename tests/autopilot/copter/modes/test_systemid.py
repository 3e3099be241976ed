# SPDX-License-Identifier: BSD-3-Clause
"""SYSTEMID: from where it is entered, what ends its chirp, and what the chirp is added to."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control import attitude
from sitl.autopilot.copter.modes import systemid
from sitl.autopilot.copter.modes.systemid import Chirp
from sitl.autopilot.modes import ModeResult
from sitl.core.vectors import Vec2
from tests.autopilot.copter.steady_copter import codes, fly, make, told, turn_to

CHIRP = Chirp(2.0, 2.0 * math.pi * 0.5, 2.0 * math.pi * 8.0, 4.0, 3.0, 20.0, 2.0)


def identifying(axis: int, mode: int | None = None) -> Any:
    """A vehicle that has just entered the mode, with a chirp of 2."""
    v = fly(make(), mode if mode is not None else 5 if 14 <= axis <= 19 else 0)
    p = v.autopilot.params.SID
    p.AXIS, p.MAGNITUDE, p.F_START_HZ, p.F_STOP_HZ = float(axis), 2.0, 0.5, 8.0
    p.T_FADE_IN, p.T_REC, p.T_FADE_OUT = 3.0, 20.0, 2.0
    assert systemid.start(v) == ModeResult.ACCEPTED
    return v


def test_the_parameters_make_the_chirp() -> None:
    v = identifying(1)
    assert systemid.chirp_of(v.autopilot.params.SID) == pytest.approx(CHIRP)
    v.autopilot.params.SID.F_START_HZ = 0.0
    assert systemid.chirp_of(v.autopilot.params.SID).constant == 0.0


@pytest.mark.parametrize(
    ("field", "value", "possible"),
    (
        ("first", 0.0, False),
        ("last", 0.0, False),
        ("fade_in", 0.0, True),
        ("fade_in", -0.1, False),
        ("fade_out", 0.0, True),
        ("fade_out", -0.1, False),
        ("length", 4.0, False),
        ("length", 4.1, True),
    ),
)
def test_which_chirps_there_are(field: str, value: float, possible: bool) -> None:
    assert systemid.is_possible(CHIRP._replace(**{field: value})) == possible


@pytest.mark.parametrize(
    ("t", "share"),
    (
        (-0.1, 0.0),
        (0.0, 0.0),
        (0.75, 0.5 - 0.5 * math.cos(math.pi / 4)),
        (1.5, 0.5),
        (3.0, 1.0),
        (10.0, 1.0),
        (18.0, 1.0),
        (18.5, 0.5 + 0.5 * math.cos(math.pi / 4)),
        (19.0, 0.5),
        (20.0, 0.0),
        (20.1, 0.0),
    ),
)
def test_it_fades_in_and_out(t: float, share: float) -> None:
    assert systemid.loudness(CHIRP, t) == pytest.approx(share, abs=1e-12)


def test_its_phase_is_the_integral_of_its_frequency_which_rises_by_equal_factors() -> None:
    assert systemid.frequency(CHIRP, 0.0) == systemid.frequency(CHIRP, 4.0) == CHIRP.first
    assert systemid.frequency(CHIRP, 12.0) == pytest.approx(math.sqrt(CHIRP.first * CHIRP.last))
    assert systemid.frequency(CHIRP, 20.0) == systemid.frequency(CHIRP, 25.0) == pytest.approx(CHIRP.last)
    assert systemid.phase(CHIRP, 4.0) == 0.0
    for t in (0.5, 3.0, 5.0, 11.0, 19.0):
        slope = (systemid.phase(CHIRP, t + 1e-5) - systemid.phase(CHIRP, t - 1e-5)) / 2e-5
        assert slope == pytest.approx(systemid.frequency(CHIRP, t), rel=1e-6)
    tone = CHIRP._replace(last=CHIRP.first)
    assert systemid.phase(tone, 10.0) == pytest.approx(CHIRP.first * 6.0)
    assert systemid.value(CHIRP, 10.0) == pytest.approx(2.0 * math.sin(systemid.phase(CHIRP, 10.0)))
    assert systemid.value(CHIRP, 19.0) == pytest.approx(math.sin(systemid.phase(CHIRP, 19.0)))


@pytest.mark.parametrize(
    ("axis", "mode", "armed", "landed", "why"),
    (
        (0, 0, 1, 0, systemid.REFUSED_NO_AXIS),
        (1, 0, 0, 0, systemid.REFUSED_ON_GROUND),
        (1, 0, 1, 1, systemid.REFUSED_ON_GROUND),
        (1, 0, 1, 0, 0),
        (13, 1, 1, 0, 0),
        (13, 5, 1, 0, systemid.REFUSED_AUTOMATIC),
        (14, 5, 1, 0, 0),
        (19, 5, 1, 0, 0),
        (14, 0, 1, 0, systemid.REFUSED_BY_SPEED),
        (19, 0, 1, 0, systemid.REFUSED_BY_SPEED),
        (20, 0, 1, 0, 0),
    ),
)
def test_from_where_it_may_be_entered(axis: int, mode: int, armed: int, landed: int, why: int) -> None:
    v = fly(make(), mode)
    v.autopilot.arming.armed, v.autopilot.arming.landed, v.autopilot.params.SID.AXIS = armed, landed, float(axis)
    state = v.autopilot.modes.systemid
    state.time = 7.0
    v.autopilot.control.pos_ne.pos_desired = Vec2(3.0, 4.0)
    assert systemid.start(v) == (ModeResult.INIT_FAILED if why else ModeResult.ACCEPTED)
    assert told(v, systemid.SYSTEM_ID_DID) == [(float(why), 0.0) if why else (0.0, float(axis))]
    if not why:
        assert (state.time, bool(state.testing), tuple(state.hold_pos)) == (0.0, True, (3.0, 4.0))
        assert bool(state.holds_position) == (14 <= axis <= 19)


def test_the_chirp_begins_a_second_after_the_mode() -> None:
    v = identifying(1)
    state = v.autopilot.modes.systemid
    values = [systemid.sample(v) for _ in range(1200)]
    assert values[:400] == [0.0] * 400 and values[401] != 0.0
    assert state.time == pytest.approx(3.0)
    assert values[-1] == pytest.approx(systemid.value(CHIRP, 2.0), abs=1e-9)
    assert state.frequency == pytest.approx(CHIRP.first)


@pytest.mark.parametrize(
    ("change", "did"),
    (
        ("none", -1),
        ("landed", systemid.LANDED),
        ("leans", systemid.LEANS),
        ("over", systemid.FINISHED),
        ("no axis", systemid.NO_AXIS),
        ("parameters", systemid.BAD_PARAMETERS),
    ),
)
def test_what_ends_the_chirp(change: str, did: int) -> None:
    v = identifying(1)
    ap = v.autopilot
    state = ap.modes.systemid
    state.time = 1.0 + 3.0 + 4.0 + 20.0 + 2.0 - 0.0026  # as long as ArduPilot waits
    ap.params.ANGLE_MAX = 3000.0
    ap.control.attitude.cos_lean = math.cos(math.radians(29.9))
    systemid.sample(v)
    assert state.testing
    state.time = 5.0
    if change == "landed":
        ap.arming.landed = 1
    elif change == "leans":
        ap.control.attitude.cos_lean = math.cos(math.radians(30.1))
    elif change == "over":
        state.time = 30.0
    elif change == "no axis":
        ap.params.SID.AXIS = 0.0
    elif change == "parameters":
        ap.params.SID.F_STOP_HZ = 0.0
    value = systemid.sample(v)
    said = told(v, systemid.SYSTEM_ID_DID)[1:]
    assert [int(a) for a, _ in said] == ([did] if did >= 0 else [])
    assert (value == 0.0) == (did >= 0) and bool(state.testing) == (did < 0)
    if change == "leans":
        assert said[0][1] == pytest.approx(30.1)
    assert systemid.sample(v) == 0.0 or did < 0
    assert len(told(v, systemid.SYSTEM_ID_DID)) == 1 + (did >= 0)


def test_samples_are_logged_every_fourth_tick_while_it_tests() -> None:
    v = identifying(1)
    for k in range(12):
        v.autopilot.control.tick = k
        systemid.run(v)
    assert codes(v).count(int(systemid.SYSTEM_ID_SAMPLE)) == 3
    v.autopilot.modes.systemid.testing = False
    for k in range(8):
        v.autopilot.control.tick = k
        systemid.run(v)
    assert codes(v).count(int(systemid.SYSTEM_ID_SAMPLE)) == 3


@pytest.mark.parametrize("axis", range(1, 14))
def test_by_hand_the_chirp_is_added_to_one_thing(axis: int, monkeypatch: pytest.MonkeyPatch) -> None:
    v = identifying(axis)
    ap = v.autopilot
    ap.modes.pilot.yaw_rate, ap.params.ATC.RATE_FF_ENAB = 0.5, 1.0
    ap.modes.pilot.throttle_zero = False
    seen: dict[str, Any] = {}

    def shape(control: Any, est: Any, p: Any, lean: Any, rate: float) -> None:
        seen.update(lean=tuple(lean), rate=rate, feed_forward=p.ATC.RATE_FF_ENAB)

    def thrust(control: Any, p: Any, throttle: float, *rest: Any) -> None:
        seen.update(throttle=throttle)

    monkeypatch.setattr(attitude, "input_euler_roll_pitch_yaw_rate", shape)
    monkeypatch.setattr(systemid.throttle_mix, "set_throttle_out", thrust)
    systemid.run_by_hand(v, axis, 0.0)
    idle = seen["throttle"]
    ap.control.motors.excited = False
    systemid.run_by_hand(v, axis, 2.0)
    angle = math.radians(2.0)
    assert seen["lean"] == (angle if axis in (1, 4) else 0.0, angle if axis in (2, 5) else 0.0)
    assert seen["rate"] == pytest.approx(0.5 + (angle if axis in (3, 6) else 0.0))
    assert seen["feed_forward"] == (0.0 if axis in (4, 5, 6) else 1.0)
    assert ap.params.ATC.RATE_FF_ENAB == 1.0
    assert seen["throttle"] - idle == pytest.approx(2.0 if axis == 13 else 0.0)
    rates = [0.0] * 3
    if 7 <= axis <= 9:
        rates[axis - 7] = angle
    assert list(ap.control.attitude.rate_target) == pytest.approx(rates)
    assert bool(ap.control.motors.excited) == (10 <= axis <= 12)
    if 10 <= axis <= 12:
        assert [float(x) for x in ap.control.motors.excitation] == [2.0 if k == axis - 10 else 0.0 for k in range(3)]
    ap.modes.systemid.testing = False
    systemid.run_by_hand(v, axis, 0.0)
    assert seen["feed_forward"] == 1.0


@pytest.mark.parametrize("axis", range(14, 20))
def test_in_place_the_chirp_disturbs_what_is_measured_or_moves_the_place(
    axis: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    v = identifying(axis)
    disturbed: list[bool] = []  # when the controller runs: it takes the disturbance back
    monkeypatch.setattr(systemid.position, "update_ne", lambda control, *_: disturbed.append(control.pos_ne.disturbed))
    turn_to(v, 0.5 * math.pi)  # forward is east, right is south
    place, state = v.autopilot.control.pos_ne, v.autopilot.modes.systemid
    start = tuple(state.hold_pos)
    systemid.run_at_position(v, axis, 0.4)
    push = (0.0, 0.4) if axis in (15, 17, 19) else (-0.4, 0.0)
    zero = (0.0, 0.0)
    assert disturbed == [axis <= 17]
    assert tuple(place.disturbance_pos) == pytest.approx(push if axis <= 15 else zero, abs=1e-12)
    assert tuple(place.disturbance_vel) == pytest.approx(push if axis >= 16 else zero, abs=1e-12)
    moved = push if axis >= 18 else zero
    assert tuple(state.vel) == pytest.approx(moved, abs=1e-12)
    assert tuple(state.acc) == pytest.approx([x / 0.0025 for x in moved], abs=1e-9)
    assert [a - b for a, b in zip(state.hold_pos, start, strict=True)] == pytest.approx(
        [x * 0.0025 for x in moved], abs=1e-12
    )


def test_the_place_moves_with_the_speed_asked_for() -> None:
    v = identifying(18)
    state = v.autopilot.modes.systemid
    for _ in range(4):
        systemid.follow_speed(state, Vec2(2.0, -1.0))
    assert tuple(state.hold_pos) == pytest.approx((0.02, -0.01))
    assert tuple(state.acc) == (0.0, 0.0)


def test_its_texts() -> None:
    assert systemid.text(systemid.LEANS, 31.5, 30.0) == "SystemID Stopped: lean=31.500000 max=30.000000"
    assert systemid.text(systemid.STARTED, 7.0, 30.0) == "SystemID Starting: axis=7"
    assert systemid.text(systemid.REFUSED_BY_SPEED, 0.0, 30.0) == "Axis requires switch from Loiter"
