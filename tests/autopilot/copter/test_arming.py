# SPDX-License-Identifier: BSD-3-Clause
"""Arming checks, their texts, and who may disarm when."""

from __future__ import annotations

import pytest

from sitl.autopilot.arming_checks import ARMED, ARMING_REFUSED, DISARMED, ArmingMethod
from sitl.autopilot.copter import arming
from sitl.autopilot.copter.modes.mode_list import TITLES
from sitl.core.vectors import Vec3
from tests.autopilot.copter.steady_copter import codes, fly, wait

STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, LAND, BRAKE, SMART_RTL = 0, 2, 3, 4, 5, 6, 9, 17, 21
S = 1_000_000


def booting(v, mode, seconds):
    """The vehicle at a moment of its start: origin after 20 s, GPS in use after 41.6 s."""
    ap = v.autopilot
    ap.modes.number, v.time_us = mode, round(seconds * S)
    ap.estimate.attitude_ok = int(seconds > 6)
    ap.home.is_set = int(seconds > 20)
    v.sensors.gps_fix = 3 if seconds > 10 else 0
    ap.estimate.position_ok = int(seconds > 41.6)
    return v


@pytest.mark.parametrize(
    ("mode", "seconds", "texts"),
    (
        (STABILIZE, 12, ["Accels inconsistent"]),
        (STABILIZE, 14, ["Gyros inconsistent"]),
        (STABILIZE, 23, ["Gyros inconsistent"]),
        (STABILIZE, 23.5, []),
        (GUIDED, 14, ["Gyros inconsistent", "AHRS: waiting for home"]),
        (GUIDED, 30, ["Need Position Estimate"]),
        (GUIDED, 41.7, []),
        (LOITER, 30, ["Need Position Estimate"]),
        (ALT_HOLD, 30, []),
    ),
)
def test_a_start_as_recorded(vehicle, mode, seconds, texts):
    booting(vehicle, mode, seconds)
    assert arming.texts(vehicle, arming.check(vehicle), "") == texts
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (not texts, [f"Arm: {t}" for t in texts])


def test_imus_that_differed_are_trusted_after_ten_seconds(vehicle):
    v = booting(vehicle, STABILIZE, 30)
    sensors = v.sensors

    def said_at(seconds):
        v.time_us = seconds * S
        return arming.texts(v, arming.check(v), "")

    sensors.imu_state, sensors.acc2 = 256, sensors.acc + Vec3(0.0, 0.0, 1.0)
    assert said_at(31) == ["Accels inconsistent"]
    sensors.imu_state, sensors.acc2 = 0, Vec3(0.0, 0.0, 0.0)  # as with one IMU
    assert (said_at(40), said_at(41)) == (["Accels inconsistent"], [])
    sensors.imu_state, sensors.acc2, sensors.gyro2 = 256, sensors.acc, sensors.gyro + Vec3(0.1, 0.0, 0.0)
    assert said_at(42) == ["Gyros inconsistent"]
    sensors.gyro2 = sensors.gyro
    assert (said_at(51), said_at(52)) == (["Gyros inconsistent"], [])


def test_forcing_skips_all_but_the_position_that_the_mode_needs(vehicle):
    booting(vehicle, GUIDED, 14)
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, True) == (
        False,
        ["Arm: Need Position Estimate", "Arm: Gyros inconsistent", "Arm: AHRS: waiting for home"],
    )
    vehicle.autopilot.modes.number = STABILIZE
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, True) == (True, [])


@pytest.mark.parametrize("mode", (RTL, LAND, BRAKE, AUTO, SMART_RTL))
def test_modes_that_cannot_be_armed(vehicle, mode):
    vehicle.autopilot.modes.number = mode
    vehicle.autopilot.modes.mission_count = 2
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (False, [f"Arm: {TITLES[mode]} mode not armable"])


def test_auto_can_be_armed_with_the_option(vehicle):
    vehicle.autopilot.modes.number = AUTO
    vehicle.autopilot.params.AUTO_OPTIONS = 1.0
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (False, ["Arm: Mode requires mission"])
    vehicle.autopilot.modes.mission_count = 2
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (True, [])


@pytest.mark.parametrize(
    ("mode", "throttle", "ok"),
    (
        (STABILIZE, 0.0, True),
        (STABILIZE, 0.1, False),
        (ALT_HOLD, 0.5, True),
        (ALT_HOLD, 0.7, False),
        (GUIDED, 0.9, True),
    ),
)
def test_throttle(vehicle, mode, throttle, ok):
    vehicle.autopilot.modes.number = mode
    vehicle.autopilot.modes.pilot.throttle = throttle
    texts = [] if ok else ["Arm: Throttle too high"]
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (ok, texts)


def set_fields(v, **fields):
    for name, value in fields.items():
        place = v.autopilot
        *path, last = name.split("__")
        for part in path:
            place = getattr(place, part)
        setattr(place, last, value)


