# SPDX-License-Identifier: BSD-3-Clause
"""Waits that cannot come true say so at once, and no other wait does."""

from __future__ import annotations

import math

import pytest

from sitl import Simulation
from sitl.client import Client, ImpossibleWaitError, UnknownNameError, WaitTimeoutError
from sitl.errors import OptionError


@pytest.fixture(scope="module")
def ready():
    """A client of a copter that is ready to arm, and the moment it became so."""
    client = Client(Simulation("erle_copter"))
    client.wait_ready()
    return client, client.snapshot()


@pytest.fixture
def copter(ready):
    client, moment = ready
    client.restore(moment)
    return client


def at_once(client, begin):
    return client.now - begin < 2.5


def test_a_mode_that_there_is_not_is_not_waited_for(copter):
    begin = copter.now
    with pytest.raises(UnknownNameError, match=r"no mode 'AUTOO'.*did you mean 'AUTO'"):
        copter.wait_mode("AUTOO")
    assert copter.now == begin
    copter.wait_mode("STABILIZE")
    with pytest.raises(WaitTimeoutError, match="mode 99"):
        copter.wait_mode("99", timeout=0.5)  # an autopilot may have modes without a name


def test_a_disarmed_vehicle_goes_nowhere(copter):
    copter.set_mode("GUIDED")
    begin = copter.now
    with pytest.raises(ImpossibleWaitError, match=r"20 m north.*is in vain: the copter is disarmed; arm it first"):
        copter.goto(20, 0, 5)
    assert at_once(copter, begin)
    copter.goto(0, 0, copter.altitude)  # it is there


def test_one_that_is_armed_a_moment_later_is_waited_for(copter):
    copter.set_mode("GUIDED")
    copter.send_command("COMPONENT_ARM_DISARM", 1)
    with pytest.raises(WaitTimeoutError):  # it is armed, and stays on the ground
        copter.goto(20, 0, 5, timeout=4.0)


def test_one_that_is_disarmed_on_the_way_is_not_waited_for(copter):
    copter.take_off(3)
    copter.set_position(200, 0, 3)
    copter.disarm(force=True)
    begin = copter.now
    with pytest.raises(ImpossibleWaitError, match="is disarmed"):
        copter.goto(200, 0, 3)
    assert at_once(copter, begin)


def test_in_another_mode_a_vehicle_is_not_sent(copter):
    copter.set_mode("GUIDED")
    copter.arm()
    copter.set_mode("STABILIZE")
    begin = copter.now
    with pytest.raises(ImpossibleWaitError, match=r"is in mode STABILIZE, and goes where it is sent in GUIDED only"):
        copter.goto(20, 0, 5)
    assert at_once(copter, begin)


def test_one_whose_mode_was_changed_on_the_way_may_come_back(copter):
    copter.take_off(3)
    copter.set_position(10, 0, 3)
    orders = iter([(1.0, "BRAKE"), (4.0, "GUIDED")])
    begin, due = copter.now, next(orders)
    step = copter.step

    def pilot(stop_us=None):
        nonlocal due
        if due and copter.now - begin >= due[0]:
            copter.send_command("DO_SET_MODE", 1, copter._mode_number(due[1]))
            due = next(orders, None)
        step(stop_us)

    copter.step = pilot
    try:
        copter.goto(10, 0, 3)
    finally:
        del copter.step
    assert due is None


def test_a_take_off_that_ends_on_the_ground_is_over(copter):
    copter.params["DISARM_DELAY"] = 0
    step, is_asked = copter.step, []

    def switch_off(stop_us=None):
        if copter.armed and copter.altitude > 0.5 and not is_asked:
            is_asked.append(copter.now)
            copter.send_command("COMPONENT_ARM_DISARM", 0, 21196)
        step(stop_us)

    copter.step = switch_off
    try:
        with pytest.raises(ImpossibleWaitError, match="is disarmed"):
            copter.take_off(10)
    finally:
        del copter.step
    assert at_once(copter, is_asked[0])


def test_an_item_that_the_mission_has_not_is_not_waited_for(copter):
    begin = copter.now
    for wait in (copter.wait_waypoint, copter.wait_current_waypoint):
        with pytest.raises(ImpossibleWaitError, match=r"mission item 3 .*: the copter has no mission"):
            wait(3)
    home, up = copter.item("NAV_WAYPOINT"), copter.item("NAV_TAKEOFF", altitude=3)
    copter.upload([home, up, copter.item("NAV_LAND")])
    with pytest.raises(ImpossibleWaitError, match="its mission ends with item 2"):
        copter.wait_waypoint(3)
    assert copter.now - begin < 10.0
    with pytest.raises(WaitTimeoutError):
        copter.wait_waypoint(2, timeout=3.0)  # it may be started yet
    copter.start_mission()
    copter.wait_waypoint(1)


@pytest.mark.parametrize("call", [
    lambda c: c.wait_altitude(20, 10), lambda c: c.wait_groundspeed(math.nan), lambda c: c.wait_climb_rate(0, -1),
    lambda c: c.wait_altitude(1, 5, timeout=2.0, hold=3.0), lambda c: c.wait_location(0, 0, accuracy=-1.0),
])  # fmt: skip
def test_what_no_vehicle_can_do_is_refused(copter, call):
    begin = copter.now
    with pytest.raises(OptionError):
        call(copter)
    assert copter.now == begin


def test_an_order_that_could_not_be_given_is_not_repeated():
    client = Client(Simulation("erle_copter"))
    with pytest.raises(WaitTimeoutError, match="HOME_POSITION"):
        client.goto(10, 0, 5)
    client.delay(10.0)


@pytest.mark.parametrize("wait", ["wait_altitude", "wait_groundspeed", "wait_climb_rate"])
def test_a_disarmed_vehicle_on_the_ground_neither_climbs_nor_drives(copter, wait):
    begin = copter.now
    with pytest.raises(ImpossibleWaitError, match="is in vain: the copter is disarmed; arm it first"):
        getattr(copter, wait)(3)
    assert at_once(copter, begin)


def test_one_that_is_armed_or_there_or_nearly_is_waited_for(copter):
    copter.wait_altitude(-1, 1, hold=2.0)
    copter.wait_groundspeed(0, 0.5, hold=2.0)
    with pytest.raises(WaitTimeoutError):
        copter.wait_altitude(0.8, timeout=3.0)
    copter.set_mode("GUIDED")
    copter.send_command("COMPONENT_ARM_DISARM", 1)
    for wait in (copter.wait_altitude, copter.wait_groundspeed):
        with pytest.raises(WaitTimeoutError):  # it is armed, and stays on the ground
            wait(5, timeout=3.0)


def test_one_that_falls_gets_there(copter):
    copter.take_off(15)
    copter.disarm(force=True)
    copter.wait_climb_rate(-math.inf, -5, timeout=5)
    assert 2.0 < copter.altitude < 15.0
    copter.wait_altitude(-1, 2, timeout=10)
    assert copter.altitude <= 2.0
