# SPDX-License-Identifier: BSD-3-Clause
"""Radio, ground station, battery, GPS and estimator lost on the drive; blocked wheels; arming; motor test."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.drives.rover_driver import (
    ACRO,
    AIRFRAMES,
    AUTO,
    CIRCLE,
    GUIDED,
    HOLD,
    LOITER,
    MANUAL,
    RTL,
    SIMPLE,
    SMART_RTL,
    STEERING,
    VELOCITY,
    Driver,
)
from tests.pilots.witness import Item

ALL = pytest.mark.parametrize("frame", AIRFRAMES)
BOTH = pytest.mark.parametrize("frame", ["erle_rover", "skid_rover"])
REFUSED = 4


def beat(d: Driver) -> None:
    """A ground station's heartbeat."""
    d.send("HEARTBEAT", type=6, autopilot=8, system_status=4, mavlink_version=3)


@ALL
@pytest.mark.parametrize("mode", [MANUAL, GUIDED])
def test_transmitter_lost(core: Core, frame: str, mode: int) -> None:
    """The receiver is silent: centred sticks after RC_FS_TIMEOUT (1 s), HOLD after FS_TIMEOUT (1.5 s) more."""
    d = Driver(core, frame).armed_in(mode)
    d.fly(1.0)
    d.set_parameter("SIM_RC_FAIL", 1)
    start = d.now
    assert d.fly(5.0, lambda: d.mode == HOLD)
    assert d.now - start == pytest.approx(2.5, abs=0.15)
    assert d.said("Radio Failsafe") and not d.said("Radio Failsafe Cleared")
    d.set_parameter("SIM_RC_FAIL", 0)
    d.fly(1.0)
    assert d.said("Radio Failsafe Cleared")
    assert d.mode == HOLD and d.armed, "the mode stays"


@BOTH
def test_sticks_that_fall_silent_do_not_drive_on(core: Core, frame: str) -> None:
    """Overrides are good for three seconds; then the receiver's own channels, which are centred."""
    d = Driver(core, frame).armed_in(MANUAL)
    d.sticks(4.0, throttle=1800)
    d.let_go()
    assert d.speed > 0.5
    d.fly(2.5)
    assert d.speed > 0.5
    d.wait_until_it_stands(6.0)


@pytest.mark.parametrize(
    ("action", "mode"), [(0, MANUAL), (1, RTL), (2, HOLD), (3, SMART_RTL), (4, SMART_RTL), (6, LOITER)]
)
def test_what_a_lost_transmitter_does(core: Core, action: int, mode: int) -> None:
    d = Driver(core, "erle_rover", FS_ACTION=action).armed_in(MANUAL)
    d.sticks(8.0, throttle=1800)
    d.set_parameter("SIM_RC_FAIL", 1)
    d.let_go()
    d.fly(7.0)
    assert d.mode == mode and d.armed
    if mode in (RTL, SMART_RTL):
        assert d.fly(60.0, lambda: d.said("Reached destination"))
        d.wait_until_it_stands()
        assert d.away(0.0, 0.0) < 2.5


def test_termination(core: Core) -> None:
    d = Driver(core, "erle_rover", FS_ACTION=5).armed_in(MANUAL)
    d.set_parameter("SIM_RC_FAIL", 1)
    d.fly(2.0)
    assert d.armed, "RC_FS_TIMEOUT and FS_TIMEOUT are not over"
    d.wait_disarmed(4.0)
    assert d.mode == MANUAL and d.said("Radio Failsafe")


@pytest.mark.parametrize(("choice", "mode"), [(0, MANUAL), (1, HOLD), (2, HOLD)])
def test_throttle_below_the_failsafe_pulse(core: Core, choice: int, mode: int) -> None:
    d = Driver(core, "erle_rover", FS_THR_ENABLE=choice).armed_in(MANUAL)
    d.sticks(3.0, throttle=890)
    assert d.mode == mode
    if choice != 0:
        assert abs(d.speed) < 0.1, "it does not back up on such a pulse"


@pytest.mark.parametrize(("options", "mode"), [(1, HOLD), (2, AUTO)])
def test_missions_go_on_without_radio_when_told(core: Core, options: int, mode: int) -> None:
    """FS_THR_ENABLE 2."""
    d = Driver(core, "erle_rover", FS_THR_ENABLE=options).armed_in()
    d.start_mission(Item(MavCmd.NAV_LOITER_UNLIM, (30.0, 0.0)))
    d.fly(5.0)
    d.set_parameter("SIM_RC_FAIL", 1)
    d.fly(4.0)
    assert d.mode == mode
    assert d.said("Failsafe - Continuing Auto Mode") == (mode == AUTO)


