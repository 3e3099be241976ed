# SPDX-License-Identifier: BSD-3-Clause
"""A receiver at the physics' side takes the place of the simulated transmitter, and is lost when its frames stop."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.firmware import FIRMWARE
from sitl.autopilot.radio import RECEIVER_PULSES, receive
from sitl.vehicle.copter import Copter

TIMEOUT = 1.0


@pytest.fixture
def v():
    vehicle = Copter()
    FIRMWARE.table.set_defaults(vehicle.autopilot.params)
    vehicle.autopilot.rc.has_receiver = 1
    vehicle.time_us = 10_000_000
    return vehicle


def frame(v, *pulses: int) -> None:
    v.sensors.rc_channels[: len(pulses)] = pulses
    v.sensors.rc_count += 1
    v.sensors.rc_time_us = v.time_us


def listen(v) -> None:
    receive(v.autopilot.rc, v.sensors, v.autopilot.params, v.time_us, 1000, TIMEOUT)


def test_without_frames_there_is_the_simulated_transmitter(v) -> None:
    listen(v)
    assert tuple(v.autopilot.rc.channels[:8]) == RECEIVER_PULSES and v.autopilot.rc.receiver_ok


def test_frames_are_the_pilot(v) -> None:
    frame(v, 1400, 1500, 1600, 1700)
    listen(v)
    assert v.autopilot.rc.channels.tolist() == [1400, 1500, 1600, 1700] + [0] * 14
    assert v.autopilot.rc.receiver_ok


def test_frames_that_stop_are_a_lost_receiver(v) -> None:
    frame(v, 1400, 1500, 1600, 1700)
    listen(v)
    v.time_us += 999_000
    listen(v)
    assert v.autopilot.rc.receiver_ok
    v.time_us += 1000
    listen(v)
    assert not v.autopilot.rc.receiver_ok
    frame(v, 1500)
    listen(v)
    assert v.autopilot.rc.receiver_ok


def test_the_ground_station_still_overrides_it(v) -> None:
    frame(v, 1400, 1500, 1600, 1700)
    v.autopilot.rc.override[0], v.autopilot.rc.override_us[0] = 1900, v.time_us
    listen(v)
    assert v.autopilot.rc.channels[:2].tolist() == [1900, 1500]


def test_a_receiver_that_is_switched_off_hears_nothing(v) -> None:
    frame(v, 1400, 1500, 1600, 1700)
    v.autopilot.rc.has_receiver = 0  # SIM_RC_FAIL
    listen(v)
    assert not v.autopilot.rc.receiver_ok and not v.autopilot.rc.channels.any()
