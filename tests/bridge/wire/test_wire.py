# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink in the core: messages as records, frames, streams; here as plain Python, of the same source."""

from __future__ import annotations

import struct
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sitl.bridge.channel import Channel, Ports
from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v1, encode_v2
from sitl.bridge.links.inprocess import InProcessLink
from sitl.bridge.wire import frames, streams
from sitl.bridge.wire.choose import choose_builder, choose_taker, choose_targets, message_of
from sitl.bridge.wire.link import keep_rest, receive_port
from sitl.bridge.wire.message import Message, consecutive
from sitl.bridge.wire.port import OUT, Port
from sitl.core.constants import NEVER
from sitl.core.memory import bytes_at, record_at
from sitl.core.records import Floats, Ints
from sitl.core.vectors import Vec3
from sitl.vehicle.copter import Copter
from sitl.vehicle.record import Vehicle


class Attitude(Message, name="ATTITUDE"):
    time_boot_ms: int
    roll: float


class Battery(Message, name="BATTERY_STATUS"):
    voltages: Ints
    current_battery: int


class Scan(Message, name="DEBUG_FLOAT_ARRAY"):
    array_id: int
    data: Floats


class Ping(Message, name="PING"):
    seq: int


class Statustext(Message, name="STATUSTEXT"):
    severity: int


def attitude(m: Attitude, v: Vehicle) -> bool:
    m.time_boot_ms = v.time_us // 1000
    m.roll = v.autopilot.estimate.euler.roll
    return True


def battery(m: Battery, v: Vehicle) -> bool:
    return False


def scan(m: Scan, v: Vehicle, port: Port) -> bool:
    m.array_id = port.part
    m.data[0] = 1.0
    port.part = (port.part + 1) % 100
    return True


def ping(m: Ping, v: Vehicle, sender: int) -> None:
    v.autopilot.modes.number = 100 * m.seq + sender


build = choose_builder((attitude, battery, scan))
take, target = choose_taker((ping,)), choose_targets((ping,))


@pytest.fixture
def channel() -> Channel:
    made = Channel(InProcessLink().peers[0], 0, 1, lambda: True)
    made.ports = Ports()  # type: ignore[attr-defined]  # keeps the memory
    made.ports.arrange([made])  # type: ignore[attr-defined]
    return made


@pytest.fixture
def v() -> Copter:
    return Copter()


def sent(channel: Channel) -> list[bytes]:
    channel.peer.outbox.clear()
    channel.collect()
    return channel.peer.outbox


# ---------------------------------------------------------------------- messages


def test_a_message_lies_in_memory_as_on_the_wire() -> None:
    m = Attitude()
    m.time_boot_ms, m.roll = 7, 0.5
    assert bytes(m._bytes) == message("ATTITUDE").payload(time_boot_ms=7, roll=0.5)
    b = Battery()
    b.voltages[2], b.current_battery = 65535, -1
    assert bytes(b._bytes) == message("BATTERY_STATUS").payload(voltages=(0, 0, 65535), current_battery=-1)
    assert (b.current_battery, b.voltages.tolist()[:4]) == (-1, [0, 0, 65535, 0])


def test_a_field_that_the_message_does_not_have_is_an_error() -> None:
    with pytest.raises(TypeError, match=r"Wrong: ATTITUDE has no fields \['rol'\]"):

        class Wrong(Message, name="ATTITUDE"):
            rol: float


def test_a_field_of_another_sort_is_an_error() -> None:
    with pytest.raises(TypeError, match=r"Narrow\.roll: ATTITUDE has float there"):

        class Narrow(Message, name="ATTITUDE"):
            roll: int


