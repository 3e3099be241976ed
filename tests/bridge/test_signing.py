# SPDX-License-Identifier: BSD-3-Clause
"""Message signing, with pymavlink's own signing at the other end."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v1, encode_v2
from sitl.bridge.services.signing import SigningService
from sitl.bridge.services.statustext import HEARTBEAT
from sitl.bridge.signing import LAST, WINDOW, Signing, SigningState, Stream, is_signed
from tests.bridge.fakes import Bench, Client

KEY = bytes(range(32))
NOW = 40_000_000_000_000
"""Time stamp of the ground station: later than the simulated date."""


def outside(bench: Bench, **identity: Any) -> Client:
    """A client on a link that others can reach as well."""
    client = bench.connect(**identity)
    client.link.peers[0].is_signed = True
    return client


def set_key(bench: Bench, client: Client, key: bytes = KEY, timestamp: int = NOW) -> None:
    client.send(mavlink.MAVLink_setup_signing_message(1, 1, list(key), timestamp))
    bench.bridge.receive()


def sign(client: Client, key: bytes = KEY, timestamp: int = NOW + WINDOW, link: int = 7) -> None:
    """Let pymavlink sign what the client says, and refuse what is not signed."""
    signing = client.mav.signing
    signing.secret_key, signing.timestamp, signing.link_id, signing.sign_outgoing = key, timestamp, link, True


def ping(number: int = 1) -> Any:
    return mavlink.MAVLink_ping_message(123, number, 0, 0)


def answers(bench: Bench, client: Client, message: Any | None = None) -> list[str]:
    client.send(message or ping())
    bench.bridge.receive()
    return [m.get_type() for m in client.receive()]


@pytest.fixture
def client(bench: Bench) -> Client:
    """It has set a key, and does not sign yet."""
    made = outside(bench)
    set_key(bench, made)
    return made


def test_what_is_not_signed_is_not_heard_once_there_is_a_key(bench: Bench, client: Client) -> None:
    assert answers(bench, client) == []
    assert bench.bridge.get(SigningService).refused == 1
    sign(client)
    assert answers(bench, client) == ["PING"], "pymavlink accepts only frames with the right signature here"


def test_frames_to_a_client_carry_rising_time_stamps_and_the_link(bench: Bench, client: Client) -> None:
    sign(client)
    for k in range(3):
        client.send(ping(k))
    bench.bridge.receive()
    frames = Splitter().feed(client.link.receive())
    assert [frame.kind.name for frame in frames] == ["PING"] * 3 and all(map(is_signed, frames))
    stamps = [int.from_bytes(frame.raw[-12:-6], "little") for frame in frames]
    assert stamps == [stamps[0], stamps[0] + 1, stamps[0] + 2] and stamps[0] >= NOW + WINDOW
    assert {frame.raw[-13] for frame in frames} == {1}


def test_a_frame_that_is_played_back_is_refused(bench: Bench, client: Client) -> None:
    sign(client)
    raw = ping().pack(client.mav)
    assert raw[2] == 1
    for expected in (["PING"], []):
        client.link.send(raw)
        bench.bridge.receive()
        assert [m.get_type() for m in client.receive()] == expected


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"key": bytes(31) + b"\1"}, "another key"),
        ({"timestamp": NOW - 1}, "more than a minute behind"),
    ],
)
def test_forged_and_old_frames_are_refused(bench: Bench, client: Client, change: dict[str, Any], why: str) -> None:
    client.mav.signing.allow_unsigned_callback = lambda *_: True
    sign(client, **change)
    assert answers(bench, client) == [], why


def test_a_frame_that_was_changed_on_the_way_is_refused(bench: Bench, client: Client) -> None:
    sign(client)
    raw = bytearray(ping().pack(client.mav))
    raw[-1] ^= 1
    client.link.send(bytes(raw))
    bench.bridge.receive()
    assert client.receive() == []


@pytest.mark.parametrize("timestamp", [2**64 - 1, 2**48 - 1, LAST - WINDOW])
def test_time_stamps_end_where_48_bits_do(bench: Bench, timestamp: int) -> None:
    """An absurd one, which anybody may give an unsigned vehicle, does not end the run."""
    client = outside(bench)
    set_key(bench, client, timestamp=timestamp)
    sign(client, timestamp=LAST)
    for _ in range(2):
        bench.bridge.send_to_all(HEARTBEAT)
        bench.bridge.flush()
    stamps = [int.from_bytes(frame.raw[-12:-6], "little") for frame in Splitter().feed(client.link.receive())]
    assert stamps[-2:] == [LAST, LAST]


def test_a_client_at_the_last_time_stamp(bench: Bench, client: Client) -> None:
    sign(client, timestamp=LAST)
    assert answers(bench, client) == ["PING"]


def test_each_stream_counts_for_itself(bench: Bench, client: Client) -> None:
    sign(client, timestamp=NOW + WINDOW + 500)
    assert answers(bench, client) == ["PING"]
    other = outside(bench, system=254)
    sign(other, timestamp=NOW + WINDOW + 100)
    assert answers(bench, other) == ["PING"], "behind the first one, but within the minute"


def test_radios_and_trusted_links_need_no_signature(bench: Bench, client: Client) -> None:
    service = bench.bridge.get(SigningService)
    answers(bench, client, mavlink.MAVLink_radio_status_message(1, 1, 1, 1, 1, 1, 1))
    assert service.refused == 0
    assert [m.get_type() for m in bench.ask(ping())] == ["PING"], "a link within the process"
    client.link.take_unsigned()
    client.mav.signing.secret_key = KEY
    assert answers(bench, client) == ["PING"], "unsigned, and the answer is signed"


def test_setting_up_ends_with_zeros_and_is_refused_when_armed(bench: Bench, client: Client) -> None:
    sign(client)
    bench.vehicle.v.autopilot.arming.armed = 1
    set_key(bench, client, bytes(32), 0)
    assert [m.text for m in client.receive("STATUSTEXT")] == ["ERROR: Won't setup signing when armed"]
    bench.vehicle.v.autopilot.arming.armed = 0
    set_key(bench, client, bytes(32), 0)
    plain = outside(bench, system=253)
    assert answers(bench, plain) == ["PING"]


def test_the_key_survives_a_snapshot_and_a_reboot_and_is_in_no_log(bench: Bench) -> None:
    frames: list[bytes] = []

    class Tap:
        def frame(self, time_us: int, raw: bytes) -> None:
            frames.append(raw)

    bench.bridge.taps.append(Tap())
    client = outside(bench)
    before = bench.bridge.snapshot()
    set_key(bench, client)
    sign(client)
    with_key = bench.bridge.snapshot()
    bench.bridge.restore(before)
    assert not bench.bridge.get(SigningService).is_on
    bench.bridge.restore(with_key)
    bench.bridge = bench.bridge.successor()
    assert answers(bench, client) == ["PING"]
    assert frames and not any(KEY[1:] in raw for raw in frames)


def test_pieces_and_rubbish_between_frames(bench: Bench, client: Client) -> None:
    sign(client)
    raw = b"\xfd\x01rubbish" + ping(1).pack(client.mav) + b"\xfe" + ping(2).pack(client.mav)
    for k in range(len(raw)):
        client.link.send(raw[k : k + 1])
        bench.bridge.receive()
    client.link.send(bytes(300))
    bench.bridge.receive()
    assert [m.seq for m in client.receive("PING")] == [1, 2]


# ---------------------------------------------------------------- without a vehicle


def frame(signing: Signing, link: int = 1) -> bytes:
    kind = message("PING")
    return signing.signed(encode_v2(kind, kind.payload(seq=1), 0, 255, 190), link)


@pytest.mark.parametrize(
    ("key", "timestamp", "is_on", "begins"),
    [
        (bytes(32), 0, False, 0), (bytes(32), 1, True, 6_000_001), (KEY, 0, True, 6_000_000),
        (KEY, (1 << 48) - 1 - 6_000_000, True, (1 << 48) - 1), (KEY, 1 << 48, True, (1 << 48) - 1),
    ],
)  # fmt: skip
def test_zeros_alone_end_signing(key: bytes, timestamp: int, is_on: bool, begins: int) -> None:
    """Else the own time stamp begins a minute later."""
    signing = Signing(SigningState(KEY, 5, ((Stream(1, 2, 3), 4),)))
    signing.set_key(key, timestamp)
    assert (signing.is_on, signing.timestamp, signing.state().streams) == (is_on, begins, ())


@pytest.mark.parametrize(
    ("sent", "known", "accepted"),
    [
        (100, (), True), (99, (), False), (99, (98,), True), (98, (98,), False), (97, (98,), False),
        (7_000_000, (98,), True),
    ],
)  # fmt: skip
def test_new_streams_may_be_a_minute_behind_and_known_ones_rise(sent: int, known: Any, accepted: bool) -> None:
    stream = Stream(1, 255, 190)
    signing = Signing(SigningState(KEY, 6_000_100, tuple((stream, last) for last in known)))
    assert signing.accepts(frame(Signing(SigningState(KEY, sent))), 255, 190) == accepted
    assert signing.timestamp == max(6_000_100, sent)
    assert dict(signing.state().streams).get(stream) == (sent if accepted else known[0] if known else None)


@pytest.mark.parametrize(("streams", "accepted"), [(255, True), (256, False)])
def test_no_more_than_256_streams_are_followed(streams: int, accepted: bool) -> None:
    signing = Signing(SigningState(KEY, 0, tuple((Stream(k, 1, 1), 4) for k in range(streams))))
    assert signing.accepts(frame(Signing(SigningState(KEY, 50))), 255, 190) == accepted


def test_time_stamps_count_ten_microseconds_from_2015() -> None:
    signing = Signing(SigningState(KEY, 7))
    signing.follow_date(1_420_070_400_000_079)
    assert signing.timestamp == 7
    signing.follow_date(1_420_070_400_000_080)
    assert signing.timestamp == 8
    assert (frame(signing, 258)[-13], signing.timestamp) == (2, 9)
    kind = message("PING")
    old = encode_v1(kind, kind.payload(seq=1), 0, 255, 190)
    assert signing.signed(old, 1) is old and signing.timestamp == 9
    assert Signing(SigningState(KEY, -1)).timestamp == 0 and Signing(SigningState(KEY, 1 << 48)).timestamp == LAST
