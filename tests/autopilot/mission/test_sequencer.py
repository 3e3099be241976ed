# SPDX-License-Identifier: BSD-3-Clause
"""The order in which commands are given, and what is told meanwhile.

Nothing is flown here: commands complete by event.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.autopilot.arming_checks import DISARMED
from sitl.autopilot.copter.mission import COMMANDS as COPTER
from sitl.autopilot.copter.modes import auto_yaw
from sitl.autopilot.copter.navigation import command as path_command
from sitl.autopilot.copter.navigation import waypoint
from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.events import emit
from sitl.autopilot.mission import item as c
from sitl.autopilot.mission import jumps
from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.autopilot.mission.mission import Mission
from sitl.autopilot.mission.sequencer import Sequencer
from sitl.autopilot.mission.validate import check
from sitl.autopilot.modes import MODE_CHANGED
from sitl.autopilot.navigation import command, path
from sitl.autopilot.navigation.state import (
    COMPLETE,
    CONDITION_DELAY,
    CONDITION_NONE,
    LAND,
    LOITER_UNLIMITED,
    NONE,
    RUNNING,
    STOPPED,
    WAYPOINT,
)
from sitl.autopilot.navigation.state import TAKEOFF as TAKE_OFF
from sitl.autopilot.notes import CurrentChanged, ItemReached, Text
from sitl.autopilot.rover.mission import COMMANDS as ROVER
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.core.vectors import Vec3
from sitl.vehicle.copter import Copter

LAT, LON, ALT = -353632621, 1491652371, 584.0
WP = MissionItem(MavCmd.NAV_WAYPOINT, x=LAT + 1000, y=LON, z=10.0)
TAKEOFF = MissionItem(MavCmd.NAV_TAKEOFF, z=10.0)
SPEED = MissionItem(MavCmd.DO_CHANGE_SPEED, p1=1.0, p2=5.0)


def jump(target: int, times: int) -> MissionItem:
    """DO_JUMP."""
    return MissionItem(MavCmd.DO_JUMP, p1=float(target), p2=float(times))


def tag(number: int) -> MissionItem:
    """JUMP_TAG."""
    return MissionItem(MavCmd.JUMP_TAG, p1=float(number))


def to_tag(number: int, times: int) -> MissionItem:
    """DO_JUMP_TAG."""
    return MissionItem(MavCmd.DO_JUMP_TAG, p1=float(number), p2=float(times))


class Vehicle:
    """A vehicle in AUTO, 10 m over home, whose commands complete when the test says so."""

    def __init__(self, *items: MissionItem) -> None:
        self.fleet = Copter.fleet(1)
        self.v: Any = Copter.of(self.fleet, 0)
        ap = self.v.autopilot
        TABLE.set_defaults(ap.params)
        ap.estimate.origin_set = 1
        ap.estimate.origin_lat, ap.estimate.origin_lon, ap.estimate.origin_alt = LAT, LON, ALT
        ap.estimate.pos = ap.estimate.pos.replace(z=-10.0)
        ap.modes.number = COPTER.auto
        self.mission = Mission((home_item(LAT, LON, ALT), *items)) if items else Mission()
        self.sequencer = Sequencer(self, COPTER)
        self.nav = ap.modes.nav
        self.told: list[Any] = []

    def start(self) -> Vehicle:
        """Enter AUTO."""
        self.told += self.sequencer.start(self.v)
        return self

    def complete(self) -> int:
        """The command under way is done; returns the number of the next."""
        ap, now = self.v.autopilot, int(self.v.time_us)
        path_command.begin(ap.modes.nav, ap.control, ap.estimate, ap.params, now)
        command.complete(ap.modes.nav, ap.events, now)
        self.told += self.sequencer.attend()
        return int(self.nav.command_seq) if self.nav.mission_state == RUNNING else 0

    def wait(self, seconds: float) -> None:
        """Let time pass for conditions."""
        ap = self.v.autopilot
        self.v.time_us += round(seconds * 1e6)
        command.check_condition(ap.modes.nav, ap.events, int(self.v.time_us), ap.estimate.pos, True)
        self.told += self.sequencer.attend()

    def order(self, most: int = 20) -> list[int]:
        """Numbers of the commands as they are given, from the present one on."""
        seen = [int(self.nav.command_seq)]
        while len(seen) < most and (seq := self.complete()) > 0:
            seen.append(seq)
        return seen

    def texts(self) -> list[str]:
        """What was said."""
        return [n.text for n in self.told if isinstance(n, Text)]


def test_texts_as_recorded() -> None:
    """The recorded square says these texts and numbers, in this order."""
    p = Vehicle(TAKEOFF, WP, WP._replace(y=LON + 500), MissionItem(MavCmd.NAV_LAND)).start()
    assert p.v.autopilot.modes.mission_takes_off == 1
    p.order()
    assert p.told[:10] == [
        Text(6, "Mission: 1 Takeoff"),
        CurrentChanged(1),
        ItemReached(1),
        Text(6, "Mission: 2 WP"),
        CurrentChanged(2),
        ItemReached(2),
        Text(6, "Reached command #2"),
        Text(6, "Mission: 3 WP"),
        CurrentChanged(3),
        ItemReached(3),
    ]
    assert "Mission: 4 Land" in p.texts()


def test_disarming_starts_again() -> None:
    """Landed and disarmed in AUTO: back to item 1;
    the landing that completes in the same tick is not told.
    """
    p = Vehicle(TAKEOFF, MissionItem(MavCmd.NAV_LAND)).start()
    assert p.complete() == 2
    assert p.nav.command_kind == LAND
    emit(p.v.autopilot.events, 0, DISARMED, 13.0, 0.0)
    command.complete(p.v.autopilot.modes.nav, p.v.autopilot.events, 0)
    p.told.clear()
    p.told += p.sequencer.attend()
    assert p.told == [Text(6, "Mission: 1 Takeoff"), CurrentChanged(1)]


@pytest.mark.parametrize(
    ("items", "order"),
    [
        ([WP, WP, jump(1, 2), WP], [1, 2, 1, 2, 1, 2, 4]),
        ([WP, jump(1, 0), WP], [1, 3]),
        ([WP, WP, jump(2, 1), jump(1, 1), WP], [1, 2, 2, 1, 2, 5]),
        ([tag(7), WP, tag(8), WP, to_tag(8, 2), WP], [2, 4, 4, 4, 6]),
        ([WP, to_tag(8, 1), WP, tag(8), WP], [1, 5]),
        ([WP, to_tag(9, 1), WP], [1]),
        ([WP, jump(4, 1), WP, WP], [1, 4]),
        ([WP, jump(99, 1), WP], [1]),
        ([WP, jump(0, 1), WP], [1]),
        ([WP, jump(2, -1), WP], [1]),
        ([WP, jump(2, 3), WP], [1, 3]),
        ([WP, jump(3, -1), jump(2, -1)], [1]),
        ([WP, WP, jump(1, -1)], [1, 2] * 10),
        ([WP, SPEED, jump(2, -1)], [1]),
        ([SPEED, WP, SPEED], [2]),
        ([SPEED, SPEED], [0]),
    ],
)
def test_order(items: list[MissionItem], order: list[int]) -> None:
    """Jumps with counts, forwards, nowhere, to themselves, in circles, for ever."""
    p = Vehicle(*items).start()
    assert p.order() == order
    if len(order) < 20:
        assert p.nav.mission_state == COMPLETE
        assert p.nav.command_kind == LOITER_UNLIMITED


def test_jumps_are_told_and_kept_in_the_record() -> None:
    """A jump says its count, and a copy of the record goes on from there."""
    p = Vehicle(WP, WP, jump(1, 2), WP).start()
    p.complete()
    assert p.complete() == 1
    assert "Mission: 3 Jump 1/2" in p.texts()
    assert jumps.runs(p.nav) == {3: 1}
    copy = p.fleet.copy()
    assert p.order() == [1, 2, 1, 2, 4]
    p.fleet[:] = copy
    assert p.order() == [1, 2, 1, 2, 4]


def test_do_commands_run_on_the_way_to_the_next_command() -> None:
    """The first before the next navigation command begins, the others once it is under way, as in ArduPilot."""
    p = Vehicle(WP, SPEED, SPEED._replace(p2=3.0), WP, SPEED._replace(p2=7.0)).start()
    assert p.texts() == ["Mission: 1 WP"]
    assert p.nav.speed_ne == 0.0
    p.told.clear()
    assert p.complete() == 4
    assert p.texts() == [
        "Reached command #1", "Mission: 2 ChangeSpeed", "Mission: 4 WP", "Mission: 3 ChangeSpeed"
    ]  # fmt: skip
    assert p.nav.speed_ne == 3.0
    assert p.complete() == 0
    assert p.nav.speed_ne == 7.0


def test_only_the_first_of_the_last_do_commands_runs() -> None:
    p = Vehicle(WP, SPEED, SPEED._replace(p2=3.0)).start()
    assert p.complete() == 0
    assert p.nav.speed_ne == 5.0
    assert p.nav.mission_state == COMPLETE


def test_conditions_hold_the_do_commands_behind_them_back() -> None:
    wait = MissionItem(MavCmd.CONDITION_DELAY, p1=2.0)
    p = Vehicle(WP, SPEED, wait, SPEED._replace(p2=3.0), WP, SPEED._replace(p2=7.0), WP).start()
    assert p.complete() == 5
    assert p.texts()[-2:] == ["Mission: 5 WP", "Mission: 3 CondDelay"]
    assert p.nav.speed_ne == 5.0
    assert p.nav.condition_kind == CONDITION_DELAY
    p.wait(1.9)
    assert p.nav.speed_ne == 5.0
    p.wait(0.1)
    assert p.nav.speed_ne == 3.0
    assert p.nav.condition_kind == CONDITION_NONE
    assert ItemReached(3) in p.told
    assert p.complete() == 7
    assert p.nav.speed_ne == 7.0


def test_held_back_is_passed_over() -> None:
    """A do-command whose condition is not met in time does not run."""
    p = Vehicle(WP, MissionItem(MavCmd.CONDITION_DELAY, p1=60.0), SPEED, WP, WP).start()
    assert p.complete() == 4
    assert p.complete() == 5
    p.wait(100.0)
    assert p.nav.speed_ne == 0.0


def test_a_condition_begins_anew_when_the_mission_goes_on() -> None:
    p = Vehicle(WP, MissionItem(MavCmd.CONDITION_DELAY, p1=60.0), SPEED, WP, WP).start()
    assert p.complete() == 4
    p.sequencer.stop(p.v)
    p.told.clear()
    p.start()
    assert p.texts() == ["Mission: 2 CondDelay", "Mission: 4 WP"]
    p.wait(60.0)
    assert p.nav.speed_ne == 5.0
    p.sequencer.stop(p.v)
    p.told.clear()
    p.start()
    assert p.texts() == ["Mission: 4 WP"]


def test_a_turn_goes_on_when_the_next_command_begins() -> None:
    """CONDITION_YAW runs before the waypoint behind it, which does not turn the nose back."""
    p = Vehicle(WP, MissionItem(MavCmd.CONDITION_YAW, p1=90.0), WP, WP).start()
    yaw = p.v.autopilot.modes.auto_yaw
    p.complete()
    assert yaw.mode == auto_yaw.FIXED
    p.complete()
    assert yaw.mode != auto_yaw.FIXED


def test_leaving_and_resuming() -> None:
    """AUTO goes on where it was; MIS_RESTART starts again, unless an item was chosen meanwhile."""
    p = Vehicle(WP, WP._replace(x=LAT), WP, WP).start()
    assert p.complete() == 2
    p.told += p.sequencer.on_event(p.v, MODE_CHANGED, 5.0, 0.0)
    assert p.nav.mission_state == STOPPED
    assert p.nav.command_kind == NONE
    p.told.clear()
    p.told += p.sequencer.on_event(p.v, MODE_CHANGED, 3.0, 0.0)
    assert p.texts() == ["Mission: 2 WP"]
    p.v.autopilot.params.MIS_RESTART = 1
    p.sequencer.stop(p.v)
    p.start()
    assert p.nav.command_seq == 1
    p.sequencer.stop(p.v)
    assert p.sequencer.set_current(p.v, 3) == (True, [CurrentChanged(3)])
    p.start()
    assert p.nav.command_seq == 3


def test_leaving_keeps_the_new_modes_legs() -> None:
    """RTL asks for its leg before the shell hears that AUTO was left; it gets it."""
    p = Vehicle(WP).start()
    ap = p.v.autopilot
    waypoint.stop(ap.modes.nav)
    ap.modes.number, ap.modes.nav.speed_ne = 6, 4.0
    path.request_leg(ap.modes.nav, ap.events, 0, Vec3(0.0, 0.0, -15.0))
    emit(ap.events, 0, MODE_CHANGED, 6.0, 0.0)
    p.sequencer.attend()
    assert p.nav.current.segments > 0
    assert p.nav.speed_ne == 4.0
    assert p.nav.mission_state == STOPPED


def test_set_current_in_flight() -> None:
    """The chosen item is flown at once, jumps count anew; numbers outside the mission are refused."""
    p = Vehicle(WP, WP, jump(1, 1), WP).start()
    p.order(4)
    ok, told = p.sequencer.set_current(p.v, 2)
    assert ok
    assert Text(6, "Mission: 2 WP") in told
    assert p.order() == [2, 1, 2, 4]
    assert p.sequencer.set_current(p.v, 5) == (False, [])
    assert p.sequencer.set_current(p.v, -1) == (False, [])
    ok, _ = p.sequencer.set_current(p.v, 0)  # the mission is complete by now
    assert ok and p.nav.command_seq == 4
    ok, _ = p.sequencer.set_current(p.v, 0, reset=True)
    assert ok
    assert p.nav.command_seq == 1
    assert Vehicle().sequencer.set_current(p.v, 0) == (False, [])


def test_end_on_the_ground() -> None:
    """On the ground the mission's end leaves no command; AUTO disarms."""
    p = Vehicle(MissionItem(MavCmd.NAV_LAND)).start()
    p.v.autopilot.arming.landed = 1
    p.complete()
    assert p.nav.mission_state == COMPLETE
    assert p.nav.command_kind == NONE