@pytest.mark.parametrize(
    ("fields", "text"),
    (
        ({"control__motors__count": 0}, "Motors: Check frame class and type"),
        ({"control__attitude__cos_lean": 0.8}, "Leaning"),
        ({"rc__receiver_ok": 0, "rc__receiver_us": 0}, "RC not found"),
        (
            {"params__BATT_MONITOR": 4.0, "battery__driver": 4, "params__BATT_ARM_VOLT": 11.0},
            "Battery 1 below minimum arming voltage",
        ),
        (
            {"params__BATT_MONITOR": 4.0, "battery__driver": 4, "battery__voltage": 10.0},
            "Battery 1 low voltage failsafe",
        ),
        ({"params__BATT_MONITOR": 4.0}, "Battery 1 unhealthy"),
        ({"estimate__attitude_ok": 0}, "EKF attitude is bad"),
    ),
)
def test_other_checks(vehicle, fields, text):
    set_fields(vehicle, **fields)
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (False, [f"Arm: {text}"])
    assert codes(vehicle) == [ARMING_REFUSED]
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, True)[0]


def test_checks_can_be_switched_off(vehicle):
    booting(vehicle, STABILIZE, 12)
    vehicle.autopilot.params.ARMING_CHECK = 0.0
    assert arming.arm(vehicle, ArmingMethod.MAVLINK, False) == (True, [])


def test_arming_moves_home_here_unless_it_is_locked(vehicle):
    ap = vehicle.autopilot
    ap.estimate.pos = (3.0, 4.0, -1.0)
    ap.home.locked = 1
    arming.arm(vehicle, ArmingMethod.MAVLINK, False)
    assert list(ap.home.pos) == [0.0, 0.0, 0.0]
    arming.disarm(vehicle, ArmingMethod.MAVLINK, 0)
    ap.home.locked = 0
    arming.arm(vehicle, ArmingMethod.MAVLINK, False)
    assert list(ap.home.pos) == [3.0, 4.0, -1.0]
    assert ap.home.alt == 585.0
    assert codes(vehicle) == [ARMED, DISARMED, ARMED]


def test_motors_wait_two_seconds(vehicle):
    ap = vehicle.autopilot
    arming.arm(vehicle, ArmingMethod.MAVLINK, False)
    for seconds, waits in ((0.0, 1), (1.9, 1), (0.2, 0)):
        wait(vehicle, seconds)
        arming.follow_throttle(ap.arming, ap.modes, vehicle.time_us)
        assert ap.modes.arming_delay == waits


@pytest.mark.parametrize(
    ("mode", "landed", "method", "force", "done"),
    (
        (GUIDED, 0, ArmingMethod.MAVLINK, 0, 0),
        (GUIDED, 0, ArmingMethod.MAVLINK, 1, 1),
        (GUIDED, 1, ArmingMethod.MAVLINK, 0, 1),
        (GUIDED, 0, ArmingMethod.RUDDER, 0, 0),
        (STABILIZE, 0, ArmingMethod.RUDDER, 0, 1),
        (STABILIZE, 0, ArmingMethod.MAVLINK, 0, 0),
        (GUIDED, 0, ArmingMethod.CRASH, 0, 1),
    ),
)
def test_who_may_disarm(flying, mode, landed, method, force, done):
    fly(flying, mode)
    flying.autopilot.arming.landed = landed
    assert arming.disarm(flying, method, force) == done
    assert flying.autopilot.arming.armed == 1 - done
    assert (DISARMED in codes(flying)) == bool(done)


def test_disarming_what_is_disarmed_is_accepted_silently(vehicle):
    assert arming.disarm(vehicle, ArmingMethod.MAVLINK, 0) == 1
    assert codes(vehicle) == []


def test_left_alone_it_disarms_after_the_delay(vehicle):
    arming.arm(vehicle, ArmingMethod.MAVLINK, False)
    wait(vehicle, 9.9)
    arming.disarm_idle(vehicle)
    assert vehicle.autopilot.arming.armed == 1
    wait(vehicle, 0.2)
    arming.disarm_idle(vehicle)
    assert vehicle.autopilot.arming.armed == 0


@pytest.mark.parametrize(
    "busy", ({"arming__landed": 0}, {"modes__pilot__throttle_zero": 0}, {"control__motors__spool_state": 3})
)
def test_the_delay_starts_again_while_it_is_busy(vehicle, busy):
    arming.arm(vehicle, ArmingMethod.MAVLINK, False)
    set_fields(vehicle, **busy)
    wait(vehicle, 60.0)
    arming.disarm_idle(vehicle)
    assert vehicle.autopilot.arming.armed == 1


def test_auto_armed_follows_the_throttle(vehicle):
    ap = vehicle.autopilot
    arming.arm(vehicle, ArmingMethod.MAVLINK, False)
    ap.modes.pilot.throttle_zero = 0
    arming.follow_throttle(ap.arming, ap.modes, vehicle.time_us)
    assert ap.arming.auto_armed == 1
    ap.modes.pilot.throttle_zero = 1
    arming.follow_throttle(ap.arming, ap.modes, vehicle.time_us)
    assert ap.arming.auto_armed == 0  # STABILIZE: throttle closed
    ap.modes.number, ap.arming.auto_armed = GUIDED, 1
    arming.follow_throttle(ap.arming, ap.modes, vehicle.time_us)
    assert ap.arming.auto_armed == 1