def test_fields_in_a_row_are_a_vector_or_an_array() -> None:
    class Imu(Message, name="SCALED_IMU2"):
        acc: Vec3 = consecutive("xacc", "yacc", "zacc")

    class Pulses(Message, name="SERVO_OUTPUT_RAW"):
        last: Ints = consecutive("servo7_raw", "servo8_raw")

    imu, pulses = Imu(), Pulses()
    imu.acc = Vec3(1.0, -2.9, 3.9)
    pulses.last[1] = 1500
    assert imu.acc == Vec3(1.0, -2.0, 3.0), "cut off, as in the core"
    assert Imu.parts == ("xacc", "yacc", "zacc"), "as clients know them"
    assert bytes(imu._bytes) == message("SCALED_IMU2").payload(xacc=1, yacc=-2, zacc=3)
    assert bytes(pulses._bytes) == message("SERVO_OUTPUT_RAW").payload(servo8_raw=1500)


@pytest.mark.parametrize(
    "names", [("xacc", "zacc", "yacc"), ("xacc", "yacc", "xgyro"), ("time_boot_ms", "xacc", "yacc")]
)
def test_other_fields_are_no_vector(names: tuple[str, ...]) -> None:
    with pytest.raises(TypeError, match=r"Wrong\.acc: .* are not fields of one type in a row"):

        class Wrong(Message, name="SCALED_IMU2"):
            acc: Vec3 = consecutive(*names)


def test_single_precision_that_cannot_hold_a_number_is_infinite() -> None:
    m = Attitude()
    m.roll = 1e39
    assert m.roll == float("inf")


def test_a_law_without_a_message_is_refused() -> None:
    def nothing(m: int, v: Vehicle) -> bool:
        return False

    with pytest.raises(TypeError, match="its first argument is no Message"):
        message_of(nothing)


# ---------------------------------------------------------------------- out


@pytest.mark.parametrize("version", [1, 2])
def test_frames_are_those_of_the_encoder(channel: Channel, v: Copter, version: int) -> None:
    port, encode = channel.port, encode_v1 if version == 1 else encode_v2
    port.version, port.sequence, port.system = version, 254, 42
    v.time_us, v.autopilot.estimate.euler = 1_234_567, (0.25, 0.0, 0.0)
    kind, payload = message("ATTITUDE"), message("ATTITUDE").payload(time_boot_ms=1234, roll=0.25)
    for _ in range(3):
        assert streams.send(v, port, channel.address, kind.id, build)
    assert sent(channel) == [encode(kind, payload, k & 0xFF, 42, 1) for k in (254, 255, 256)]
    assert (port.sequence, port.sent) == (1, 3)


def test_version_1_leaves_out_what_it_cannot_carry(channel: Channel, v: Copter) -> None:
    channel.port.version = 1
    assert streams.send(v, channel.port, channel.address, message("DEBUG_FLOAT_ARRAY").id, build)
    assert (channel.port.sent, channel.port.out_size) == (0, 0)


@pytest.mark.parametrize(
    ("count", "size", "fits"), [(0, 0, True), (159, 0, True), (160, 0, False), (0, 5877, True), (0, 5878, False)]
)
def test_the_longest_frame_fits_or_waits(channel: Channel, count: int, size: int, fits: bool) -> None:
    """267 bytes of 6144, and 160 frames."""
    channel.port.out_count, channel.port.out_size = count, size
    assert frames.has_space(channel.port) == fits


def test_who_speaks_version_1_alone_is_answered_so(channel: Channel) -> None:
    kind = message("PING")
    port, versions = channel.port, []
    for encode in (encode_v1, encode_v1, encode_v2, encode_v1):
        heard(channel, encode(kind, kind.payload(seq=1), 0, 255, 190), [])
        versions.append((port.version, bool(port.received_v2)))
    assert versions == [(1, False), (1, False), (2, True), (2, True)] and port.received == 4


def test_nothing_to_say_is_no_frame(channel: Channel, v: Copter) -> None:
    assert streams.send(v, channel.port, channel.address, message("BATTERY_STATUS").id, build)
    assert channel.port.out_count == 0 and channel.port.sequence == 0