def test_new_mission_in_flight() -> None:
    """The present command goes on; the next comes from the new mission, which may be shorter."""
    p = Vehicle(WP, WP, WP).start()
    p.complete()
    assert not p.sequencer.may_clear(p.v)
    land = MissionItem(MavCmd.NAV_LAND)
    p.sequencer.set_mission(p.v, Mission((*p.mission.items[:3], land)))
    assert p.nav.command_kind == WAYPOINT
    assert p.complete() == 3
    assert p.nav.command_kind == LAND
    p.sequencer.set_mission(p.v, Mission(p.mission.items[:2]))
    assert p.complete() == 0
    assert p.nav.mission_state == COMPLETE
    assert p.v.autopilot.params.MIS_TOTAL == 2


RESTARTED = [Text(6, "Mission: 1 WP"), Text(2, "Auto mission changed, restarted command")]


def test_a_leg_under_way_begins_anew_with_each_upload() -> None:
    p = Vehicle(WP, WP, WP).start()
    for place in (WP, WP._replace(y=LON + 5000)):
        begun = int(p.nav.command_count)
        assert p.sequencer.set_mission(p.v, Mission((p.mission.items[0], place, WP))) == RESTARTED
        assert p.nav.command_count == begun + 1 and p.nav.command_seq == 1
    assert p.nav.target[1] == pytest.approx(5000 * 0.009, abs=5.0)


