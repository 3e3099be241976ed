# SPDX-License-Identifier: BSD-3-Clause
"""One tick of the modes that sticks fly: the lean, the turn, the climb and the power of the motors they ask for."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.copter.control.spool import DesiredSpoolState, SpoolState
from sitl.autopilot.copter.modes import acro, drift, flip, stabilize
from sitl.autopilot.modes import ModeReason
from sitl.core.vectors import Quat
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, standing, throttle, ticks, turn_body

LEANING = ("STABILIZE", "ALT_HOLD", "POSHOLD", "FLOWHOLD", "TURTLE")
"""Their full stick is ANGLE_MAX."""
BY_THROTTLE = ("STABILIZE", "ACRO", "DRIFT", "TURTLE")
BY_CLIMB = ("ALT_HOLD", "LOITER", "POSHOLD", "FLOWHOLD")


def tick(v: Any, name: str) -> Any:
    ticks(v, MODE[name].run)
    return v.autopilot.control


@pytest.mark.parametrize("name", LEANING)
@pytest.mark.parametrize(("roll", "pitch"), ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)))
def test_a_full_stick_leans_by_angle_max(name: str, roll: float, pitch: float) -> None:
    v = hovering(name)
    v.autopilot.params.ANGLE_MAX = 2000.0
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.pitch = roll, pitch
    lean = tick(v, name).attitude.target_euler
    assert (math.degrees(lean.roll), math.degrees(lean.pitch)) == pytest.approx((20.0 * roll, 20.0 * pitch), abs=1e-6)


@pytest.mark.parametrize(("name", "kept"), (("STABILIZE", False), ("ALT_HOLD", True), ("POSHOLD", True)))
def test_modes_that_hold_height_lean_no_further_than_the_thrust_allows(name: str, kept: bool) -> None:
    v = hovering(name)
    v.autopilot.control.attitude.lean_max = math.radians(15.0)
    v.autopilot.modes.pilot.roll = 1.0
    assert math.degrees(tick(v, name).attitude.target_euler.roll) == pytest.approx(15.0 if kept else 30.0)


@pytest.mark.parametrize("name", (*LEANING, "LOITER"))
def test_the_yaw_stick_turns(name: str) -> None:
    v = hovering(name, direct=False)
    v.autopilot.modes.pilot.yaw_rate = 0.6
    ticks(v, MODE[name].run, 250)
    assert v.autopilot.control.attitude.target_rate.z == pytest.approx(0.6, abs=0.01)


@pytest.mark.parametrize("name", BY_THROTTLE)
def test_a_throttle_that_drives_the_motors_idles_them_when_closed(name: str) -> None:
    v = hovering(name)
    throttle(v, 0.0)
    assert tick(v, name).motors.desired_spool == DesiredSpoolState.GROUND_IDLE
    throttle(v, 0.2)
    assert tick(v, name).motors.desired_spool == DesiredSpoolState.THROTTLE_UNLIMITED
    v.autopilot.arming.armed = 0
    assert tick(v, name).motors.desired_spool == DesiredSpoolState.SHUT_DOWN


@pytest.mark.parametrize("name", BY_THROTTLE)
@pytest.mark.parametrize("spool", (SpoolState.SHUT_DOWN, SpoolState.GROUND_IDLE))
def test_motors_that_idle_get_no_throttle_and_the_heading_is_kept(name: str, spool: int) -> None:
    v = standing(name, spool)
    throttle(v, 0.7)
    turn_body(v, 0.0, 0.0, 1.1)
    v.autopilot.control.attitude.target_q = Quat(1.0, 0.0, 0.0, 0.0)
    control = tick(v, name)
    assert control.attitude.throttle_in == 0.0
    assert control.attitude.target_euler.yaw == pytest.approx(1.1)
    assert v.autopilot.arming.landed


@pytest.mark.parametrize("name", BY_THROTTLE)
@pytest.mark.parametrize(("at_least", "flies"), ((False, True), (True, False)))
def test_full_power_that_is_not_at_its_least_flies(name: str, at_least: bool, flies: bool) -> None:
    v = standing(name, SpoolState.THROTTLE_UNLIMITED)
    v.autopilot.control.motors.limit_throttle_lower = at_least
    throttle(v, 0.7)
    assert tick(v, name).attitude.throttle_in > 0.3
    assert bool(v.autopilot.arming.landed) != flies


@pytest.mark.parametrize("name", BY_THROTTLE)
def test_the_throttle_keeps_its_lift_in_a_lean_but_in_acro(name: str) -> None:
    v = hovering(name)
    v.autopilot.control.attitude.cos_lean = 0.5
    turn_body(v, math.radians(60.0), 0.0, 0.0)
    control = tick(v, name)
    boost = control.motors.throttle_in / control.attitude.throttle_in
    assert boost == pytest.approx(1.0 if name == "ACRO" else 2.0)


@pytest.mark.parametrize("name", BY_THROTTLE)
def test_the_throttle_is_filtered_as_pilot_thr_filt_says(name: str) -> None:
    v = hovering(name)
    v.autopilot.params.PILOT.THR_FILT = 3.0
    assert tick(v, name).motors.throttle_filter_hz == 3.0


def test_stabilize_hovers_with_the_stick_in_its_middle() -> None:
    """ArduPilot's curve of the manual throttle goes near MOT_THST_HOVER there, through 0 and 1 at the ends."""
    v = hovering("STABILIZE")
    middle = 500.0 / 1000.0
    for stick, wanted in ((0.0, 0.0), (middle, 0.35), (1.0, 1.0)):
        throttle(v, stick)
        assert stabilize.throttle(v.autopilot.modes.pilot, v.autopilot.params) == pytest.approx(wanted, abs=0.02)