def test_a_message_of_many_parts_goes_on_when_there_is_room(channel: Channel, v: Copter) -> None:
    port, number = channel.port, message("DEBUG_FLOAT_ARRAY").id
    streams.set_interval(port, number, 100_000, 0, False)
    v.time_us = 100_000
    parts = []
    while port.next_us <= v.time_us:
        streams.send_due(v, port, channel.address, build)
        parts += [struct.unpack_from("<H", f, 18)[0] for f in sent(channel)]
    assert parts == list(range(100))
    assert port.next_us == 200_000


# ---------------------------------------------------------------------- streams


def test_messages_go_out_in_order_of_interval_then_of_request(channel: Channel) -> None:
    port = channel.port
    for number, interval in ((1, 200), (2, 100), (3, 200), (4, 100), (5, 300)):
        streams.set_interval(port, number, interval, 50, False)
    assert port.stream_number[: port.stream_count].tolist() == [2, 4, 1, 3, 5]
    assert port.stream_due_us[: port.stream_count].tolist() == [100, 100, 200, 200, 300]
    assert port.next_us == 100
    streams.set_interval(port, 2, 0, 50, False)
    assert (streams.interval_of(port, 2), streams.interval_of(port, 4)) == (0, 100)
    for number in (1, 3, 4, 5):
        streams.set_interval(port, number, 0, 50, False)
    assert (port.stream_count, port.next_us) == (0, NEVER)


def test_a_message_is_sent_once_however_late(channel: Channel, v: Copter) -> None:
    streams.set_interval(channel.port, 30, 10_000, 0, False)
    v.time_us = 57_500
    assert streams.send_due(v, channel.port, channel.address, build)
    assert len(sent(channel)) == 1 and channel.port.next_us == 60_000


def test_a_client_that_reads_slowly_is_sent_nothing(channel: Channel, v: Copter) -> None:
    streams.set_interval(channel.port, 30, 10_000, 0, False)
    v.time_us, channel.port.congested = 10_000, True
    assert streams.send_due(v, channel.port, channel.address, build)
    assert channel.port.out_count == 0 and channel.port.next_us == 20_000


def test_what_the_shell_builds_waits_for_it_in_its_place(channel: Channel, v: Copter) -> None:
    port = channel.port
    streams.set_interval(port, 253, 10_000, 0, True)
    streams.set_interval(port, 30, 10_000, 0, False)
    v.time_us = 10_000
    assert not streams.send_due(v, port, channel.address, build)
    assert port.out_count == 0 and streams.first_due(port, v.time_us) == (253, True)
    streams.put_off(port, 253, v.time_us)
    assert streams.send_due(v, port, channel.address, build)
    assert port.out_count == 1


def test_a_clock_that_was_set_moves_all_streams_and_one_that_was_dealt_with_itself_alone(channel: Channel) -> None:
    port = channel.port
    for number, interval in ((1, 20_000), (2, 30_000)):
        streams.set_interval(port, number, interval, 0, False)
    streams.put_off(port, 1, 20_000)
    assert port.stream_due_us[:2].tolist() == [40_000, 30_000] and port.next_us == 30_000
    streams.time_was_set(port, 105_000)
    assert port.stream_due_us[:2].tolist() == [120_000, 120_000] and port.next_us == 120_000
    streams.set_interval(port, 1, 20_000, 119_000, False)
    assert port.stream_due_us[:2].tolist() == [120_000, 120_000], "nothing has changed"


@pytest.mark.parametrize(("now_us", "sent", "due_us"), [(9_999, 0, 10_000), (10_000, 1, 20_000)])
def test_a_port_is_sent_what_is_due(channel: Channel, v: Copter, now_us: int, sent: int, due_us: int) -> None:
    streams.set_interval(channel.port, 30, 10_000, 0, False)
    v.time_us = now_us
    assert streams.next_due(channel.address, 1) == 10_000
    assert streams.send_all_due(v, channel.address, 1, build)
    assert (channel.port.out_count, channel.port.next_us) == (sent, due_us)


