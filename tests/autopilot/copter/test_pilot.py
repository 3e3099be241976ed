# SPDX-License-Identifier: BSD-3-Clause
"""Sticks: pulses, overrides, dead zones, what the modes read."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot import mode_switch, radio
from sitl.autopilot.copter import pilot
from sitl.autopilot.copter.modes import switch
from sitl.autopilot.params.radio import RcChannel
from tests.autopilot.copter.steady_copter import make, wait

PULSES = st.integers(0, 3000)


def channel(low, trim, high, reverse=0.0, dead=0.0):
    """Calibration of a channel."""
    c = RcChannel()
    c.MIN, c.TRIM, c.MAX, c.REVERSED, c.DZ = low, trim, high, reverse, dead
    return c


@pytest.mark.parametrize(
    ("pulse", "value"),
    ((1500, 0.0), (1520, 0.0), (1480, 0.0), (1900, 1.0), (1100, -1.0), (1710, 0.5), (2100, 1.0)),
)
def test_centred_stick(pulse, value):
    assert radio.centred(pulse, channel(1100.0, 1500.0, 1900.0), 20.0) == pytest.approx(value)
    assert radio.centred(pulse, channel(1100.0, 1500.0, 1900.0, 1.0), 20.0) == pytest.approx(-value)


@given(
    PULSES,
    st.floats(800, 2200),
    st.floats(800, 2200),
    st.floats(800, 2200),
    st.sampled_from((0.0, 1.0)),
    st.floats(0, 200),
)
def test_sticks_stay_in_range_whatever_the_calibration(pulse, low, trim, high, reverse, dead):
    assert -1.0 <= radio.centred(pulse, channel(low, trim, high, reverse), dead) <= 1.0
    assert 0.0 <= radio.ranged(pulse, channel(low, trim, max(high, low), reverse, dead)) <= 1.0


def send(v, *pulses):
    for k, pulse in enumerate(pulses):
        v.autopilot.rc.override[k] = pulse
        v.autopilot.rc.override_us[k] = v.time_us


@pytest.mark.parametrize(("silent_s", "timeout", "there"), ((0.5, 1.0, True), (1.5, 1.0, False), (1.5, 2.0, True)))
def test_a_receiver_is_there_until_its_frames_stop(vehicle, silent_s, timeout, there):
    ap, sensors = vehicle.autopilot, vehicle.sensors
    sensors.rc_count, sensors.rc_channels[:4] = 8, (1500, 1500, 1200, 1500)
    sensors.rc_time_us = vehicle.time_us - round(silent_s * 1e6)
    ap.rc.receiver_us = ap.rc.override_us[:] = 0
    ap.rc.has_receiver = True
    radio.receive(ap.rc, sensors, ap.params, vehicle.time_us, 1000, timeout)
    assert ap.rc.receiver_ok == there
    assert list(ap.rc.channels[:4]) == [1500, 1500, 1200, 1500]


def test_overrides_last_three_seconds(vehicle):
    rc = vehicle.autopilot.rc
    send(vehicle, 1700, 1500, 1600)
    pilot.read(vehicle)
    assert list(rc.channels[:3]) == [1700, 1500, 1600]
    wait(vehicle, 2.9)
    pilot.read(vehicle)
    assert rc.channels[0] == 1700
    wait(vehicle, 0.2)
    pilot.read(vehicle)
    assert list(rc.channels[:3]) == [1500, 1500, 1000]


@pytest.mark.parametrize(("time", "kept"), ((-1.0, True), (0.0, False)))
def test_overrides_for_ever_or_never(vehicle, time, kept):
    vehicle.autopilot.params.RC_OVERRIDE_TIME = time
    send(vehicle, 1700)
    wait(vehicle, 1000.0 if kept else 0.0)
    pilot.read(vehicle)
    assert (vehicle.autopilot.rc.channels[0] == 1700) == kept


def test_sticks_can_be_mapped_to_other_channels(vehicle):
    vehicle.autopilot.params.RCMAP_ROLL, vehicle.autopilot.params.RCMAP_YAW = 4.0, 1.0
    send(vehicle, 1900, 1500, 1000, 1100)
    pilot.read(vehicle)
    sticks = vehicle.autopilot.modes.pilot
    assert (sticks.roll, sticks.yaw) == (-1.0, 1.0)


def test_throttle_counts_as_zero_only_after_a_while(vehicle):
    sticks = vehicle.autopilot.modes.pilot
    send(vehicle, 1500, 1500, 1500)
    pilot.read(vehicle)
    assert sticks.throttle_zero == 0
    send(vehicle, 1500, 1500, 1000)
    for seconds, zero in ((0.3, 0), (0.2, 1)):
        wait(vehicle, seconds)
        pilot.read(vehicle)
        assert sticks.throttle_zero == zero


@pytest.mark.parametrize(
    ("throttle", "climb"),
    ((1500, 0.0), (1560, 0.0), (1430, 0.0), (1900, 2.5), (1700, 0.9520), (1100, -2.5), (1300, -1.0495)),
)
def test_climb_rate(vehicle, throttle, climb):
    """The middle of the stick is that of its channel: its dead zone RC3_DZ is at the low end only."""
    ap = vehicle.autopilot
    assert (ap.params.RC[2].MIN, ap.params.RC[2].MAX, ap.params.RC[2].DZ) == (1100.0, 1900.0, 30.0)
    ap.modes.pilot.throttle = radio.ranged(throttle, ap.params.RC[2])
    assert pilot.climb_rate(ap.modes, ap.rc, ap.params) == pytest.approx(climb, abs=2e-4)


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.1, 1.3), st.floats(0.1, 1.3))
def test_the_lean_never_exceeds_the_limit(roll, pitch, most, limit):
    v = make()
    v.autopilot.modes.pilot.roll, v.autopilot.modes.pilot.pitch = roll, pitch
    r, p = pilot.lean_angles(v.autopilot.modes.pilot, most, limit)
    assert math.cos(r) * math.cos(p) >= math.cos(min(most, limit)) - 1e-9
    assert r * roll >= 0.0 and p * pitch >= 0.0


STICKS = st.sampled_from((-1.0, -0.3, -0.0, 0.0, 0.3, 1.0))


@given(st.lists(st.tuples(STICKS, STICKS, st.sampled_from((0.0, 0.4, 0.5)), st.sampled_from((0.0, 0.2, 0.5)))))
def test_the_lean_is_that_of_the_sticks_of_now(asked):
    """Kept from tick to tick, it has the bits of one worked out anew, signs of zeros too."""
    sticks = make().autopilot.modes.pilot
    for sticks.roll, sticks.pitch, most, limit in asked:
        for _ in range(2):
            kept, anew = (
                pilot.lean_angles(sticks, most, limit), pilot.lean_of_sticks(sticks.roll, sticks.pitch, most, limit)
            )  # fmt: skip
            assert [x.hex() for x in kept] == [x.hex() for x in anew]


@given(st.floats(0, 1), st.floats(0.1, 0.9), st.floats(0.125, 0.6875))
def test_throttle_curve_ends_at_both_ends_and_rises(x, middle, hover):
    assert pilot.throttle_out(0.0, middle, hover) == 0.0
    assert pilot.throttle_out(middle, middle, 0.5) == pytest.approx(0.5)
    assert pilot.throttle_out(1.0, middle, hover) == pytest.approx(1.0)
    assert pilot.throttle_out(x, middle, hover) <= pilot.throttle_out(min(x + 0.01, 1.0), middle, hover) + 1e-9


def test_a_channel_without_a_range_has_its_middle_at_half():
    assert radio.ranged_middle(channel(1100.0, 1500.0, 1120.0, dead=30.0)) == 0.5
    assert radio.ranged_middle(channel(1000.0, 1500.0, 2000.0)) == 0.5


def test_mode_switch_changes_the_mode_when_it_moves_and_only_then(vehicle):
    ap = vehicle.autopilot
    ap.params.FLTMODE6, ap.params.FLTMODE1 = 2.0, 5.0

    def frames(pulse, n=20):
        for _ in range(n):
            send(vehicle, 1500, 1500, 1000, 1500, pulse)
            pilot.read(vehicle)
            switch.read_switches(vehicle)
            wait(vehicle, 0.02)

    frames(1800)
    assert ap.modes.number == 2
    ap.modes.number = 4  # by the ground station
    frames(1800)
    assert ap.modes.number == 4
    frames(1100, 5)
    assert ap.modes.number == 4  # shorter than the debounce
    frames(1100)
    assert ap.modes.number == 5


@pytest.mark.parametrize(
    ("pulse", "position"),
    ((900, -1), (1000, 0), (1231, 1), (1361, 2), (1491, 3), (1621, 4), (1750, 5), (2200, -1)),
)
def test_positions_of_the_mode_switch(pulse, position):
    assert mode_switch.position(pulse) == position


@pytest.mark.parametrize(
    ("armed", "yaw", "rudder", "after"),
    ((0, 1900, 2, 1), (0, 1900, 1, 1), (0, 1100, 2, 0), (1, 1100, 2, 0), (1, 1100, 1, 1), (0, 1900, 0, 0)),
)
def test_yaw_stick_arms_and_disarms_after_two_seconds(vehicle, armed, yaw, rudder, after):
    ap = vehicle.autopilot
    ap.params.ARMING_RUDDER = float(rudder)
    ap.arming.armed = armed
    for _ in range(110):
        send(vehicle, 1500, 1500, 1000, yaw)
        pilot.read(vehicle)
        switch.read_rudder(vehicle)
        wait(vehicle, 0.02)
    assert ap.arming.armed == after
