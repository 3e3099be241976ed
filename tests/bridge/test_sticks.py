# SPDX-License-Identifier: BSD-3-Clause
"""Pulses and axes from the ground station, on records."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.bridge.copter import joystick as copter
from sitl.bridge.rover import joystick as rover
from sitl.bridge.services.rc import INVALID, ManualControl, RcChannelsOverride, rc_channels_override
from tests.bridge.fakes import FakeRover, FakeVehicle, filled

NOW, PILOT, STRANGER = 5_000_000, 255, 245


def vehicle(fake: FakeVehicle) -> Any:
    """A record whose channels run from 1100 to 1900."""
    fake.v.time_us = NOW
    for channel in fake.v.autopilot.params.RC:
        channel.MIN, channel.MAX = 1100.0, 1900.0
    return fake.v


@pytest.fixture
def v() -> Any:
    return vehicle(FakeVehicle())


@pytest.mark.parametrize(("pulse", "first", "extended"), [
    (0, 0, 1500), (800, 800, 800), (2200, 2200, 2200), (799, 1500, 1500), (2201, 1500, 1500),
    (65534, 1500, 0), (65535, 1500, 1500),
])  # fmt: skip
def test_pulses(v: Any, pulse: int, first: int, extended: int) -> None:
    rc = v.autopilot.rc
    rc.override[:] = 1500
    rc_channels_override(filled(RcChannelsOverride, **{f"chan{k}_raw": pulse for k in range(1, 19)}), v, PILOT)
    assert list(rc.override) == [first] * 8 + [extended] * 10
    assert list(rc.override_us) == [NOW * (x != 1500) for x in rc.override]
    assert v.autopilot.modes.failsafe.gcs_us == NOW


def test_each_channel_is_its_own(v: Any) -> None:
    pulses = {f"chan{k}_raw": 1000 + k for k in range(1, 19)}
    rc_channels_override(filled(RcChannelsOverride, **pulses), v, PILOT)
    assert list(v.autopilot.rc.override) == list(pulses.values())


@pytest.mark.parametrize(("axes", "pulses"), [
    ({"y": 1000, "x": -1000, "z": 500, "r": 0}, [1900, 1900, 1500, 1500]),
    ({"y": -1000, "x": 1000, "z": 0, "r": 500}, [1100, 1100, 1100, 1700]),
    ({"y": INVALID, "x": INVALID, "z": 1000, "r": INVALID}, [0, 0, 1900, 0]),
    ({"y": 5000, "x": 5000, "z": -5000, "r": -5000}, [1900, 1100, 1100, 1100]),
])  # fmt: skip
def test_axes_of_the_copter(v: Any, axes: dict[str, int], pulses: list[int]) -> None:
    copter.manual_control(filled(ManualControl, target=1, **axes), v, PILOT)
    assert list(v.autopilot.rc.override[:4]) == pulses
    assert v.autopilot.modes.failsafe.gcs_us == NOW


def test_axes_of_the_rover() -> None:
    v = vehicle(FakeRover())
    rover.manual_control(filled(ManualControl, target=1, y=500, z=-1000, x=77, r=77), v, PILOT)
    assert list(v.autopilot.rc.override[:4]) == [1700, 0, 1100, 0]


@pytest.mark.parametrize(("parameter", "channel", "pulse"), [(0, 1, 1900), (8, 8, 1900), (9, 9, 1900), (18, 18, 1900)])
def test_the_channel_of_a_stick_is_a_parameter(v: Any, parameter: int, channel: int, pulse: int) -> None:
    v.autopilot.params.RCMAP.ROLL = float(parameter)
    copter.manual_control(filled(ManualControl, target=1, y=1000, x=INVALID, z=INVALID, r=INVALID), v, PILOT)
    assert {k + 1: p for k, p in enumerate(v.autopilot.rc.override) if p != 0} == {channel: pulse}


def test_a_channel_that_there_is_not(v: Any) -> None:
    v.autopilot.params.RCMAP.ROLL = 19.0
    copter.manual_control(filled(ManualControl, target=1, y=1000, x=INVALID, z=INVALID, r=INVALID), v, PILOT)
    assert not any(v.autopilot.rc.override)


@pytest.mark.parametrize(("sender", "target", "system", "is_taken"), [
    (PILOT, 1, 1, True), (STRANGER, 1, 1, False), (PILOT, 0, 1, False), (PILOT, 7, 1, False), (PILOT, 7, 7, True),
])  # fmt: skip
def test_whose_axes_count(v: Any, sender: int, target: int, system: int, is_taken: bool) -> None:
    v.autopilot.params.MAV.SYSID = float(system)
    copter.manual_control(filled(ManualControl, target=target, y=1000), v, sender)
    assert any(v.autopilot.rc.override) == is_taken == (v.autopilot.modes.failsafe.gcs_us == NOW)


@pytest.mark.parametrize("pilot", [PILOT, STRANGER])
def test_whose_pulses_count(v: Any, pilot: int) -> None:
    v.autopilot.params.MAV.GCS_SYSID = float(pilot)
    for sender in (PILOT, STRANGER):
        before = bytes(v._bytes)
        rc_channels_override(filled(RcChannelsOverride, chan1_raw=1500), v, sender)
        assert (bytes(v._bytes) != before) == (sender == pilot)


def test_channels_have_their_own_ends_up_to_the_sixteenth(v: Any) -> None:
    """Those beyond go from 1100 to 1900."""
    for channel in v.autopilot.params.RC:
        channel.MIN, channel.MAX = 1000.0, 1400.0
    for number, pulse in ((1, 1300), (16, 1300), (17, 1700), (18, 1700)):
        v.autopilot.rc.override[:] = 0
        v.autopilot.params.RCMAP.ROLL = float(number)
        copter.manual_control(filled(ManualControl, target=1, y=500, x=INVALID, z=INVALID, r=INVALID), v, PILOT)
        assert {k + 1: p for k, p in enumerate(v.autopilot.rc.override) if p != 0} == {number: pulse}


def test_a_switch_keeps_ground_stations_from_the_sticks(v: Any) -> None:
    v.autopilot.rc.override_blocked = True
    rc_channels_override(filled(RcChannelsOverride, chan1_raw=1500), v, PILOT)
    copter.manual_control(filled(ManualControl, target=1, y=500), v, PILOT)
    assert not any(v.autopilot.rc.override) and v.autopilot.modes.failsafe.gcs_us == NOW
