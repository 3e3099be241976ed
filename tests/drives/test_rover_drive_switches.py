# SPDX-License-Identifier: BSD-3-Clause
"""Switches of the transmitter on a rover."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.drives.rover_driver import AUTO, HOLD, LOITER, MANUAL, STEERING, Driver
from tests.pilots.witness import KEEP, LOW, Item

HIGH = 2000
AUX = 218
"""MAV_CMD_DO_AUX_FUNCTION"""


def move_switch(d: Driver, channel: int, pulse: int, seconds: float = 0.3) -> None:
    """Move a switch, and wait."""
    d.override(*[KEEP] * (channel - 1), pulse)
    d.fly(seconds)


def with_switch(core: Core, function: int) -> Driver:
    """Booted, with a switch on channel 7, which is low."""
    d = Driver(core, "ardupilot_rover", RC7_OPTION=function, RC_OVERRIDE_TIME=-1)
    return d.ready()


def test_a_switch_arms_and_disarms(core: Core) -> None:
    d = with_switch(core, 153)
    for pulse, armed in ((HIGH, True), (LOW, False)):
        move_switch(d, 7, pulse)
        assert d.ap.arming.armed == armed


def test_switches_change_the_mode_and_give_it_back(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", RC6_OPTION=53, RC7_OPTION=54, MODE_CH=8, MODE6=LOITER, RC_OVERRIDE_TIME=-1)
    d.ready()
    move_switch(d, 6, HIGH)
    assert d.mode == STEERING
    move_switch(d, 7, HIGH)
    assert d.mode == HOLD
    move_switch(d, 6, LOW)
    assert d.mode == HOLD
    move_switch(d, 7, LOW, 0.6)
    assert d.mode == LOITER


def test_the_emergency_stop_stops_the_motors(core: Core) -> None:
    d = with_switch(core, 31)
    assert d.set_mode(MANUAL)
    d.arm()
    d.sticks(3.0, throttle=1700)
    assert d.simulation.v.actuators.pwm[2] > 1550
    move_switch(d, 7, HIGH)
    assert d.simulation.v.actuators.pwm[2] == 1500
    move_switch(d, 7, LOW)
    assert d.simulation.v.actuators.pwm[2] > 1550


def test_a_mission_is_saved_by_switch(core: Core) -> None:
    d = with_switch(core, 7)
    move_switch(d, 7, HIGH)
    assert d.said("SaveWP: Mission cleared!")
    assert [item.command for item in d.simulation.mission.items] == [MavCmd.NAV_WAYPOINT], "home"
    assert d.set_mode(MANUAL)
    d.arm()
    for _ in range(2):
        d.sticks(3.0, throttle=1700)
        move_switch(d, 7, LOW)
        move_switch(d, 7, HIGH)
    items = d.simulation.mission.items
    assert len(items) == 3
    apart = np.hypot(*np.subtract(items[2][6:8], items[1][6:8])) * 0.0111
    assert apart > 5.0
    assert d.set_mode(AUTO)
    move_switch(d, 7, LOW)
    move_switch(d, 7, HIGH)
    assert len(d.simulation.mission.items) == 3, "not in AUTO"


@pytest.mark.parametrize(("function", "result"), [(54, 0), (154, 4), (3, 4)])
def test_it_has_the_rovers_functions_only(core: Core, function: int, result: int) -> None:
    assert with_switch(core, 0).ask(AUX, function, 2) == result


def test_a_mission_moves_switches(core: Core) -> None:
    """DO_AUX_FUNCTION 54: HOLD; the mission stops there."""
    d = Driver(core, "ardupilot_rover").ready()
    d.arm()
    here, there = Item(MavCmd.NAV_WAYPOINT, (3.0, 0.0)), Item(MavCmd.NAV_WAYPOINT, (30.0, 0.0))
    d.start_mission(here, Item(MavCmd.DO_AUX_FUNCTION, p=(54.0, 2.0)), there)
    d.fly(15.0)
    assert d.said("Mission: 2 AuxFunction")
    assert d.mode == HOLD
    assert d.reached == [1]