def test_other_commands_under_way_go_on_as_they_are() -> None:
    p = Vehicle(TAKEOFF, WP).start()
    begun = int(p.nav.command_count)
    assert p.sequencer.set_mission(p.v, Mission((p.mission.items[0], TAKEOFF._replace(z=20.0), WP))) == []
    assert p.nav.command_count == begun and p.nav.target[2] == pytest.approx(-10.0)


@pytest.mark.parametrize("left", [2, 1, 0])
def test_a_leg_goes_on_to_its_end_when_its_item_is_gone(left: int) -> None:
    """The mission stays under way until the vehicle is there; disarmed it is over."""
    p = Vehicle(WP, WP).start()
    assert p.complete() == 2
    target, begun = p.nav.target, int(p.nav.command_count)
    notes = p.sequencer.set_mission(p.v, Mission(p.mission.items[:left]))
    assert notes == [Text(2, "Auto mission changed but failed to restart command")]
    assert p.nav.command_count == begun and p.nav.target == target
    assert (p.nav.mission_state, p.nav.mission_current) == (RUNNING, 2)
    assert p.complete() == 0
    assert p.nav.mission_state == COMPLETE


def test_disarmed_without_a_mission_nothing_is_under_way() -> None:
    p = Vehicle(WP).start()
    p.sequencer.set_mission(p.v, Mission())
    p.sequencer.reset(p.v)
    assert (p.nav.mission_state, p.nav.mission_current, p.nav.command_kind) == (STOPPED, 0, NONE)


