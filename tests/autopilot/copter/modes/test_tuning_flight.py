# SPDX-License-Identifier: BSD-3-Clause
"""AUTOTUNE, SYSTEMID and PAYLOAD_PLACE as they fly; RTL over the ground; what their reports say and log."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.modes import autotune, payload_place, rtl, systemid
from sitl.autopilot.copter.modes import autotune_gains as gains
from sitl.autopilot.copter.modes import autotune_rules as rules
from sitl.autopilot.copter.navigation.planner import PLANNER
from sitl.autopilot.modes import ModeResult
from sitl.autopilot.notes import ParametersFound, Text
from sitl.autopilot.terrain.state import RTL_WITHOUT, TERRAIN_DID
from sitl.core.mavlink import MavSeverity
from sitl.core.vectors import Vec2, Vec3
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, standing, throttle, ticks, turn_body
from tests.autopilot.copter.steady_copter import told

FULL = DesiredSpoolState.THROTTLE_UNLIMITED
POSITIONS = (15, 17, 19)
"""SID_AXIS along the nose: of the position, the velocity, the speed asked for."""


def tuning() -> Any:
    """In AUTOTUNE, levelling before its first twitch."""
    v = hovering("ALT_HOLD")
    assert autotune.start(v) == ModeResult.ACCEPTED
    v.autopilot.modes.number = autotune.AUTOTUNE
    return v


def run(v: Any, count: int = 1) -> Any:
    ticks(v, MODE["AUTOTUNE"].run, count)
    return v.autopilot


def test_it_levels_and_then_twitches(monkeypatch: Any) -> None:
    v = tuning()
    twitched: list[Any] = []
    monkeypatch.setattr(autotune.twitches, "run", twitched.append)
    ap = run(v)
    assert twitched == [] and ap.control.pos_d.last_tick == ap.control.tick
    ap.modes.autotune.twitching = True
    run(v)
    assert twitched == [v]


@pytest.mark.parametrize(("since_us", "says"), ((1_990_000, 0), (1_997_500, 1)))
def test_it_says_every_two_seconds_how_far_it_is(since_us: int, says: int) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    t.axis, t.step, t.count, t.reported_us = 1, 2, 3, v.time_us - since_us
    before = len(told(v, gains.AUTOTUNE_DID))
    run(v)
    new = told(v, gains.AUTOTUNE_DID)[before:]
    percent = 100 * 3 // rules.ENOUGH
    assert new == ([(float(gains.PROGRESS), 12000.0 + percent)] if says else [])
    run(v)
    assert len(told(v, gains.AUTOTUNE_DID)) == before + says


def test_a_twitch_is_concluded_once(monkeypatch: Any) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    seen: list[int] = []

    def conclude(v: Any) -> None:
        seen.append(int(t.came_to))
        t.came_to = rules.GOES_ON

    monkeypatch.setattr(autotune, "conclude", conclude)
    t.came_to = rules.MEASURED
    run(v, 3)
    assert seen == [rules.MEASURED]


@pytest.mark.parametrize(
    "change",
    (
        lambda ap: setattr(ap.modes.pilot, "roll", 0.5),
        lambda ap: setattr(ap.modes.autotune, "phase", gains.FOUND),
        lambda ap: setattr(ap.control.motors, "spool_state", SpoolState.SPOOLING_UP),
    ),
)
def test_it_flies_as_alt_hold_while_it_does_not_tune(change: Any, monkeypatch: Any) -> None:
    v = tuning()
    change(v.autopilot)
    tuned: list[Any] = []
    monkeypatch.setattr(autotune, "tune", tuned.append)
    ap = run(v)
    lean = math.degrees(ap.control.attitude.target_euler.roll)
    assert tuned == [] and lean == pytest.approx(15.0 if ap.modes.pilot.roll != 0.0 else 0.0)


def test_with_the_sticks_centred_it_leans_back_to_its_place() -> None:
    v = tuning()
    ap = v.autopilot
    ap.modes.autotune.phase, ap.modes.autotune.hold_pos = gains.FOUND, Vec2(-10.0, 0.0)
    ap.modes.autotune.holds_position = True
    run(v)
    assert math.degrees(ap.control.attitude.target_euler.pitch) == pytest.approx(5.0, abs=0.1)
    ap.modes.pilot.pitch = -0.2
    run(v)
    assert ap.control.attitude.target_euler.pitch < 0.0, "the stick flies"


def test_on_the_ground_it_stands_level() -> None:
    v = standing("AUTOTUNE")
    throttle(v, 0.0)
    turn_body(v, 0.0, 0.0, 0.6)
    v.autopilot.control.attitude.target_q = v.autopilot.control.attitude.target_q.replace(w=1.0, z=0.0)
    v.autopilot.modes.pilot.roll = 0.5
    ap = run(v)
    assert ap.control.motors.desired_spool == DesiredSpoolState.GROUND_IDLE
    assert ap.control.attitude.target_euler.yaw == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("did", "number", "severity", "texts"),
    (
        (gains.STARTED, 0, MavSeverity.INFO, ["AutoTune: Started"]),
        (gains.STOPPED, 0, MavSeverity.INFO, ["AutoTune: Stopped"]),
        (gains.SUCCESS, 0, MavSeverity.NOTICE, ["AutoTune: Success"]),
        (gains.PROGRESS, 12075, MavSeverity.INFO, None),
        (gains.TRIES, 0b0101, None, ["AutoTune: Pilot Testing gains for Roll Yaw(E)"]),
        (gains.MEASURED, 0, None, []),
    ),
)
def test_what_autotune_says(did: int, number: int, severity: int | None, texts: list[str] | None) -> None:
    notes = autotune.AUTOTUNE_DID.notes(tuning(), float(did), float(number))
    if texts is not None:
        assert [note.text for note in notes] == texts
    else:
        assert notes[0].text.startswith("AutoTune: Pitch ") and notes[0].text.endswith(" 75%")
    if severity is not None:
        assert [note.severity for note in notes] == [severity]


def test_what_is_saved_is_told_with_the_names_of_its_parameters() -> None:
    notes = autotune.AUTOTUNE_DID.notes(tuning(), float(gains.SAVED), 1.0)
    assert isinstance(notes[0], Text) and notes[0].text == "AutoTune: Saved gains for Roll "
    names = ("ATC_RAT_RLL_P", "ATC_RAT_RLL_I", "ATC_RAT_RLL_D", "ATC_ANG_RLL_P", "ATC_ACCEL_R_MAX")
    assert notes[1:] == [ParametersFound(names)]


@pytest.mark.parametrize(
    ("did", "number"),
    (
        (gains.STARTED, 30),
        (gains.STOPPED, 31),
        (gains.SUCCESS, 33),
        (gains.FAILURE, 34),
        (gains.D_LIMIT, 35),
        (gains.TRIES, 36),
        (gains.SAVED, 37),
    ),
)
def test_autotune_logs_its_events(did: int, number: int) -> None:
    """EV of ArduPilot's logs."""
    assert autotune.AUTOTUNE_DID.rows(tuning(), float(did), 0.0) == [("EV", (number,))]
    assert autotune.AUTOTUNE_DID.rows(tuning(), float(gains.PROGRESS), 0.0) == []