@pytest.mark.parametrize(("choice", "mode"), [(0, GUIDED), (1, RTL)])
def test_ground_station_lost(core: Core, choice: int, mode: int) -> None:
    d = Driver(core, "erle_rover", FS_GCS_ENABLE=choice, FS_ACTION=1).armed_in()
    beat(d)
    d.stream(6.0, VELOCITY, vx=1.0)
    assert d.mode == GUIDED
    d.stream(1.0, VELOCITY, vx=1.0)
    assert d.mode == mode
    assert d.said("GCS Failsafe") == (choice != 0)
    beat(d)
    d.fly(1.0)
    assert d.said("GCS Failsafe Cleared") == (choice != 0)


@pytest.mark.parametrize(
    ("params", "mode"),
    [
        ({"BATT_LOW_VOLT": 60.0, "BATT_FS_LOW_ACT": 1}, RTL),
        ({"BATT_LOW_VOLT": 60.0, "BATT_FS_LOW_ACT": 0}, GUIDED),
        ({"BATT_LOW_VOLT": 0, "BATT_CRT_VOLT": 60.0, "BATT_FS_CRT_ACT": 2}, HOLD),
        ({"BATT_LOW_VOLT": 0, "BATT_FS_LOW_ACT": 2, "BATT_LOW_MAH": 39970}, HOLD),
    ],
)
def test_battery(core: Core, params: dict, mode: int) -> None:
    d = Driver(core, "erle_rover").armed_in()
    for name, value in params.items():
        d.set_parameter(name, value)
    d.stream(15.0, VELOCITY, vx=1.2)
    assert d.mode == mode
    assert d.said("Battery 1 is")


@ALL
@pytest.mark.parametrize(
    ("mode", "then"), [(GUIDED, HOLD), (LOITER, HOLD), (RTL, HOLD), (CIRCLE, HOLD), (SIMPLE, HOLD), (MANUAL, MANUAL)]
)
def test_gps_lost(core: Core, frame: str, mode: int, then: int) -> None:
    """Modes that need a position become HOLD; there it stands, and modes that need none still drive."""
    d = Driver(core, frame).armed_in()
    d.get_going(seconds=8.0)
    assert d.set_mode(mode)
    d.set_parameter("SIM_GPS1_ENABLE", 0)
    for _ in range(150):
        if d.mode == GUIDED:
            d.target(VELOCITY, vx=d.cruise)
        d.fly(0.1)
    assert d.mode == then
    assert d.said("EKF failsafe") == (then != mode)
    d.wait_until_it_stands()
    for refused in (GUIDED, LOITER, AUTO, RTL, CIRCLE):
        assert not d.set_mode(refused)
    assert d.set_mode(MANUAL)
    d.sticks(3.0, throttle=1700)
    assert d.speed > 0.1


@BOTH
def test_gps_comes_back(core: Core, frame: str) -> None:
    d = Driver(core, frame).armed_in()
    d.get_going(seconds=6.0)
    d.set_parameter("SIM_GPS1_ENABLE", 0)
    d.stream(15.0, VELOCITY, vx=d.cruise)
    assert d.mode == HOLD
    d.set_parameter("SIM_GPS1_ENABLE", 1)
    d.fly(15.0)
    assert d.said("EKF failsafe cleared")
    assert d.set_mode(RTL)
    assert d.fly(90.0, lambda: d.said("Reached destination"))
    d.wait_until_it_stands()
    assert np.hypot(*d.place) < float(d.ap.params.WP_RADIUS) + 1.5


@ALL
@pytest.mark.parametrize(("check", "armed"), [(0, True), (1, True), (2, False)])
def test_blocked(core: Core, frame: str, check: int, armed: bool) -> None:
    """Wheels that find no grip: HOLD after two seconds (FS_CRASH_CHECK 1), disarmed, too (2)."""
    d = Driver(core, frame, FS_CRASH_CHECK=check).armed_in()
    d.simulation.v.physics.derived.drive_grip = 0.0  # ice
    d.simulation.v.physics.derived.yaw_step = 0.0
    d.stream(8.0, VELOCITY, vx=d.cruise)
    assert np.hypot(*d.place) < 0.05
    assert d.said("Crash: Going to HOLD") == (check > 0)
    assert d.mode == (HOLD if check else GUIDED)
    assert d.armed == armed


