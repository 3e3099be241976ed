# SPDX-License-Identifier: BSD-3-Clause
"""Both sorts of datagrams of the JSON interface: frames of servos, and lines of motion."""

from __future__ import annotations

import json
import math
import struct

import pytest

from sitl.bridge.ardupilot_json.answer import MotionError
from sitl.bridge.ardupilot_json.answer import decode as decode_motion
from sitl.bridge.ardupilot_json.servos import ServoError, Servos, decode, encode, is_frame
from tests.bridge import json_lines


@pytest.mark.parametrize(("pulses", "magic", "size"), [(16, 18458, 40), (32, 29569, 72)])
def test_a_frame_has_the_published_layout(pulses, magic, size):
    widths = tuple(range(1000, 1000 + pulses))
    datagram = struct.pack(f"<HHI{pulses}H", magic, 400, 4_000_000_000, *widths)
    assert len(datagram) == size
    frame = decode(datagram)
    assert frame == Servos(400, 4_000_000_000, widths)
    assert encode(frame) == datagram


@pytest.mark.parametrize(
    ("datagram", "why"),
    [
        (b"", "0 bytes"),
        (b"hello", "5 bytes"),
        (struct.pack("<HHI16H", 29569, 400, 0, *(0,) * 16), "begins with 29569"),
        (struct.pack("<HHI16H", 18458, 400, 0, *(0,) * 16) + b"\0", "41 bytes"),
    ],
)
def test_other_datagrams_are_refused_with_the_reason(datagram, why):
    with pytest.raises(ServoError, match=why):
        decode(datagram)


def test_only_16_or_32_pulses_make_a_frame():
    with pytest.raises(ServoError, match="not 8"):
        encode(Servos(400, 0, (1500,) * 8))


GOOD = {
    "timestamp": 2.5,
    "imu": {"gyro": [0, 0, 0.1], "accel_body": [0, 0, -9.8]},
    "position": [1, 2, -3],
    "attitude": [0, 0, 0],
    "velocity": [0.5, 0, 0],
}


def test_what_is_written_is_read_to_the_last_bit():
    motion = decode_motion(
        json_lines.encode(
            (1 / 3, *(math.sin(k) for k in range(9)), 1.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.3), json_lines.extra(0.7)
        )
    )
    assert motion.time == 1 / 3
    assert motion.gyro + motion.accel + motion.position == tuple(math.sin(k) for k in range(9))
    assert motion.ranges == (0.7, None, None, None, None, None)


def test_an_attitude_in_angles_is_taken_and_a_quaternion_counts_more():
    motion = decode_motion(json.dumps({**GOOD, "attitude": [0, 0, math.pi]}).encode())
    assert motion.attitude == pytest.approx((0, 0, 0, 1), abs=1e-12)
    both = decode_motion(json.dumps({**GOOD, "attitude": [0, 0, math.pi], "quaternion": [2, 0, 0, 0]}).encode())
    assert both.attitude == (1.0, 0.0, 0.0, 0.0)


def test_battery_and_receiver_are_optional():
    plain = decode_motion(json.dumps(GOOD).encode())
    assert plain.battery is None and plain.receiver == ()
    more = {**GOOD, "battery": {"voltage": 12.1, "current": 3}, "rc": {"rc_1": 1500, "rc_2": 1100, "rc_4": 1}}
    reported = decode_motion(json.dumps(more).encode())
    assert reported.battery == (12.1, 3.0) and reported.receiver == (1500, 1100)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"timestamp": None}, "timestamp is missing"),
        ({"timestamp": -1}, "negative"),
        ({"timestamp": True}, "not a number"),
        ({"imu": None}, "imu is missing"),
        ({"imu": {"gyro": [0, 0, 0]}}, "accel_body is missing"),
        ({"position": [0, 0]}, "not 3 numbers"),
        ({"position": [0, 0, "low"]}, "not a number"),
        ({"velocity": [1e9, 0, 0]}, "out of all bounds"),
        ({"attitude": None}, "attitude"),
        ({"timestamp": 1.1e9}, "out of all bounds"),
        ({"quaternion": [0, 0, 0, 0]}, "length 0"),
        ({"quaternion": [1, 0, 0]}, "not 4 numbers"),
    ],
)
def test_what_is_no_motion_is_refused_with_the_reason(change, why):
    with pytest.raises(MotionError, match=why):
        decode_motion(json.dumps({**GOOD, **change}).encode())


@pytest.mark.parametrize(
    "text", ["", "{", "[1, 2]", "nonsense", '{"timestamp": NaN}', '{"timestamp": Infinity}', "[" * 99999]
)
def test_what_is_no_json_is_refused(text):
    with pytest.raises(MotionError):
        decode_motion(text.encode())


FRAMES = [
    struct.pack(f"<HHI{count}H", magic, 400, 7, *(1500,) * count) for magic in (18458, 29569) for count in (16, 32)
]
"""Each number at the beginning with each size: two of them are frames."""


@pytest.mark.parametrize("datagram", [*FRAMES, *(frame[:-1] for frame in FRAMES), FRAMES[0][:2], b"", b"Z"])
def test_what_is_known_as_a_frame_at_a_glance_is_one(datagram):
    try:
        decode(datagram)
    except ServoError:
        assert not is_frame(datagram)
    else:
        assert is_frame(datagram)


def test_a_line_without_attitude_is_no_motion():
    with pytest.raises(MotionError, match="neither quaternion nor attitude is there"):
        decode_motion(json.dumps({key: value for key, value in GOOD.items() if key != "attitude"}).encode())