@pytest.mark.parametrize(("mid", "wanted"), ((0.0, 0.35), (0.6, 0.6), (0.2, 0.2)))
def test_acro_takes_the_throttle_of_the_middle_from_its_parameter(mid: float, wanted: float) -> None:
    v = hovering("ACRO")
    v.autopilot.params.ACRO.THR_MID = mid
    assert acro.throttle(v.autopilot.modes.pilot, v.autopilot.params) == pytest.approx(wanted, abs=0.02)


def test_acro_turns_at_the_rates_of_its_sticks() -> None:
    v = hovering("ACRO")
    p, sticks = v.autopilot.params, v.autopilot.modes.pilot
    p.ACRO.TRAINER, p.ACRO.RP_EXPO, p.ACRO.RP_RATE = 0.0, 0.0, 180.0
    sticks.roll, sticks.pitch = 0.5, 0.0
    rates = tick(v, "ACRO").attitude.target_rate
    assert [math.degrees(r) for r in rates] == pytest.approx([90.0, 0.0, 0.0])


@pytest.mark.parametrize("name", BY_CLIMB)
@pytest.mark.parametrize(("stick", "speed"), ((1.0, 2.5), (0.0, -1.2), (0.5, 0.0)))
def test_the_throttle_stick_is_a_climb_rate(name: str, stick: float, speed: float) -> None:
    """PILOT_SPEED_UP and PILOT_SPEED_DN at its ends, nothing in its middle."""
    v = hovering(name, 50.0)
    p = v.autopilot.params
    p.PILOT.SPEED_DN, p.PILOT.ACCEL_Z, p.PSC.JERK_Z = 120.0, 500.0, 50.0
    p.PSC.ACCZ.FLTT = p.PSC.ACCZ.FLTE = 0.0
    throttle(v, stick)
    ticks(v, MODE[name].run, 350)
    assert -v.autopilot.control.pos_d.vel_desired == pytest.approx(speed, abs=0.02)


@pytest.mark.parametrize("name", BY_CLIMB[:3])
def test_a_climb_begins_with_the_jerk_that_psc_jerk_z_allows(name: str) -> None:
    v = hovering(name, 50.0)
    throttle(v, 1.0)
    assert MODE[name].start(v) == 0
    assert tick(v, name).pos_d.accel_desired == pytest.approx(-v.autopilot.control.pos_d.jerk_max * 0.0025)


@pytest.mark.parametrize("name", BY_CLIMB)
def test_on_the_ground_it_stands_level_and_its_throttle_decays(name: str) -> None:
    v = standing(name)
    ap = v.autopilot
    ap.control.attitude.throttle_in = 0.2
    ap.modes.pilot.yaw_rate = 0.5
    throttle(v, 0.0)
    turn_body(v, 0.0, 0.0, 0.4)
    ap.control.attitude.target_q = Quat(1.0, 0.0, 0.0, 0.0)
    control = tick(v, name)
    assert control.motors.desired_spool == DesiredSpoolState.GROUND_IDLE
    assert control.attitude.target_euler == pytest.approx((0.0, 0.0, 0.4 + 0.5 * 0.0025), abs=1e-6)
    throttles = [float(tick(v, name).attitude.throttle_in) for _ in range(64)]  # a time constant of 0.16 s
    assert throttles == sorted(throttles, reverse=True)
    assert throttles[-1] == pytest.approx(0.2 * math.exp(-1.0), rel=0.03)
    assert ap.arming.landed


@pytest.mark.parametrize("name", BY_CLIMB)
def test_disarmed_the_motors_stand(name: str) -> None:
    v = standing(name, SpoolState.SHUT_DOWN)
    v.autopilot.arming.armed = 0
    throttle(v, 1.0)
    assert tick(v, name).motors.desired_spool == DesiredSpoolState.SHUT_DOWN


