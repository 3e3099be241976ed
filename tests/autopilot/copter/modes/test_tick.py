# SPDX-License-Identifier: BSD-3-Clause
"""One tick of the copter: what runs how often, the mode's own turn, and what the transmitter's switches do."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.autopilot.arming_checks import ArmingMethod
from sitl.autopilot.aux_switch import AUX_SWITCH
from sitl.autopilot.copter import arming, terrain_following
from sitl.autopilot.copter.control.spool import DesiredSpoolState
from sitl.autopilot.copter.modes import decisions, simple, switch
from sitl.autopilot.copter.modes.state import Modes
from sitl.autopilot.modes import ModeReason
from sitl.autopilot.navigation.state import GO_ON, LEG_ENDING
from sitl.autopilot.state import Arming
from tests.autopilot.copter.modes.obedient_copter import MODE, hovering, move, standing, throttle, turn_body
from tests.autopilot.copter.steady_copter import codes, told, wait

SECOND = 400
"""Ticks."""
EVERY_TICK = (
    "run_mode",
    "motor_test.run",
    "landing.detect",
    "crash.check",
    "thrust_loss.check",
    "landing.set_priority",
)
EVERY_TICK += ("arming.follow_throttle",)
FIFTY = ("pilot.read", "turn_sticks", "failsafe.watch_radio", "switch.read_switches", "switch.read_rudder")
TEN = ("battery.monitor", "failsafe.watch_gcs", "failsafe.watch_battery", "failsafe.watch_estimate", "watch_square")
TEN += ("failsafe.watch_vibration", "failsafe.watch_terrain", "arming.disarm_idle", "takeoff_check.check")
TEN += ("yaw_imbalance.check", "avoidance.watch", "bendy_ruler.watch", "watch_detour")
TIMES = {
    **dict.fromkeys(EVERY_TICK, SECOND),
    **dict.fromkeys(FIFTY, 50),
    **dict.fromkeys(TEN, 10),
    "fence.watch": 25,
    "home.set_first": 4,
    "arming.check": 4,
    "smart_rtl.record": 3,
}


def test_each_part_runs_as_often_as_it_says(monkeypatch: Any) -> None:
    v = hovering("ALT_HOLD")
    v.tick, counts = 0, dict.fromkeys(TIMES, 0)

    def counted(name: str) -> Any:
        def count(*args: Any) -> int:
            counts[name] += 1
            return 0

        return count

    for name in TIMES:
        owner, _, attribute = name.rpartition(".")
        monkeypatch.setattr(getattr(decisions, owner) if owner else decisions, attribute, counted(name))
    for _ in range(SECOND):
        decisions.update([v], 0)
        v.tick += 1
    assert counts == TIMES


@pytest.mark.parametrize(("failed", "ok"), ((0, True), (5, False)))
def test_whether_it_may_be_armed_is_known_before_it_is_asked(failed: int, ok: bool, monkeypatch: Any) -> None:
    v = hovering("ALT_HOLD")
    monkeypatch.setattr(arming, "check", lambda v: failed)
    v.tick = 12
    decisions.update([v], 0)
    assert bool(v.autopilot.arming.prearm_ok) == ok


def run_mode(v: Any) -> Any:
    decisions.run_mode(v)
    return v.autopilot


def test_a_mode_that_asks_for_another_gets_it_after_its_tick() -> None:
    v = hovering("ALT_HOLD")
    modes = v.autopilot.modes
    modes.wanted, modes.wanted_reason = MODE["LOITER"].number + 1, ModeReason.MISSION_END
    run_mode(v)
    assert (modes.number, modes.reason, modes.wanted) == (MODE["LOITER"].number, ModeReason.MISSION_END, 0)
    modes.wanted = MODE["STABILIZE"].number + 1  # the mode with the number 0
    run_mode(v)
    assert modes.number == 0


@pytest.mark.parametrize(("armed", "delay", "spool"), ((1, 0, 2), (0, 0, 0), (1, 1, 0), (0, 1, 0)))
def test_the_motors_stand_while_disarmed_and_just_armed(armed: int, delay: int, spool: int) -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.arming.armed, v.autopilot.modes.arming_delay = armed, delay
    assert run_mode(v).control.motors.desired_spool == DesiredSpoolState(spool)


@pytest.mark.parametrize(("pending", "told_at_once"), ((GO_ON, True), (0, False), (1, False)))
def test_the_end_of_a_detour_is_told_to_the_shell_at_once(pending: int, told_at_once: bool) -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.modes.nav.request_pending = pending
    run_mode(v)
    assert (LEG_ENDING in codes(v)) == told_at_once


@pytest.mark.parametrize(("name", "over_ground", "follows"), (("AUTO", 1, 1), ("AUTO", 0, 0), ("GUIDED", 1, 0)))
def test_a_path_over_the_ground_follows_it_but_for_guided(
    name: str, over_ground: int, follows: int, monkeypatch: Any
) -> None:
    """GUIDED follows the ground itself."""
    v = hovering(name)
    v.autopilot.modes.nav.over_ground = over_ground
    followed: list[int] = []
    monkeypatch.setattr(terrain_following, "follow", lambda v: followed.append(1))
    run_mode(v)
    assert len(followed) == follows


@pytest.mark.parametrize(
    ("name", "armed", "landed", "holds"),
    (
        ("ALT_HOLD", 1, 0, True),
        ("LOITER", 1, 0, True),
        ("STABILIZE", 1, 0, False),
        ("DRIFT", 1, 0, False),
        ("ALT_HOLD", 0, 0, False),
        ("ALT_HOLD", 1, 1, False),
    ),
)
def test_the_hover_throttle_is_learnt_in_flight_where_height_is_held(
    name: str, armed: int, landed: int, holds: bool
) -> None:
    state, modes = Arming(), Modes()
    state.armed, state.landed, modes.number = armed, landed, MODE[name].number
    assert decisions.holds_height(state, modes) == holds


def test_a_take_off_teaches_no_hover_throttle() -> None:
    state, modes = Arming(), Modes()
    state.armed, modes.number, modes.guided.submode = 1, MODE["GUIDED"].number, 0
    assert not decisions.holds_height(state, modes)
    modes.takeoff.complete = 1
    assert decisions.holds_height(state, modes)


@pytest.mark.parametrize(("vel_d", "lean", "throttle_out", "learns"), ((0.0, 1.0, 0.5, True), (0.6, 1.0, 0.5, False)))
def test_it_learns_one_tick_in_four_while_it_hovers(
    vel_d: float, lean: float, throttle_out: float, learns: bool
) -> None:
    v = hovering("ALT_HOLD")
    ap = v.autopilot
    move(v, 0.0, 0.0, vel_d)
    ap.params.MOT.HOVER_LEARN, ap.control.motors.throttle, v.tick = 2.0, throttle_out, 1
    learnt = []
    for _ in range(8):
        before = float(ap.params.MOT.THST_HOVER)
        decisions.update([v], 0)
        learnt.append(ap.params.MOT.THST_HOVER - before)
        ap.estimate.pos = ap.estimate.pos.replace(z=ap.control.pos_d.pos_desired)
        v.tick += 1
    assert sum(change != 0.0 for change in learnt) == (2 if learns else 0)
    if learns:
        assert max(learnt) == pytest.approx(0.15 * 0.01 / 10.01, rel=0.01), "a time constant of ten seconds"


@pytest.mark.parametrize(("name", "turned"), (("LOITER", True), ("ACRO", False)))
def test_simple_turns_the_sticks_of_modes_that_heed_it(name: str, turned: bool) -> None:
    v = hovering(name)
    modes = v.autopilot.modes
    turn_body(v, 0.0, 0.0, math.pi / 2)
    modes.simple.number, modes.pilot.roll = simple.SIMPLE, 0.5
    decisions.turn_sticks(v)
    assert (modes.pilot.roll == 0.5) != turned


@pytest.mark.parametrize(("located", "home", "heading"), ((1, 1, math.pi / 2), (0, 1, 0.0), (1, 0, 0.0)))
def test_the_heading_from_home_needs_a_position_and_a_home(located: int, home: int, heading: float) -> None:
    v = hovering("LOITER")
    ap = v.autopilot
    ap.estimate.position_ok, ap.home.is_set, ap.modes.simple.heading_from_home = located, home, 0.0
    ap.estimate.pos = ap.estimate.pos.replace(y=50.0)
    decisions.turn_sticks(v)
    assert ap.modes.simple.heading_from_home == pytest.approx(heading)


def flick(v: Any, channel: int, pulse: int, seconds: float = 0.3) -> Any:
    """A switch goes over and stays."""
    v.autopilot.rc.channels[channel - 1] = pulse
    switch.read_switches(v)
    wait(v, seconds)
    switch.read_switches(v)
    return v.autopilot.modes


@pytest.mark.parametrize(("channel", "pulse", "index"), ((5, 1000, 0), (5, 1300, 1), (5, 2000, 5), (6, 1500, 3)))
def test_the_mode_switch_enters_the_mode_of_its_position(channel: int, pulse: int, index: int) -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.params.FLTMODE_CH = float(channel)
    v.autopilot.params.FLTMODE[index] = float(MODE["LOITER"].number)
    v.autopilot.modes.pilot.switch_position = v.autopilot.modes.pilot.switch_candidate = 2
    modes = flick(v, channel, pulse)
    assert (modes.number, modes.reason) == (MODE["LOITER"].number, ModeReason.RC)


@pytest.mark.parametrize(
    ("change", "number"), ((lambda ap: None, 5), (lambda ap: setattr(ap.modes.failsafe, "radio", 1), 2))
)
def test_without_a_radio_the_mode_switch_does_nothing(change: Any, number: int) -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.params.FLTMODE_CH, v.autopilot.params.FLTMODE[0] = 5.0, 5.0
    change(v.autopilot)
    assert flick(v, 5, 1000).number == number


def test_a_switch_that_is_not_left_alone_changes_nothing() -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.params.FLTMODE_CH, v.autopilot.params.FLTMODE[0] = 5.0, 5.0
    assert flick(v, 5, 1000, 0.1999).number == MODE["ALT_HOLD"].number
    wait(v, 0.0001)
    switch.read_switches(v)
    assert v.autopilot.modes.number == 5


@pytest.mark.parametrize(("mode", "number"), ((5.0, simple.SIMPLE), (99.0, simple.OFF)))
def test_simple_comes_with_a_position_whose_mode_is_entered(mode: float, number: int) -> None:
    v = hovering("ALT_HOLD")
    p = v.autopilot.params
    p.FLTMODE_CH, p.FLTMODE[0], p["SIMPLE"] = 5.0, mode, 1.0
    assert flick(v, 5, 1000).simple.number == number
    assert len(told(v, simple.SIMPLE_CHANGED)) == (1 if number else 0)
    switch.read_switches(v)
    assert len(told(v, simple.SIMPLE_CHANGED)) == (1 if number else 0), "said once"


@pytest.mark.parametrize(("function", "number"), ((0, simple.SIMPLE), (3, simple.OFF), (13, simple.OFF), (4, 1)))
def test_a_switch_of_simple_takes_precedence(function: int, number: int) -> None:
    v = hovering("ALT_HOLD")
    p = v.autopilot.params
    p.FLTMODE_CH, p.FLTMODE[0], p["SIMPLE"], p.RC[6].OPTION = 5.0, 5.0, 1.0, float(function)
    assert flick(v, 5, 1000).simple.number == number


def test_other_switches_are_told_to_the_shell() -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.params.RC[6].OPTION = 7.0
    flick(v, 7, 1900)
    assert [a for a, _ in told(v, AUX_SWITCH)] == [7.0]


def held(v: Any, yaw: float, seconds: float) -> Any:
    """The yaw stick is held for a while, 50 frames a second."""
    v.autopilot.modes.pilot.yaw = yaw
    for _ in range(round(seconds * 50) + 1):
        switch.read_rudder(v)
        wait(v, 0.02)
    return v.autopilot.arming


def ready() -> Any:
    """Disarmed on the ground, the throttle closed."""
    v = standing("STABILIZE")
    v.autopilot.arming.armed = 0
    v.autopilot.params.ARMING.RUDDER, v.autopilot.params.ARMING.CHECK = 2.0, 0.0
    throttle(v, 0.0)
    return v


def test_the_yaw_stick_arms_after_two_seconds_to_the_right_and_disarms_to_the_left() -> None:
    v = ready()
    assert not held(v, 1.0, 1.9).armed
    assert held(v, 1.0, 0.2).armed
    assert held(v, 1.0, 3.0).armed
    v.autopilot.arming.landed = 1
    assert held(v, -1.0, 3.0).armed, "not before it was in its middle"
    held(v, 0.49, 0.0)
    assert held(v, -1.0, 1.9).armed
    assert not held(v, -1.0, 0.2).armed


@pytest.mark.parametrize(
    "hinder",
    (
        lambda ap: setattr(ap.modes.pilot, "throttle", 0.1),
        lambda ap: setattr(ap.rc, "receiver_ok", 0),
        lambda ap: setattr(ap.modes.pilot, "rudder_done", 1),
        lambda ap: setattr(ap.params.ARMING, "RUDDER", 0.0),
    ),
)
def test_the_yaw_stick_arms_with_a_closed_throttle_a_radio_and_leave(hinder: Any) -> None:
    v = ready()
    hinder(v.autopilot)
    assert not held(v, 1.0, 3.0).armed


@pytest.mark.parametrize(("stick", "again"), ((0.5, False), (-0.5, False), (0.49, True), (-0.49, True)))
def test_the_yaw_stick_counts_again_once_it_was_half_way_back(stick: float, again: bool) -> None:
    v = ready()
    v.autopilot.modes.pilot.rudder_done = 1
    held(v, stick, 0.0)
    assert bool(v.autopilot.modes.pilot.rudder_done) != again


def test_in_the_air_the_yaw_stick_does_not_disarm(monkeypatch: Any) -> None:
    v = hovering("ALT_HOLD")
    v.autopilot.params.ARMING.RUDDER = 2.0
    throttle(v, 0.0)
    methods: list[Any] = []
    monkeypatch.setattr(arming, "disarm", lambda v, method, force: methods.append((method, force)))
    assert held(v, -1.0, 2.0).armed
    assert methods == [(ArmingMethod.RUDDER, False)]