def test_texts_of_items_that_have_no_other_effect() -> None:
    p = Vehicle(
        tag(7),
        MissionItem(MavCmd.DO_SET_ROI_LOCATION, x=LAT, y=LON),
        MissionItem(MavCmd.DO_SET_ROI_NONE),
        MissionItem(MavCmd.NAV_DELAY, p1=3.7),
    ).start()
    said = ["Mission: 1 Tag 0", "Mission: 4 Delay", "Delaying 3 sec", "Mission: 2 SetROILocation"]
    assert p.texts() == [*said, "Mission: 3 SetROINone"]


def test_corner_is_planned_ahead() -> None:
    """The leg after the next is known when a waypoint without delay begins, through jumps and do-commands."""
    there = WP._replace(x=LAT + 3000)
    p = Vehicle(SPEED, WP, SPEED, jump(6, 1), WP, there).start()
    assert p.nav.current.fast == 1
    assert p.nav.next.length == pytest.approx(2000 * 0.0111319, rel=1e-3)
    assert p.nav.current.top_speed == 5.0
    assert Vehicle(WP._replace(p1=1.0), there).start().nav.current.fast == 0
    assert Vehicle(WP, MissionItem(MavCmd.NAV_LAND)).start().nav.current.fast == 0


@pytest.mark.parametrize("frame", [0, 3, 10])
def test_altitude_frames(frame: int) -> None:
    """Above sea level, above home, above terrain (flat, at home's height)."""
    p = Vehicle(WP._replace(frame=frame, z=594.0 if frame == 0 else 10.0)).start()
    assert p.nav.target[2] == pytest.approx(-10.0)