@pytest.mark.parametrize("name", BY_CLIMB)
def test_a_stick_that_is_raised_takes_off_and_climbs(name: str) -> None:
    v = standing(name, SpoolState.THROTTLE_UNLIMITED)
    ap = v.autopilot
    throttle(v, 1.0)
    tick(v, name)
    assert ap.modes.takeoff.user_active and ap.arming.landed
    raised = [float(tick(v, name).attitude.throttle_in) for _ in range(100)]
    assert raised == sorted(raised) and raised[-1] == pytest.approx(100 * 0.0025 / ap.params.TKOFF.SLEW_TIME, rel=0.05)
    move(v, 0.0, 0.0, -1.3)  # it leaves the ground
    tick(v, name)
    assert not ap.arming.landed and ap.modes.takeoff.user_active
    ticks(v, MODE[name].run, 300)
    assert not ap.modes.takeoff.user_active and ap.control.pos_d.vel_desired < -0.5


@pytest.mark.parametrize("name", BY_CLIMB)
def test_a_take_off_climbs_as_high_as_pilot_tkoff_alt_at_most_ten_metres(name: str) -> None:
    for height, wanted in ((150.0, 1.5), (2000.0, 10.0), (-5.0, 0.0)):
        v = standing(name, SpoolState.THROTTLE_UNLIMITED)
        v.autopilot.params.PILOT.TKOFF_ALT = height
        throttle(v, 1.0)
        tick(v, name)
        assert v.autopilot.modes.takeoff.user_alt == wanted


@pytest.mark.parametrize(("yaw", "roll", "pitch"), ((0.0, 0.0, 24.0), (math.pi / 2, 24.0, 0.0), (math.pi, 0.0, -24.0)))
def test_drift_brakes_against_the_ground_speed_along_and_across_its_nose(yaw: float, roll: float, pitch: float) -> None:
    v = hovering("DRIFT")
    v.autopilot.modes.drift.brake = 1.0
    turn_body(v, 0.0, 0.0, yaw)
    move(v, 3.0, 0.0, 0.0)
    lean = tick(v, "DRIFT").attitude.target_euler
    assert (math.degrees(lean.roll), math.degrees(lean.pitch)) == pytest.approx((roll, pitch), abs=0.1)


def test_drift_leans_with_its_yaw_stick_and_against_slip_to_its_limits() -> None:
    v = hovering("DRIFT")
    state = v.autopilot.modes.drift
    leans = [drift.slip_lean(state, 1.0, 0.0) for _ in range(200)]
    assert leans == sorted(leans) and leans[-1] == pytest.approx(math.radians(45.0), abs=1e-3)
    assert state.side_speed == pytest.approx(5.625, rel=1e-3)
    assert leans[24] / leans[-1] == pytest.approx(1.0 - math.exp(-1.0), abs=0.02), "62.5 ms"
    state.side_speed = 0.0
    for right, lean in ((2.0, -16.0), (-2.0, 16.0), (30.0, -44.8), (-30.0, 44.8)):
        assert math.degrees(drift.slip_lean(state, 0.0, right)) == pytest.approx(lean, abs=1e-6)
        state.side_speed = 0.0


def test_drift_pitches_with_its_stick_and_rolls_into_turns() -> None:
    v = hovering("DRIFT")
    sticks = v.autopilot.modes.pilot
    sticks.pitch, sticks.roll = -0.5, 1.0
    control = tick(v, "DRIFT")
    assert (
        control.attitude.target_euler.pitch == pytest.approx(-0.26, abs=0.03) and v.autopilot.modes.drift.brake == 0.0
    )
    turn = math.radians(v.autopilot.params.ACRO.Y_RATE) * 30.0 / 45.0
    assert 0.8 * turn < control.attitude.target_euler.yaw / 0.0025 <= turn
    assert MODE["DRIFT"].is_landing(v.autopilot.modes) == 0
    throttle(v, 0.0)
    assert MODE["DRIFT"].is_landing(v.autopilot.modes) == 1


@pytest.mark.parametrize(("vel_d", "less"), ((-1.0, True), (1.0, False)))
def test_drift_takes_throttle_off_a_climb_and_adds_it_in_a_descent(vel_d: float, less: bool) -> None:
    v = hovering("DRIFT")
    throttle(v, 0.6)
    calm = float(tick(v, "DRIFT").attitude.throttle_in)
    move(v, 0.0, 0.0, vel_d)
    change = float(tick(v, "DRIFT").attitude.throttle_in) - calm
    assert change == pytest.approx(-0.18 if less else 0.18, abs=0.03)