@pytest.mark.parametrize(
    ("step", "least", "most"),
    ((rules.RATE_D_UP, 10.0, 20.0), (rules.RATE_P_UP, 10.0, 20.0), (rules.RATE_P_UP + 1, 30.0, 40.0)),
)
def test_autotune_logs_what_a_twitch_has_measured(step: int, least: float, most: float) -> None:
    v = tuning()
    t = v.autopilot.modes.autotune
    t.axis, t.step, t.target, t.accel = 0, step, math.radians(50.0), 2.0
    t.rate_min, t.rate_max = math.radians(10.0), math.radians(20.0)
    t.angle_min, t.angle_max = math.radians(30.0), math.radians(40.0)
    t.roll.rate_p, t.roll.rate_d, t.roll.angle_p = 0.1, 0.02, 4.0
    [(name, row)] = autotune.AUTOTUNE_DID.rows(v, float(gains.MEASURED), 0.0)
    assert name == "ATUN"
    assert row == pytest.approx((0, step, 50.0, least, most, 0.1, 0.02, 4.0, math.degrees(200.0)))


def identifying(axis: int, testing: bool = True) -> Any:
    """In SYSTEMID, a second after its begin; the chirp adds 2."""
    v = hovering("LOITER" if axis >= 14 else "STABILIZE")
    p = v.autopilot.params.SID
    p.AXIS, p.MAGNITUDE, p.F_START_HZ, p.F_STOP_HZ = float(axis), 2.0, 0.5, 8.0
    p.T_FADE_IN, p.T_REC, p.T_FADE_OUT = 0.0, 20.0, 2.0
    assert systemid.start(v) == ModeResult.ACCEPTED
    v.autopilot.modes.number, v.autopilot.modes.systemid.testing = systemid.SYSTEMID, testing
    v.autopilot.modes.systemid.time = 1.5
    return v