def test_set_home_and_roi() -> None:
    """DO_SET_HOME moves home to a place or to the vehicle; DO_SET_ROI turns the nose to a place."""
    roi = MissionItem(MavCmd.DO_SET_ROI, x=LAT + 1000, y=LON + 1000)
    p = Vehicle(MissionItem(MavCmd.DO_SET_HOME, 0, x=LAT + 2000, y=LON, z=600.0), roi, WP).start()
    home = p.v.autopilot.home
    assert (int(home.lat), float(home.alt), int(home.locked)) == (LAT + 2000, 600.0, 0)
    assert home.pos[0] == pytest.approx(2000 * 0.0111319, rel=1e-3)
    assert p.v.autopilot.modes.auto_yaw.roi[0] == pytest.approx(11.13, abs=0.01)
    p = Vehicle(MissionItem(MavCmd.DO_SET_HOME, p1=1.0), WP).start()
    assert p.v.autopilot.home.alt == pytest.approx(594.0)


small = st.integers(-2, 8).map(float)
anything = st.one_of(small, st.floats(allow_nan=False, allow_infinity=False, width=32))
items = st.builds(
    MissionItem,
    st.sampled_from(sorted(COPTER.taken)),
    st.sampled_from([0, 3, 10]),
    anything,
    anything,
    anything,
    small,
    st.sampled_from([0, LAT, LAT + 5000, -900000000]),
    st.sampled_from([0, LON, LON - 5000, 1800000000]),
    st.sampled_from([0.0, 10.0, -82999.0]),
    st.just(1),
    st.just(0),
)
acts = st.lists(st.sampled_from(["complete", "wait", "leave", "start", "set", "disarm", "speed"]), max_size=12)