def flipping(stage: int = flip.BEGINNING) -> Any:
    """A flip to the right that began out of ALT_HOLD."""
    v = hovering("FLIP")
    state = v.autopilot.modes.flip
    v.autopilot.modes.previous = MODE["ALT_HOLD"].number
    state.roll, state.phase, state.start_us = 1.0, stage, v.time_us
    state.level = Quat(1.0, 0.0, 0.0, 0.0)
    return v


@pytest.mark.parametrize("way", ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)))
def test_a_flip_turns_at_400_degrees_a_second_its_way(way: tuple[float, float]) -> None:
    v = flipping()
    v.autopilot.modes.flip.roll, v.autopilot.modes.flip.pitch = way
    v.autopilot.params.ATC.RATE_R_MAX = v.autopilot.params.ATC.RATE_P_MAX = 0.0
    rates = tick(v, "FLIP").attitude.target_rate
    assert [math.degrees(r) for r in rates] == pytest.approx([400.0 * way[0], 400.0 * way[1], 0.0])


def test_a_flip_recovers_to_the_attitude_of_its_start() -> None:
    v = flipping(flip.RECOVERING)
    turn_body(v, math.radians(-60.0), 0.0, 0.3)
    v.autopilot.modes.flip.level = Quat(math.cos(0.15), 0.0, 0.0, math.sin(0.15))
    assert tick(v, "FLIP").attitude.target_euler == pytest.approx((0.0, 0.0, 0.3), abs=1e-6)
    assert v.autopilot.modes.wanted == 0
    tick(v, "FLIP")  # it is there
    modes = v.autopilot.modes
    assert (modes.wanted, modes.wanted_reason) == (MODE["ALT_HOLD"].number + 1, ModeReason.FLIP_COMPLETE)


@pytest.mark.parametrize(
    ("change", "ends"),
    (
        (lambda v: None, False),
        (lambda v: setattr(v.autopilot.modes.pilot, "roll", 0.9), True),
        (lambda v: setattr(v.autopilot.modes.pilot, "roll", -0.9), True),
        (lambda v: setattr(v.autopilot.modes.pilot, "pitch", 0.9), True),
        (lambda v: setattr(v.autopilot.modes.pilot, "pitch", -0.88), False),
        (lambda v: setattr(v.autopilot.modes.flip, "start_us", v.time_us + 2500 - 2_500_000), False),
        (lambda v: setattr(v.autopilot.modes.flip, "start_us", v.time_us + 2500 - 2_500_001), True),
        (lambda v: setattr(v.autopilot.arming, "armed", 0), True),
        (lambda v: setattr(v.autopilot.arming, "landed", 1), True),
    ),
)
def test_a_flip_gives_up_for_a_stick_time_and_the_ground(change: Any, ends: bool) -> None:
    v = flipping()
    change(v)
    tick(v, "FLIP")
    assert (v.autopilot.modes.wanted != 0) == ends


@pytest.mark.parametrize(("armed", "spool"), ((1, 2), (0, 0)))
def test_a_flip_needs_power_while_it_is_armed(armed: int, spool: int) -> None:
    v = flipping()
    v.autopilot.arming.armed = armed
    control = tick(v, "FLIP")
    assert control.motors.desired_spool == spool
    assert control.attitude.throttle_in == pytest.approx(0.55, abs=0.03), "that of hovering and 0.2"


@pytest.mark.parametrize("yaw", (0.0, 1.0, -2.5))
def test_a_flip_starts_in_the_air_near_level_in_modes_without_a_position(yaw: float) -> None:
    def started(
        name: str = "STABILIZE", roll: float = 10.0, stick: float = 0.5, armed: int = 1, landed: int = 0
    ) -> int:
        v = hovering(name)
        turn_body(v, math.radians(roll), 0.1, yaw)
        throttle(v, stick)
        v.autopilot.arming.armed, v.autopilot.arming.landed = armed, landed
        result = MODE["FLIP"].start(v)
        if result == 0:
            state = v.autopilot.modes.flip
            assert (state.phase, state.start_us) == (flip.BEGINNING, v.time_us)
            assert state.level == pytest.approx(tuple(v.autopilot.estimate.q), abs=1e-9)
        return int(result == 0)

    assert [started(name) for name in ("STABILIZE", "ACRO", "ALT_HOLD", "LOITER", "GUIDED")] == [1, 1, 1, 0, 0]
    assert [started(roll=roll) for roll in (44.0, -44.0, 46.0, -46.0)] == [1, 1, 0, 0]
    assert [started(name, stick=0.0) for name in ("STABILIZE", "ACRO", "ALT_HOLD")] == [0, 0, 1]
    assert (started(armed=0), started(landed=1)) == (0, 0)