@pytest.mark.parametrize("axis", POSITIONS)
def test_axes_of_the_position_hold_it_while_they_are_disturbed(axis: int) -> None:
    v = identifying(axis)
    ticks(v, MODE["SYSTEMID"].run)
    ap = v.autopilot
    assert ap.modes.systemid.holds_position and ap.control.motors.desired_spool == FULL
    assert ap.control.pos_ne.last_tick == ap.control.pos_d.last_tick == ap.control.tick
    assert ap.modes.systemid.value != 0.0
    assert (ap.modes.systemid.vel.x != 0.0) == (axis == 19), "the speed asked for moves the path"


@pytest.mark.parametrize("axis", (1, 7, 10, 13))
def test_other_axes_are_flown_by_hand(axis: int) -> None:
    v = identifying(axis)
    ticks(v, MODE["SYSTEMID"].run)
    ap = v.autopilot
    assert not ap.modes.systemid.holds_position and ap.control.pos_ne.last_tick != ap.control.tick
    assert bool(ap.control.motors.excited) == (axis == 10)


def test_motors_that_idle_get_no_throttle_in_a_test() -> None:
    v = standing("SYSTEMID")
    v.autopilot.params.SID.AXIS = 1.0
    throttle(v, 0.6)
    turn_body(v, 0.0, 0.0, 0.6)
    v.autopilot.control.attitude.target_q = v.autopilot.control.attitude.target_q.replace(w=1.0, z=0.0)
    systemid.run_by_hand(v, 1, 0.0)
    assert v.autopilot.control.attitude.throttle_in == 0.0
    assert v.autopilot.control.attitude.target_euler.yaw == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("did", "number", "severity", "text"),
    (
        (systemid.STARTED, 7.0, MavSeverity.INFO, "SystemID Starting: axis=7"),
        (systemid.FINISHED, 0.0, MavSeverity.INFO, "SystemID Finished"),
        (systemid.LANDED, 0.0, MavSeverity.INFO, "SystemID Stopped: Landed"),
        (systemid.LEANS, 31.5, MavSeverity.INFO, "SystemID Stopped: lean=31.500000 max=30.000000"),
        (systemid.NO_AXIS, 0.0, MavSeverity.INFO, "SystemID Stopped: axis = 0"),
        (systemid.BAD_PARAMETERS, 0.0, MavSeverity.INFO, "SystemID Parameter Error"),
        (systemid.REFUSED_BY_SPEED, 0.0, MavSeverity.WARNING, "Axis requires switch from Loiter"),
    ),
)
def test_what_systemid_says(did: int, number: float, severity: int, text: str) -> None:
    assert systemid.SYSTEM_ID_DID.notes(identifying(7), float(did), number) == [Text(severity, text)]