@given(st.lists(items.filter(lambda i: check(i) == 0), max_size=8), st.lists(acts, max_size=12))
@settings(max_examples=60, deadline=None)
def test_no_mission_breaks_it(listed: list[MissionItem], todo: list[str]) -> None:
    """Any valid items in any order, with anything happening: no error, and the state stays in its bounds."""
    p = Vehicle(*listed).start()
    for act in todo:
        if act == "complete":
            p.complete()
        elif act == "wait":
            p.wait(3.0)
        elif act in ("leave", "start"):
            p.sequencer.on_event(p.v, MODE_CHANGED, 5.0 if act == "leave" else 3.0, 0.0)
        elif act == "set":
            p.sequencer.set_current(p.v, len(listed) // 2)
        elif act == "disarm":
            p.sequencer.on_event(p.v, DISARMED, 0.0, 0.0)
        else:
            p.sequencer.change_speed(p.v, 0, 2.0)
        assert p.nav.mission_state in (STOPPED, RUNNING, COMPLETE)
        assert 0 <= p.nav.mission_current <= len(listed)
        assert np.isfinite(p.nav.target).all()
        if p.nav.mission_state == RUNNING:
            assert p.nav.command_kind != NONE


@pytest.mark.parametrize("number", [*c.MARKS, *c.VIDEO_COMMANDS])
def test_marks_and_devices_that_are_not_fitted_are_passed(number: int) -> None:
    p = Vehicle(WP, MissionItem(number), WP).start()
    assert p.order() == [1, 3]
    assert number in COPTER.taken and number in ROVER.taken


def test_vertical_take_off_and_landing_are_the_copters_own() -> None:
    p = Vehicle(MissionItem(MavCmd.NAV_VTOL_TAKEOFF, z=10.0), MissionItem(MavCmd.NAV_VTOL_LAND)).start()
    assert p.v.autopilot.modes.mission_takes_off and p.nav.command_kind == TAKE_OFF
    p.complete()
    assert p.nav.command_kind == LAND
    assert MavCmd.NAV_VTOL_LAND not in ROVER.taken


def test_a_jump_for_ever_says_so() -> None:
    p = Vehicle(WP, WP, jump(1, -1)).start()
    p.order(5)
    assert "Mission: 3 Jump 0/unlimited" in p.texts()


def test_of_a_tag_nothing_is_told_when_it_is_passed() -> None:
    p = Vehicle(WP, tag(7), WP).start()
    p.complete()
    assert "Mission: 2 Tag 0" in p.texts()
    assert [n.seq for n in p.told if isinstance(n, ItemReached)] == [1]


def test_a_do_command_behind_a_waypoint_is_told_in_place_of_it() -> None:
    """As ArduPilot, which sends one MISSION_ITEM_REACHED for both."""
    p = Vehicle(WP, SPEED, SPEED, WP).start()
    p.complete()
    assert [(n.seq, n.is_sent) for n in p.told if isinstance(n, ItemReached)] == [(1, False), (2, True), (3, True)]


def test_what_is_not_carried_out_is_passed_over() -> None:
    up, reverse = MissionItem(MavCmd.NAV_CONTINUE_AND_CHANGE_ALT), MissionItem(MavCmd.DO_SET_REVERSE, p1=1.0)
    p = Vehicle(WP, up, reverse, WP).start()
    assert p.complete() == 4
    assert p.texts()[-4:] == [
        "Mission: 2 ContinueAndChangeAlt",
        "Mission: 3 SetReverse",
        "Mission: 4 WP",
        "Skipping invalid cmd #194",
    ]


@pytest.mark.parametrize("command", [MavCmd.NAV_ARC_WAYPOINT, MavCmd.NAV_SCRIPT_TIME, MavCmd.NAV_ATTITUDE_TIME])
def test_what_is_carried_out_in_part_says_so(command: int) -> None:
    p = Vehicle(WP, MissionItem(command, p1=3.0, p2=3.0, x=LAT, y=LON), WP).start()
    assert p.complete() == 2
    assert any("is flown as" in text for text in p.texts())


@pytest.mark.parametrize(
    ("items", "takes_off"),
    [
        ((SPEED, MissionItem(MavCmd.NAV_DELAY, p1=60.0), TAKEOFF), 1),
        ((MissionItem(MavCmd.NAV_DELAY, p1=60.0), WP, TAKEOFF), 0),
        ((MissionItem(MavCmd.NAV_DELAY, p1=60.0),), 0),
        ((MissionItem(MavCmd.NAV_DELAY, p1=60.0), jump(1, -1)), 0),
        ((), 0),
    ],
)
def test_delays_may_stand_before_the_take_off(items: tuple[MissionItem, ...], takes_off: int) -> None:
    assert Vehicle(*items).v.autopilot.modes.mission_takes_off == takes_off


def test_a_delay_until_a_time_of_day() -> None:
    p = Vehicle(WP, MissionItem(MavCmd.NAV_DELAY, p2=0.0, p3=1.0, p4=17.0), WP).start()
    p.complete()
    assert "Delaying 77 sec" in p.texts() and p.nav.delay == 77.0


def test_another_mission_goes_on_at_the_number_where_the_one_before_was_left() -> None:
    """As ArduPilot; a client that means the beginning says MISSION_SET_CURRENT 0."""
    p = Vehicle(WP, WP, WP).start()
    p.complete()
    p.sequencer.stop(p.v)
    p.sequencer.set_mission(p.v, Mission((home_item(LAT, LON, ALT), WP, WP, WP, WP)))
    assert p.nav.mission_current == 2
    p.start()
    assert p.nav.command_seq == 2
    p.sequencer.stop(p.v)
    p.sequencer.set_mission(p.v, Mission((home_item(LAT, LON, ALT), WP)))
    p.start()
    assert p.nav.command_seq == 1


OVER_GROUND = MissionItem(MavCmd.NAV_WAYPOINT, MavFrame.GLOBAL_TERRAIN_ALT, x=LAT + 1000, y=LON, z=10.0)
RETURN = MissionItem(MavCmd.DO_RETURN_PATH_START, x=LAT + 1000, y=LON, z=10.0)
LANDING = MissionItem(MavCmd.DO_LAND_START)


@pytest.mark.parametrize(
    ("items", "takes_off", "lands", "returns", "over_ground"),
    [
        ((TAKEOFF, WP), True, False, False, False),
        ((WP, TAKEOFF), False, False, False, False),
        ((SPEED, TAKEOFF), True, False, False, False),
        ((TAKEOFF, WP, LANDING, WP), True, True, False, False),
        ((TAKEOFF, RETURN, WP), True, False, True, False),
        ((TAKEOFF, WP, OVER_GROUND), True, False, False, True),
        ((TAKEOFF, WP, SPEED._replace(frame=MavFrame.GLOBAL_TERRAIN_ALT)), True, False, False, False),  # has no height
    ],
)
def test_the_vehicle_knows_what_its_mission_needs(
    items: tuple[MissionItem, ...], takes_off: bool, lands: bool, returns: bool, over_ground: bool
) -> None:
    """Whether AUTO may start on the ground, AUTO_RTL has where to go, heights need terrain data; MIS_TOTAL."""
    vehicle = Vehicle()
    vehicle.sequencer.set_mission(vehicle.v, Mission((home_item(LAT, LON, ALT), *items)))
    modes = vehicle.v.autopilot.modes
    assert (modes.mission_takes_off, modes.mission_lands, modes.mission_returns, modes.mission_over_ground) == (
        takes_off, lands, returns, over_ground,
    )  # fmt: skip
    assert modes.mission_count == vehicle.v.autopilot.params.MIS.TOTAL == len(items) + 1
