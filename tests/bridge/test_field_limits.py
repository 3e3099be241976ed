# SPDX-License-Identifier: BSD-3-Clause
"""Ends of what fields of messages carry: conversions of telemetry, and the error for a value that does not fit."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.dialect import FieldError, UnknownMessageError, layout_of, message, message_by_id
from sitl.bridge.telemetry import build
from sitl.bridge.telemetry.channels import servo_output_raw
from sitl.bridge.telemetry.units import heading_cdeg, int16, int16s, int32, percent, uint8, uint16
from sitl.bridge.wire.port import Port
from sitl.core.vectors import Vec3
from sitl.vehicle.copter import Copter
from tests.bridge.fakes import Bench

ENDS = [
    (int16, -32769.0, -32768), (int16, -32768.0, -32768), (int16, -32767.9, -32767), (int16, 32766.9, 32766),
    (int16, 32767.0, 32767), (int16, 32768.0, 32767),
    (uint8, -1.0, 0), (uint8, 0.9, 0), (uint8, 254.9, 254), (uint8, 255.0, 255), (uint8, 256.0, 255),
    (uint16, -1.0, 0), (uint16, 0.0, 0), (uint16, 0.9, 0), (uint16, 65535.0, 65535), (uint16, 65536.0, 65535),
    (int32, 2147483646.0, 2147483646), (int32, 2147483647.0, 2147483647), (int32, 2147483648.0, 2147483647),
    (int32, 2147483650.0, 2147483647), (int32, -2147483647.0, -2147483647), (int32, -2147483648.0, -2147483648),
    (int32, -2147483650.0, -2147483648), (int32, 1.4, 1), (int32, -1.6, -2),
    (percent, 0.0, 0), (percent, 0.9, 0), (percent, 100.0, 100), (percent, 100.1, 100), (percent, -1e-9, -1),
    (heading_cdeg, 0.0, 0), (heading_cdeg, math.pi, 18000), (heading_cdeg, 2.0 * math.pi, 0),
    (heading_cdeg, 359.99 * math.pi / 180.0 + 1e-9, 35999), (heading_cdeg, -math.pi / 180.0, 35900),
    (heading_cdeg, 3.0 * math.pi, 18000), (heading_cdeg, 1e9, 0),
]  # fmt: skip


@pytest.mark.parametrize(("unit", "x", "expected"), ENDS)
def test_numbers_at_the_ends_of_integers(unit: Any, x: float, expected: int) -> None:
    assert unit(x) == expected


def test_each_component_is_its_own() -> None:
    assert int16s(Vec3(1.9, -2.9, 40000.0)) == (1, -2, 32767)


@pytest.mark.parametrize(
    ("name", "field", "value", "allowed"),
    [
        ("HEARTBEAT", "type", 256, "whole numbers 0 .. 255"),
        ("HEARTBEAT", "type", -1, "whole numbers 0 .. 255"),
        ("HEARTBEAT", "type", 1.5, "whole numbers 0 .. 255"),
        ("HEARTBEAT", "custom_mode", 1 << 32, "whole numbers 0 .. 4294967295"),
        ("SCALED_IMU", "xacc", 32768, "whole numbers -32768 .. 32767"),
        ("SCALED_IMU", "xacc", -32769, "whole numbers -32768 .. 32767"),
        ("GLOBAL_POSITION_INT", "lat", 1 << 31, "whole numbers -2147483648 .. 2147483647"),
        ("TIMESYNC", "tc1", 1 << 63, "whole numbers -9223372036854775808 .. 9223372036854775807"),
        ("SYSTEM_TIME", "time_unix_usec", 1 << 64, "whole numbers 0 .. 18446744073709551615"),
        ("ATTITUDE", "roll", "a", "numbers in single precision"),
        ("ATTITUDE", "roll", 1e39, "numbers in single precision"),
        ("PARAM_VALUE", "param_id", 5, "bytes (b'...'), at most 16"),
        ("ATTITUDE_TARGET", "q", (1.0,) * 5, "a sequence of at most 4 numbers in single precision"),
        ("ATTITUDE_TARGET", "q", (1.0, "x"), "a sequence of at most 4 numbers in single precision"),
        ("BATTERY_STATUS", "voltages", (65536,), "a sequence of at most 10 whole numbers 0 .. 65535"),
    ],
)
def test_a_value_that_does_not_fit_is_named_with_what_does(name: str, field: str, value: Any, allowed: str) -> None:
    with pytest.raises(FieldError) as caught:
        message(name).payload(**{field: value})
    assert str(caught.value) == f"{name}.{field} cannot be {value!r}; allowed: {allowed}"
    assert (caught.value.message, caught.value.field, caught.value.value) == (name, field, value)


def test_the_culprit_is_the_field_that_does_not_fit_and_not_one_before_it() -> None:
    with pytest.raises(FieldError, match=r"BATTERY_STATUS\.type cannot be 256"):
        message("BATTERY_STATUS").payload(voltages=(1,) * 10, temperature=-5, type=256)


@pytest.mark.parametrize(("name", "field", "value"), [("HEARTBEAT", "type", 255), ("SCALED_IMU", "xacc", -32768),
                                                      ("TIMESYNC", "tc1", -(1 << 63))])  # fmt: skip
def test_the_last_value_that_fits_arrives(name: str, field: str, value: int) -> None:
    assert getattr(message(name).decode(message(name).payload(**{field: value})), field) == value


def test_arrays_that_are_shorter_or_missing_are_filled_with_zeros() -> None:
    kind = message("ATTITUDE_TARGET")
    assert kind.decode(kind.payload(q=(1.0, 0.5))).q == (1.0, 0.5, 0.0, 0.0)
    assert kind.decode(kind.payload(thrust=0.5)).q == (0.0,) * 4
    assert kind.decode(kind.payload(q=None, thrust=0.5)).thrust == 0.5


def test_payloads_may_be_short_or_long() -> None:
    """MAVLink 2 cuts zeros off; newer dialects add fields."""
    kind = message("STATUSTEXT")
    assert kind.decode(b"\x04abc").text == b"abc"
    assert kind.decode(b"\x04ab\0cd").text == b"ab", "up to the first NUL"
    assert kind.decode(kind.payload(severity=4, text=b"x" * 50) + b"more").text == b"x" * 50


@pytest.mark.parametrize("name", ["ATTITUDE", "GPS_RAW_INT", "AUTOPILOT_VERSION", "STATUSTEXT"])
def test_layouts_are_pymavlinks(name: str) -> None:
    kind = message(name)
    cls = mavlink.mavlink_map[kind.id]
    found = layout_of(kind.id)
    assert (found.id, found.size, found.crc_extra) == (cls.id, cls.unpacker.size, cls.crc_extra)
    assert (found.size, found.base_size) == (kind.size, kind.base_size)


def test_offsets_are_where_a_field_begins_on_the_wire() -> None:
    kind = message("BATTERY_STATUS")
    raw = kind.payload(id=9)
    assert raw[kind.offset_of("id")] == 9 and sum(raw) == 9
    assert message("STATUSTEXT").offset_of("severity") == 0 and message("STATUSTEXT").offset_of("id") == 51


def test_messages_that_there_are_not() -> None:
    with pytest.raises(UnknownMessageError, match="message 65000 is not in the ardupilotmega dialect"):
        message_by_id(65000)
    with pytest.raises(UnknownMessageError, match=r"ATITUDE.*did you mean.*ATTITUDE"):
        message("ATITUDE")
    assert repr(message("ATTITUDE")) == "MessageType(ATTITUDE, id 30)"


# ---------------------------------------------------------------- channels


@pytest.mark.parametrize(
    ("pulses", "count"),
    [({}, 0), ({1: 1500}, 8), ({8: 1500}, 8), ({9: 1500}, 16), ({1: 1500, 9: 1500}, 16), ({9: 1500, 10: 0}, 16),
     ({16: 1500}, 16)],
)  # fmt: skip
def test_receivers_have_eight_or_sixteen_channels(pulses: dict[int, int], count: int) -> None:
    b = Bench()
    v = b.vehicle.v
    v.time_us, v.autopilot.rc.receiver_us = 5_000_000, 4_900_000
    for channel, pulse in pulses.items():
        v.autopilot.rc.channels[channel - 1] = pulse
    (m,) = b.telemetry("RC_CHANNELS")
    assert (m.chancount, m.rssi, m.time_boot_ms) == (count, 255, 5000)
    assert [getattr(m, f"chan{n}_raw") for n in pulses] == list(pulses.values())


def test_outputs_keep_their_order() -> None:
    v = Copter()
    v.time_us = (1 << 32) + 7
    v.actuators.pwm[:16] = [1000 + k for k in range(16)]
    m = message("SERVO_OUTPUT_RAW").decode(build(servo_output_raw, v, Port()))
    assert [getattr(m, f"servo{k}_raw") for k in range(1, 17)] == [1000 + k for k in range(16)]
    assert m.time_usec == 7, "a uint32 of microseconds begins anew after 71 minutes"