def test_systemid_logs_its_chirp_at_the_start_and_samples() -> None:
    v = identifying(7)
    rows = systemid.SYSTEM_ID_DID.rows(v, float(systemid.STARTED), 7.0)
    assert rows == [("SIDS", pytest.approx((7, 2.0, 0.5, 8.0, 0.0, 4.0, 20.0, 2.0)))]
    assert systemid.SYSTEM_ID_DID.rows(v, float(systemid.FINISHED), 0.0) == []
    state, est = v.autopilot.modes.systemid, v.autopilot.estimate
    state.time, state.value, state.frequency = 1.25, 0.5, math.tau * 3.0
    est.rates, v.sensors.acc = Vec3(math.radians(1.0), math.radians(2.0), math.radians(3.0)), Vec3(0.1, 0.2, -9.8)
    [(name, row)] = systemid.SYSTEM_ID_SAMPLE.rows(v, 0.0, 0.0)
    assert name == "SIDD" and row == pytest.approx((1.25, 0.5, 3.0, 1.0, 2.0, 3.0, 0.1, 0.2, -9.8))


def placing(stage: int = payload_place.STARTING) -> Any:
    """In AUTO, placing its load 20 m away or here."""
    v = hovering("AUTO")
    ap = v.autopilot
    ap.modes.nav.has_target = stage == payload_place.FLYING
    if stage == payload_place.FLYING:
        PLANNER.begin(ap, v.time_us, Vec3(20.0, 0.0, -10.0))
        PLANNER.start(ap, v.time_us)
    payload_place.begin(v)
    if stage > payload_place.STARTING:
        payload_place.begin_descent(ap.modes.payload_place, v.time_us, -10.0, ap.params)
        ap.modes.payload_place.stage = stage
    return v


def place(v: Any, count: int = 1) -> bool:
    return bool(ticks(v, payload_place.run, count))


def test_it_flies_to_its_place_first() -> None:
    v = placing(payload_place.FLYING)
    assert not place(v, 100)
    assert (
        v.autopilot.control.pos_ne.vel_desired.x > 0.005
        and v.autopilot.modes.payload_place.stage == payload_place.FLYING
    )
    v.autopilot.modes.nav.reached = 1
    place(v)
    assert v.autopilot.modes.payload_place.stage == payload_place.DESCENDING


@pytest.mark.parametrize(
    ("stage", "way"),
    (
        (payload_place.STARTING, 1),
        (payload_place.DESCENDING, 1),
        (payload_place.WAITING, 0),
        (payload_place.CLIMBING, -1),
    ),
)
def test_it_goes_down_rests_and_up(stage: int, way: int) -> None:
    v = placing(stage)
    v.autopilot.modes.payload_place.placed_us = v.time_us
    if stage == payload_place.CLIMBING:
        v.autopilot.modes.payload_place.start_d = -20.0
    place(v, 20)
    speed = v.autopilot.control.pos_d.vel_desired
    assert (speed == 0.0) if way == 0 else speed * way > 0.0
    assert v.autopilot.control.motors.desired_spool == FULL


def test_a_climb_ends_where_the_descent_began() -> None:
    v = placing(payload_place.CLIMBING)
    assert place(v)


def test_a_gripper_that_is_open_ends_it() -> None:
    v = placing()
    v.autopilot.modes.payload_place.gripper = payload_place.OPEN
    assert place(v)
    assert told(v, payload_place.PAYLOAD_PLACE_DID) == [(float(payload_place.ABORTED), 0.0)]


def test_the_ground_under_a_load_ends_its_descent() -> None:
    v = placing(payload_place.DESCENDING)
    v.autopilot.arming.landed_maybe = 1
    place(v)
    assert told(v, payload_place.PAYLOAD_PLACE_DID)[0] == (float(payload_place.LANDED), 0.0)
    assert v.autopilot.modes.payload_place.stage > payload_place.DESCENDING


