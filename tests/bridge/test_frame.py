# SPDX-License-Identifier: BSD-3-Clause
"""Frames against pymavlink's own packing and parsing."""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink
from pymavlink.generator.mavcrc import x25crc

from sitl.bridge.dialect import KNOWN_IDS, UnknownMessageError, crc_mcrf4xx, message, message_by_id
from sitl.bridge.frame import Splitter, encode_v1, encode_v2

BASE_SIZES = {
    "HEARTBEAT": 9, "SYS_STATUS": 31, "GPS_RAW_INT": 30, "MISSION_ITEM": 37, "PARAM_VALUE": 25,
    "BATTERY_STATUS": 36,
    "STATUSTEXT": 51, "RC_CHANNELS_OVERRIDE": 18, "MISSION_COUNT": 4, "HOME_POSITION": 52, "COMMAND_ACK": 3,
    "MISSION_CURRENT": 2, "ATTITUDE_QUATERNION": 32, "RAW_IMU": 26, "SERVO_OUTPUT_RAW": 21,
    "MANUAL_CONTROL": 11,
}  # fmt: skip


def random_values(kind: type, rng: random.Random) -> list[object]:
    """Arguments for a pymavlink message class."""
    values: list[object] = []
    for name in kind.fieldnames:
        at = kind.ordered_fieldnames.index(name)
        t, n = kind.fieldtypes[kind.fieldnames.index(name)], kind.array_lengths[at]
        if t == "char" and n:
            values.append(bytes(rng.choices(b"ABCxyz", k=rng.randint(0, n))))
        elif t in ("float", "double"):
            values.append([rng.choice((0.0, 1.5, -2.25))] * n if n else rng.choice((0.0, 1.5, -2.25)))
        else:
            bits = 8 * {"char": 1, "int8_t": 1, "uint8_t": 1, "int16_t": 2, "uint16_t": 2, "int32_t": 4,
                        "uint32_t": 4, "int64_t": 8, "uint64_t": 8}.get(t, 1)  # fmt: skip
            if t == "char":
                values.append(b"a")
                continue
            top = 2 ** (bits - 1) - 1
            values.append([rng.randint(0, top) for _ in range(n)] if n else rng.choice((0, rng.randint(0, top))))
    return values


@pytest.mark.parametrize("number", sorted(mavlink.mavlink_map))
def test_every_message_is_packed_and_unpacked_as_pymavlink_does(number: int) -> None:
    rng = random.Random(number)
    kind = message_by_id(number)
    for sequence in (0, 77):
        theirs = mavlink.mavlink_map[number](*random_values(mavlink.mavlink_map[number], rng))
        mav = mavlink.MAVLink(None, srcSystem=3, srcComponent=7)
        mav.seq = sequence
        raw = theirs.pack(mav)
        frames = Splitter().feed(raw)
        assert len(frames) == 1
        frame = frames[0]
        assert (frame.kind, frame.sequence, frame.system, frame.component, frame.version) == (kind, sequence, 3, 7, 2)
        fields = kind.decode(frame.payload)
        again = kind.payload(**fields._asdict())
        assert encode_v2(kind, again, sequence, 3, 7) == raw
        parsed = mavlink.MAVLink(None).parse_buffer(raw)[0]
        for name in kind.fields:
            ours, expected = getattr(fields, name), getattr(parsed, name)
            if isinstance(expected, str):
                expected = expected.encode()
            assert list(ours) == list(expected) if isinstance(expected, list) else ours == expected


@pytest.mark.parametrize(("name", "size"), BASE_SIZES.items())
def test_version_1_carries_the_base_fields(name: str, size: int) -> None:
    kind = message(name)
    raw = encode_v1(kind, kind.payload(), 5, 1, 1)
    assert raw[0] == 0xFE and raw[1] == size == kind.base_size
    assert mavlink.MAVLink(None).parse_buffer(raw)[0].get_type() == name
    assert Splitter().feed(raw)[0].version == 1


def test_version_1_cannot_carry_large_numbers() -> None:
    kind = next(message_by_id(n) for n in sorted(KNOWN_IDS) if n > 255)
    assert encode_v1(kind, kind.payload(), 0, 1, 1) == b""


def test_unknown_names_are_named() -> None:
    with pytest.raises(UnknownMessageError, match="NO_SUCH"):
        message("NO_SUCH")
    with pytest.raises(UnknownMessageError, match="speed"):
        message("ATTITUDE").payload(speed=1)