def test_too_many_streams_are_an_error(channel: Channel) -> None:
    for number in range(streams.STREAMS):
        streams.set_interval(channel.port, number, 1000, 0, False)
    with pytest.raises(ValueError, match="96 messages regularly, not 97"):
        streams.set_interval(channel.port, 999, 1000, 0, False)


# ---------------------------------------------------------------------- in

KINDS = ("HEARTBEAT", "PING", "COMMAND_LONG", "STATUSTEXT", "AUTOPILOT_VERSION")
frame = st.builds(
    lambda name, payload, sequence, system, version: (encode_v1 if version == 1 else encode_v2)(
        message(name), payload[: message(name).size], sequence, system, 190
    ),
    st.sampled_from(KINDS), st.binary(min_size=60, max_size=80),
    st.integers(0, 255), st.integers(1, 255), st.integers(1, 2),
)  # fmt: skip
rubbish = st.one_of(st.binary(max_size=20), st.just(b"\xfd"), st.just(b"\xfe\x09"), st.just(b"\xfd\x09\x04"))


def heard(channel: Channel, data: bytes, pieces: list[int]) -> list[tuple[object, ...]]:
    found = []
    cuts = [0, *sorted(min(p, len(data)) for p in pieces), len(data)]
    for start, end in pairwise(cuts):
        piece = data[start:end]
        while piece:
            piece = channel.feed(piece)
            while frames.next_frame(channel.port, channel.address):
                found.append(tuple(channel.frame()))
            keep_rest(channel.port, channel.address)
    return found