# ---------------------------------------------------------------------- arming


@pytest.mark.parametrize(
    ("mode", "result"),
    [(MANUAL, 0), (HOLD, 0), (ACRO, REFUSED), (STEERING, REFUSED), (GUIDED, REFUSED), (LOITER, REFUSED),
     (CIRCLE, REFUSED), (RTL, REFUSED), (SIMPLE, REFUSED)],
)  # fmt: skip
def test_arming_without_a_position(core: Core, mode: int, result: int) -> None:
    """Modes that need none may be armed; a car's ACRO and STEERING need its speed."""
    d = Driver(core, "erle_rover")
    d.fly(27.0)
    assert d.set_mode(mode), "disarmed a mode may be chosen without a position"
    assert d.ask(ARM, 1) == result
    d.fly(1.1)
    assert d.armed == (result == 0)


def test_skid_steering_arms_in_acro_without_a_position(core: Core) -> None:
    d = Driver(core, "skid_rover")
    d.fly(27.0)
    assert d.set_mode(ACRO)
    assert d.ask(ARM, 1) == 0


@pytest.mark.parametrize(
    ("mode", "result"), [(GUIDED, 0), (LOITER, 0), (AUTO, 0), (RTL, REFUSED), (SMART_RTL, REFUSED)]
)
def test_arming_with_a_position(core: Core, mode: int, result: int) -> None:
    """Not in modes that would drive off."""
    d = Driver(core, "erle_rover").ready()
    d.set_mode(mode)
    assert d.ask(ARM, 1) == result


def test_arming_with_sticks_off_centre(core: Core) -> None:
    d = Driver(core, "erle_rover").ready()
    assert d.set_mode(MANUAL)
    d.sticks(0.5, throttle=1700)
    assert d.ask(ARM, 1) == REFUSED
    d.sticks(0.5, steering=1700)
    assert d.ask(ARM, 1) == REFUSED
    d.sticks(0.5)
    assert d.ask(ARM, 1) == 0


def test_a_driving_rover_may_be_disarmed(core: Core) -> None:
    d = Driver(core, "erle_rover").armed_in()
    d.get_going()
    assert d.disarm_result() == 0
    d.wait_until_it_stands()
    assert not d.armed


@pytest.mark.parametrize("stays", [True, False])
def test_arming_by_stick(core: Core, stays: bool) -> None:
    """Steering to the right for two seconds in MANUAL arms, to the left disarms."""
    d = Driver(core, "erle_rover").ready()
    assert d.set_mode(MANUAL)
    d.sticks(2.6 if stays else 1.0, steering=2000)
    d.sticks(1.5)
    assert d.armed == stays
    if stays:
        d.sticks(2.6, steering=1000)
        d.sticks(1.5)
        assert not d.armed


# ---------------------------------------------------------------------- motor test


@pytest.mark.parametrize(
    ("frame", "motor", "output"),
    [("erle_rover", 1, 2), ("erle_rover", 2, 0), ("skid_rover", 3, 0), ("skid_rover", 4, 2)],
)
def test_motor_test(core: Core, frame: str, motor: int, output: int) -> None:
    """One output works for its time, the others rest, and it disarms."""
    d = Driver(core, frame).ready()
    assert d.set_mode(MANUAL)
    assert d.ask(209, motor, 0, 30, 3) == 0
    d.fly(1.5)
    pulses = [int(p) for p in d.simulation.v.actuators.pwm[:4]]
    assert pulses[output] > 1550
    assert pulses[2 - output] == 1500
    d.fly(3.0)
    assert not d.armed
    d.wait_until_it_stands()


@pytest.mark.parametrize(("frame", "motor"), [("erle_rover", 3), ("skid_rover", 1), ("skid_rover", 5)])
def test_motor_test_of_a_motor_that_is_not_there(core: Core, frame: str, motor: int) -> None:
    """One that is on other rovers is taken, and the test is over at once."""
    d = Driver(core, frame).ready()
    assert d.ask(209, motor, 0, 30, 3) == (REFUSED if motor == 5 else 0)
    assert not d.armed
