# SPDX-License-Identifier: BSD-3-Clause
"""Switches of the transmitter in flight, SIMPLE and SUPER_SIMPLE."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import ALT_HOLD, AUTO, BRAKE, GUIDED, LAND, LOITER, STABILIZE, Aviator
from tests.pilots.witness import KEEP, LOW, Item

HIGH, MIDDLE = 2000, 1500
DEBOUNCED = 0.3  # [s]
AUX = 218
"""MAV_CMD_DO_AUX_FUNCTION"""


def move_switch(p: Aviator, channel: int, pulse: int, seconds: float = DEBOUNCED) -> None:
    """Move a switch, and wait."""
    p.override(*[KEEP] * (channel - 1), pulse)
    p.fly(seconds)


def with_switch(core: Core, function: int, **params: float) -> Aviator:
    """Booted, with a switch on channel 7, which is low."""
    p = Aviator(core, RC7_OPTION=function, RC_OVERRIDE_TIME=-1, **params)
    p.boot()
    return p


def hover(core: Core, function: int, mode: int = LOITER, **params: float) -> Aviator:
    """Hovering in ``mode`` with centred sticks and a switch on channel 7, which is low."""
    p = Aviator(core, RC7_OPTION=function, RC_OVERRIDE_TIME=-1, **params).hover(15.0)
    p.sticks(0.5)
    assert p.set_mode(mode)
    p.sticks(2.0)
    return p


def test_a_switch_arms_and_disarms(core: Core) -> None:
    p = with_switch(core, 153)
    assert p.set_mode(STABILIZE)
    p.sticks(0.5, throttle=LOW)
    move_switch(p, 7, MIDDLE)
    assert not p.ap.arming.armed
    move_switch(p, 7, HIGH, 0.1)
    assert not p.ap.arming.armed, "not yet long enough"
    p.fly(0.2)
    assert p.ap.arming.armed
    move_switch(p, 7, MIDDLE)
    assert p.ap.arming.armed
    move_switch(p, 7, LOW)
    assert not p.ap.arming.armed
    p.sticks(0.5, throttle=1700)
    move_switch(p, 7, HIGH)
    assert not p.ap.arming.armed
    assert p.said("Arm: Throttle too high")


def test_a_switch_found_high_at_first_does_not_arm(core: Core) -> None:
    p = Aviator(core, RC8_OPTION=153)  # the simulated transmitter holds channel 8 high
    p.boot()
    assert not p.ap.arming.armed
    assert not p.said("Arm")


def test_a_switch_changes_the_mode_and_gives_it_back(core: Core) -> None:
    p = hover(core, 33, FLTMODE6=ALT_HOLD)
    move_switch(p, 7, HIGH)
    assert p.mode == BRAKE
    move_switch(p, 7, MIDDLE, 0.6)
    assert p.mode == ALT_HOLD, "of the mode switch"
    move_switch(p, 7, HIGH)
    assert p.mode == BRAKE
    assert p.set_mode(LOITER)
    move_switch(p, 7, LOW, 0.6)
    assert p.mode == LOITER, "a mode that somebody else has chosen stays"


def test_a_command_does_what_a_switch_does(core: Core) -> None:
    p = with_switch(core, 0)
    for function, position, result in ((55, 2, 0), (56, 2, 0), (999, 2, 4), (55, 3, 2), (7, 0, 0)):
        assert p.ask(AUX, function, position) == result
    assert p.mode == LOITER
    assert p.said("Invalid channel option (999)")


def test_a_switch_allows_overrides(core: Core) -> None:
    p = with_switch(core, 0)
    p.sticks(0.5, throttle=1600)
    assert p.ap.rc.channels[2] == 1600
    assert p.ask(AUX, 46, 0) == 0
    p.sticks(0.5, throttle=1600)
    assert p.ap.rc.channels[2] == LOW, "the transmitter's"
    assert p.ask(AUX, 46, 2) == 0
    p.sticks(0.5, throttle=1600)
    assert p.ap.rc.channels[2] == 1600


def test_the_emergency_stop_stops_the_motors_in_flight(core: Core) -> None:
    p = hover(core, 31)
    move_switch(p, 7, HIGH, 0.8)
    assert p.said("RC7: MotorEStop HIGH")
    assert set(p.simulation.v.actuators.pwm[:4]) == {1000}
    assert p.vel[2] > 4.0, "falls"
    move_switch(p, 7, LOW, 0.5)
    assert min(p.simulation.v.actuators.pwm[:4]) > 1050


def test_nobody_arms_with_an_emergency_stop_or_the_interlock_on(core: Core) -> None:
    p = with_switch(core, 32)
    p.ask(AUX, 31, 2)
    assert p.ask(ARM, 1) == 4
    assert p.said("Arm: Motors Emergency Stopped")
    p.ask(AUX, 31, 0)
    move_switch(p, 7, HIGH)
    assert p.ask(ARM, 1) == 4
    assert p.said("Arm: Motor Interlock Enabled")
    move_switch(p, 7, LOW)
    assert p.ask(ARM, 1) == 0
    p.fly(3.0)
    assert set(p.simulation.v.actuators.pwm[:4]) == {1000}, "low: the motors stand"
    move_switch(p, 7, HIGH, 1.5)
    assert min(p.simulation.v.actuators.pwm[:4]) > 1000


def test_a_mission_is_saved_by_switch(core: Core) -> None:
    p = hover(core, 7, RC8_OPTION=58)
    for _ in range(2):
        move_switch(p, 7, HIGH)
        move_switch(p, 7, LOW)
        p.sticks(3.0, pitch=1300)
        p.sticks(3.0)
    p.hold(throttle=LOW)
    p.fly(0.1)
    move_switch(p, 7, HIGH)
    p.hold()
    items = p.simulation.mission.items
    assert [item.command for item in items] == [
        MavCmd.NAV_WAYPOINT,
        MavCmd.NAV_TAKEOFF,
        MavCmd.NAV_WAYPOINT,
        MavCmd.NAV_WAYPOINT,
        MavCmd.NAV_LAND,
    ]
    assert items[2].z == pytest.approx(15.0, abs=0.5)
    there = np.hypot(*np.subtract(items[3][6:8], p.lat_lon(*p.pos[:2]))) * 0.0111
    assert 0.5 < there < np.hypot(*p.pos[:2])
    assert p.set_mode(AUTO)
    move_switch(p, 7, LOW)
    move_switch(p, 7, HIGH)
    assert len(p.simulation.mission.items) == 5, "not in AUTO"


def test_a_switch_clears_the_mission_or_takes_it_back_to_its_start(core: Core) -> None:
    p = with_switch(core, 24)
    p.upload(Item(MavCmd.NAV_WAYPOINT, (20.0, 0.0), 10.0), Item(MavCmd.NAV_WAYPOINT, (20.0, 20.0), 10.0))
    p.ask(224, 2)
    assert p.ap.modes.nav.mission_current == 2
    move_switch(p, 7, HIGH)
    assert p.ap.modes.nav.mission_current == 0
    p.ask(AUX, 58, 2)
    assert not p.simulation.mission.items


def flown_north(p: Aviator, seconds: float = 3.0) -> tuple[float, float]:
    """How far a forward stick takes it, north and east [m]."""
    before = p.pos
    p.sticks(seconds, pitch=1300)
    moved = p.pos - before
    p.sticks(4.0)
    return float(moved[0]), float(moved[1])


def test_in_simple_forwards_is_the_heading_of_arming(core: Core) -> None:
    p = hover(core, 3)
    first = float(np.radians(p.euler[2]))
    p.sticks(2.0, yaw=1600)
    p.sticks(1.0)
    turned = float(np.radians(p.euler[2])) - first
    assert abs(np.sin(turned)) > 0.3, "it has turned"
    for pulse, heading in ((HIGH, first), (LOW, first + turned)):
        move_switch(p, 7, pulse)
        course = np.arctan2(*flown_north(p)[::-1])
        assert np.degrees(abs(np.angle(np.exp(1j * (course - heading))))) < 6.0
    assert p.said("SIMPLE mode on")
    assert p.said("SIMPLE mode off")


def test_in_super_simple_forwards_is_away_from_home(core: Core) -> None:
    p = hover(core, 13, ALT_HOLD)
    assert p.set_mode(LOITER)
    p.sticks(4.0, roll=1800)
    p.sticks(4.0)
    away = np.arctan2(p.pos[1], p.pos[0])
    assert np.hypot(*p.pos[:2]) > 12.0
    move_switch(p, 7, HIGH)
    course = np.arctan2(*flown_north(p)[::-1])
    assert np.degrees(abs(np.angle(np.exp(1j * (course - away))))) < 6.0
    assert p.said("SUPERSIMPLE mode on")


def test_positions_of_the_mode_switch_select_simple(core: Core) -> None:
    p = with_switch(core, 0, FLTMODE1=LOITER, FLTMODE2=ALT_HOLD, FLTMODE3=STABILIZE, SIMPLE=1, SUPER_SIMPLE=2)
    for pulse, mode, simple in ((1000, LOITER, 1), (1295, ALT_HOLD, 2), (1425, STABILIZE, 0), (1000, LOITER, 1)):
        move_switch(p, 5, pulse)
        assert (p.mode, p.ap.modes.simple.number) == (mode, simple)


def test_switches_of_modes_of_the_real_one_are_there(core: Core) -> None:
    p = with_switch(core, 0)
    for function, mode in ((18, LAND), (55, GUIDED), (68, STABILIZE), (70, ALT_HOLD)):
        assert p.ask(AUX, function, 2) == 0
        assert p.mode == mode


def flown(core: Core, *items: Item) -> Aviator:
    """After a mission with a take-off, these items, and a return: disarmed, or a minute later."""
    p = Aviator(core).ready()
    p.start_mission(Item(MavCmd.NAV_TAKEOFF, None, 10.0), *items, Item(MavCmd.NAV_RETURN_TO_LAUNCH))
    p.fly(60.0, lambda: not p.armed)
    return p


def test_a_mission_moves_switches(core: Core) -> None:
    """DO_AUX_FUNCTION: whatever the position, the mission goes on; a function that is not known is told."""
    function = MavCmd.DO_AUX_FUNCTION
    p = flown(
        core, Item(function, p=(999.0, 2.0)), Item(MavCmd.NAV_WAYPOINT, (3.0, 0.0), 10.0),
        Item(function, p=(58.0, 3.0)), Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0), 10.0),
    )  # fmt: skip
    assert not p.armed
    assert p.said("Mission: 2 AuxFunction")
    assert p.said("Invalid channel option (999)")
    assert p.reached == [1, 3, 5, 6]


def test_a_mission_leaves_itself_by_a_switch(core: Core) -> None:
    """BRAKE by function 33: the mission stops, and its next command is not flown."""
    p = flown(core, Item(MavCmd.DO_AUX_FUNCTION, p=(33.0, 2.0)), Item(MavCmd.NAV_WAYPOINT, (30.0, 0.0), 10.0))
    assert p.armed
    assert p.mode == BRAKE
    assert abs(p.pos[0]) < 1.0
    assert p.said("Mission: 2 AuxFunction")
    assert not p.said("Reached command #3")


def test_a_mission_that_starts_itself_again_goes_on(core: Core) -> None:
    """Function 24 sets the mission back to its start, again and again: time goes on, and the vehicle flies."""
    p = Aviator(core).ready()
    p.start_mission(Item(MavCmd.NAV_TAKEOFF, None, 10.0), Item(MavCmd.DO_AUX_FUNCTION, p=(24.0, 2.0)))
    p.fly(20.0)
    assert p.armed
    assert p.pos[2] < -8.0