@settings(max_examples=60, deadline=None)
@given(st.lists(st.one_of(frame, frame, rubbish), max_size=6), st.lists(st.integers(0, 400), max_size=4), st.data())
def test_the_core_finds_the_frames_that_the_splitter_finds(
    parts: list[bytes], pieces: list[int], data: st.DataObject
) -> None:
    stream = bytearray(b"".join(parts))
    if stream and data.draw(st.booleans()):
        stream[data.draw(st.integers(0, len(stream) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    made = Channel(InProcessLink().peers[0], 0, 1, lambda: True)
    ports = Ports()
    ports.arrange([made])
    splitter = Splitter()
    assert heard(made, bytes(stream), pieces) == [tuple(f) for f in splitter.feed(bytes(stream))]
    assert made.port.bad_checksums == splitter.bad_checksums


def hear(channel: Channel, v: Copter, *given: bytes) -> None:
    channel.feed(b"".join(given))
    receive_port(v, channel.address, take, target)


def a_ping(seq: int, system: int = 255, to: int = 0, component: int = 190) -> bytes:
    kind = message("PING")
    return encode_v2(kind, kind.payload(seq=seq, target_system=to), 0, system, component)


def test_the_core_acts_on_its_messages(channel: Channel, v: Copter) -> None:
    hear(channel, v, a_ping(7, 250))
    assert v.autopilot.modes.number == 950 and channel.port.taken == 1
    assert (channel.port.frame_end, channel.port.in_size) == (0, 0)


@pytest.mark.parametrize("words", [a_ping(7, to=9), a_ping(7, system=1, component=1)], ids=["to another", "our own"])
def test_what_is_not_for_us_is_dropped(channel: Channel, v: Copter, words: bytes) -> None:
    hear(channel, v, words)
    assert (v.autopilot.modes.number, channel.port.taken, channel.port.frame_end) == (0, 0, 0)


def test_the_core_stops_at_a_message_of_the_shell_and_goes_on_behind_it(channel: Channel, v: Copter) -> None:
    kind = message("HEARTBEAT")
    other = encode_v2(kind, kind.payload(type=6), 3, 250, 1)
    hear(channel, v, a_ping(1), other, a_ping(2), b"\xfd")
    assert channel.frame().raw == other and not channel.port.frame_taken
    assert v.autopilot.modes.number == 355
    receive_port(v, channel.address, take, target)
    assert (channel.port.frame_end, v.autopilot.modes.number, channel.port.in_size) == (0, 455, 1)


def test_a_port_has_space_for_1024_bytes(channel: Channel) -> None:
    assert not channel.takes(bytes(1025)) and channel.port.in_size == 0
    assert channel.takes(bytes(1000)) and channel.takes(b"x" * 24) and not channel.takes(b"y")
    frames.next_frame(channel.port, channel.address)
    keep_rest(channel.port, channel.address)
    assert channel.feed(bytes(1030)) == bytes(6) and channel.port.in_size == 1024, "those that there is no space for"


def test_what_the_core_made_comes_before_what_the_shell_answers(channel: Channel, v: Copter) -> None:
    """And after what the shell has queued already."""
    kind = message("ATTITUDE")
    given: list[bytes] = []
    channel.peer.accept = given.append  # type: ignore[method-assign]
    channel.peer.flush = lambda: given.append(b"flushed")  # type: ignore[method-assign]
    channel.put(kind, kind.payload())
    streams.send(v, channel.port, channel.address, kind.id, build)
    channel.put(kind, kind.payload())
    assert [frame[4] for frame in channel.peer.outbox] == [0, 1, 2]
    streams.send(v, channel.port, channel.address, kind.id, build)
    channel.hand_over()
    assert given[0] == b"flushed" and given[1][4] == 3 and channel.port.out_count == channel.port.out_size == 0
    channel.peer.outbox.clear()
    channel.hand_over()
    assert given[2:] == [b""]


def test_a_watched_port_stops_at_every_frame(channel: Channel, v: Copter) -> None:
    channel.port.stops_at_frames = True
    hear(channel, v, a_ping(1))
    assert channel.frame().kind.name == "PING" and channel.port.frame_taken


def test_lost_frames_are_counted_for_each_sender(channel: Channel, v: Copter) -> None:
    kind = message("PING")
    for system, sequence in ((255, 3), (255, 6), (254, 9), (255, 7), (254, 10)):
        hear(channel, v, encode_v2(kind, kind.payload(), sequence, system, 190))
    assert (channel.port.received, channel.port.lost) == (5, 2)


def test_of_more_senders_than_it_knows_a_port_counts_the_first(channel: Channel, v: Copter) -> None:
    kind, known = message("PING"), 32
    for sequence in (250, 255, 5):  # four and five between them are lost
        for system in range(1, known + 9):
            hear(channel, v, encode_v2(kind, kind.payload(target_system=9), sequence, system, 190))
    assert channel.port.received == 3 * (known + 8) and channel.port.sender_count == known
    assert channel.port.lost == (4 + 5) * known


# ---------------------------------------------------------------------- memory


def test_ports_keep_what_they_hold_when_clients_come() -> None:
    ports, channels = Ports(), []
    for k in range(9):
        channels.append(Channel(InProcessLink().peers[0], k, 1, lambda: True))
        channels[-1].port.sequence = k
        ports.arrange(channels)
    assert [c.port.sequence for c in channels] == list(range(9))
    assert [record_at(Port, c.address).sequence for c in channels] == list(range(9))
    assert bytes_at(channels[0].address + OUT, 4)[0] == 0


def test_a_snapshot_of_a_channel_holds_its_streams(channel: Channel) -> None:
    streams.set_interval(channel.port, 30, 10_000, 0, False)
    channel.port.sequence = 9
    held = channel.snapshot()
    streams.set_interval(channel.port, 30, 0, 0, False)
    channel.port.sequence = 10
    channel.restore(held)
    assert (channel.port.sequence, channel.port.next_us, streams.interval_of(channel.port, 30)) == (9, 10_000, 10_000)