def _frames(count: int) -> list[bytes]:
    kind = message("ATTITUDE")
    return [encode_v2(kind, kind.pack(k, 0.1, 0.2, 0.3, 0, 0, k), k, 255, 190) for k in range(count)]


def test_a_signed_frame_is_accepted() -> None:
    mav = mavlink.MAVLink(None, srcSystem=255)
    mav.signing.secret_key, mav.signing.sign_outgoing = bytes(32), True
    raw = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3).pack(mav)
    assert [f.raw for f in Splitter().feed(raw + _frames(1)[0])] == [raw, _frames(1)[0]]


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=600), st.lists(st.integers(1, 40), max_size=20))
def test_random_bytes_never_raise(noise: bytes, cuts: list[int]) -> None:
    splitter = Splitter()
    at = 0
    for cut in cuts:
        splitter.feed(noise[at : at + cut])
        at += cut
    splitter.feed(noise[at:])
    assert len(splitter.rest) < 300


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=40), st.integers(0, 39), st.integers(0, 255), st.integers(1, 60))
def test_good_frames_behind_bad_ones_are_found(noise: bytes, at: int, value: int, piece: int) -> None:
    good = _frames(12)
    broken = bytearray(good[0])
    broken[at % len(broken)] ^= value
    stream = good[1] + bytes(broken) + good[2] + noise + b"".join(good[3:]) + bytes(300)
    splitter = Splitter()
    found = [f.raw for k in range(0, len(stream), piece) for f in splitter.feed(stream[k : k + piece])]
    assert found[0] == good[1]
    assert found[-9:] == good[3:]
    assert good[2] in found


def test_a_truncated_frame_costs_nothing_but_itself() -> None:
    good = _frames(4)
    splitter = Splitter()
    found = splitter.feed(good[0] + good[1][:20] + good[2] + good[3])
    assert [f.raw for f in found] == [good[0], good[2], good[3]]
    assert splitter.bad_checksums == 1


def test_messages_newer_than_the_dialect_match_their_definition() -> None:
    from pymavlink.dialects.v20 import development

    kind = message("AVAILABLE_MODES")
    raw = encode_v2(kind, kind.pack(17, 4, 8, 3, 0, b"BRAKE"), 1, 1, 1)
    (found,) = development.MAVLink(None).parse_buffer(raw)
    assert (found.get_type(), found.custom_mode, found.properties, found.number_modes, found.mode_index) == (
        "AVAILABLE_MODES", 17, 4, 8, 3
    )  # fmt: skip
    assert found.mode_name == "BRAKE" and kind.base_size == kind.size
    kind = message("AVAILABLE_MODES_MONITOR")
    (found,) = development.MAVLink(None).parse_buffer(encode_v2(kind, kind.payload(seq=7), 2, 1, 1))
    assert (found.get_type(), found.seq, kind.size) == ("AVAILABLE_MODES_MONITOR", 7, 1)


def test_a_message_that_no_dialect_here_has_is_that_of_its_definition() -> None:
    """https://mavlink.io/en/messages/common.html#COMPONENT_METADATA; its seed is that of these fields."""
    kind = message("COMPONENT_METADATA")
    assert (kind.id, kind.size, kind.base_size, kind.fields) == (397, 108, 108, ("time_boot_ms", "file_crc", "uri"))
    seed = x25crc()
    seed.accumulate_str("COMPONENT_METADATA uint32_t time_boot_ms uint32_t file_crc char uri ")
    seed.accumulate(b"\x64")
    assert kind.crc_extra == bytes(((seed.crc & 0xFF) ^ (seed.crc >> 8),))
    assert kind.payload(time_boot_ms=1, file_crc=2, uri=b"u") == b"\1\0\0\0\2\0\0\0u" + bytes(99)


def test_extension_fields_that_are_newer_than_this_dialect_are_left_out():
    kind = message("MISSION_ACK")
    payload = kind.payload(target_system=255, target_component=190, type=1, mission_type=2)
    longer = payload + b"abcd"  # the id of the mission, as PX4 1.18 sends it
    body = bytes((len(longer), 0, 0, 7, 1, 1)) + kind.wire_id + longer
    raw = b"\xfd" + body + crc_mcrf4xx(body + kind.crc_extra, 0xFFFF).to_bytes(2, "little")
    (frame,) = Splitter().feed(b"noise" + raw)
    assert frame.payload == payload and frame.raw == raw
    assert Splitter().feed(raw[:-1] + b"?") == []