@pytest.mark.parametrize(("armed", "spool"), ((1, DesiredSpoolState.GROUND_IDLE), (0, DesiredSpoolState.SHUT_DOWN)))
def test_on_the_ground_a_load_is_not_placed(armed: int, spool: int) -> None:
    v = placing()
    v.autopilot.arming.armed, v.autopilot.arming.landed = armed, 1
    assert not place(v)
    assert v.autopilot.control.motors.desired_spool == spool
    assert v.autopilot.modes.payload_place.stage == payload_place.STARTING


def returning(over_ground: bool = True, terrain: float = 1.0, asked: int = 1) -> Any:
    """Going to return; home, 3 m up, 40 m away."""
    v = hovering("RTL", 10.0)
    ap = v.autopilot
    ap.home.is_set, ap.home.pos = 1, (0.0, 0.0, -3.0)
    ap.estimate.pos = Vec3(40.0, 0.0, -10.0)
    ap.params.RTL.ALT_TYPE, ap.params.TERRAIN.ENABLE, ap.terrain.asked = float(over_ground), terrain, asked
    ap.params.RTL.ALT, ap.params.RTL.CLIMB_MIN, ap.params.RTL.CONE_SLOPE = 1500.0, 0.0, 0.0
    return v


def test_where_nobody_tells_heights_the_way_home_counts_from_home() -> None:
    v = returning(asked=0)
    assert rtl.start(v) == ModeResult.ACCEPTED
    assert v.autopilot.modes.rtl.return_d == pytest.approx(-18.0)
    assert not v.autopilot.modes.nav.over_ground and told(v, TERRAIN_DID) == []


def test_without_heights_it_says_so_and_counts_from_home() -> None:
    v = returning(terrain=0.0)
    rtl.start(v)
    assert told(v, TERRAIN_DID) == [(float(RTL_WITHOUT), 0.0)]
    assert v.autopilot.modes.rtl.return_d == pytest.approx(-18.0) and not v.autopilot.modes.nav.over_ground


@pytest.mark.parametrize(("ranged", "height"), ((4.0, 15.0), (20.0, 20.0)))
def test_over_the_ground_the_way_home_is_as_high_above_it(ranged: float, height: float) -> None:
    """Above what the rangefinder sees; never down from where it is."""
    v = returning()
    ap = v.autopilot
    v.sensors.rangefinder_count, ap.params.WPNAV.RFND_USE, ap.control.attitude.cos_lean = 1, 1.0, 1.0
    v.sensors.rangefinder_range[0] = ranged
    rtl.start(v)
    nav = ap.modes.nav
    assert nav.over_ground and nav.ground_d == pytest.approx(-10.0 + ranged)
    assert ap.modes.rtl.return_d == pytest.approx(-height)


@pytest.mark.parametrize(("kind", "follows"), ((0.0, False), (1.0, True)))
def test_rtl_alt_type_chooses_heights_over_the_ground(kind: float, follows: bool) -> None:
    v = returning(over_ground=bool(kind))
    v.sensors.rangefinder_count, v.autopilot.params.WPNAV.RFND_USE = 1, 1.0
    v.autopilot.control.attitude.cos_lean, v.sensors.rangefinder_range[0] = 1.0, 4.0
    rtl.start(v)
    assert bool(v.autopilot.modes.nav.over_ground) == follows


def test_while_it_holds_its_position_the_yaw_stick_turns_it_and_it_leans_against_what_disturbs_it() -> None:
    v = identifying(15)
    v.autopilot.modes.pilot.yaw_rate = 0.5
    ticks(v, MODE["SYSTEMID"].run, 20)
    target = v.autopilot.control.attitude.target_euler
    assert target.yaw == pytest.approx(20 * 0.5 * 0.0025, rel=0.1) and target.pitch != 0.0
