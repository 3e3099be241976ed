# SPDX-License-Identifier: BSD-3-Clause
"""Peers, queues, datagrams and logs of links, without a socket; values of link faults at their edges."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.bridge.links import open_link, tcp, udp
from sitl.bridge.links.faults import LinkFaults
from sitl.bridge.links.inprocess import InProcessLink, LogLink
from sitl.bridge.links.link import Link, LinkAddressError, Peer, receive_all
from sitl.bridge.links.tcp import _TcpPeer
from sitl.bridge.links.udp import DATAGRAM_BYTES, _UdpPeer
from sitl.errors import OptionError

# ---------------------------------------------------------------- peers and links


def test_bytes_are_taken_once_in_their_order() -> None:
    peer = Peer("x")
    assert peer.take() == b""
    peer.deliver(b"a")
    assert peer.take() == b"a" and peer.take() == b""
    for data in (b"b", b"cd", b"e"):
        peer.deliver(data)
    assert peer.take() == b"bcde" and peer.take() == b""


def test_a_peer_of_no_kind_needs_nothing_special() -> None:
    peer = Peer("x")
    kinds = (peer.joins_frames, peer.waits, peer.spools, peer.stamps, peer.takes_unsigned, peer.is_log)
    assert not any(kinds) and peer.is_signed and not peer.is_idle() and not peer.congested and not peer.closed
    peer.write(b"a")
    peer.spooled(b"b")
    assert peer.outbox == [b"a", b"b"]
    peer.flush()
    assert peer.outbox == []


def test_peers_are_reported_as_they_come_and_to_a_new_listener_again() -> None:
    link, seen, again = Link("l"), [], []  # type: ignore[var-annotated]
    first, second = Peer("1"), Peer("2")
    link.add_peer(first)
    selector: Any = None
    link.attach(selector, seen.append)
    link.add_peer(second)
    assert seen == [first, second]
    link.reattach(again.append)
    third = Peer("3")
    link.add_peer(third)
    assert again == [first, second, third] and seen == [first, second]
    link.close()
    assert all(peer.closed for peer in again) and link.peers == []


def test_the_one_that_is_silent_for_longest_goes_first() -> None:
    link = Link("l")
    peers = [Peer(name) for name in "abc"]
    for peer in peers:
        link.add_peer(peer)
    for k in (0, 2, 1, 0):
        link.deliver(peers[k], b"x")
    assert [peer.last_received for peer in peers] == [4, 3, 2] and link.silent_for_longest() is peers[2]
    new = Peer("d")
    link.add_peer(new)
    assert link.silent_for_longest() is new, "it never said anything"


def test_a_link_that_nobody_else_reaches_takes_unsigned_frames_of_all_its_peers() -> None:
    link, before, after = Link("l"), Peer("1"), Peer("2")
    link.add_peer(before)
    assert not before.takes_unsigned
    link.take_unsigned()
    link.add_peer(after)
    assert before.takes_unsigned and after.takes_unsigned


def test_what_peers_have_sent_is_given_and_who_is_gone_is_left_out() -> None:
    read: list[str] = []
    waited: list[float] = []
    keys = [(SimpleNamespace(data=lambda: read.append("a")), 1), (SimpleNamespace(data=lambda: read.append("b")), 1)]
    selector: Any = SimpleNamespace(select=lambda seconds: waited.append(seconds) or keys)
    link = Link("l")
    link.refusals.append("too many")
    peers = [Peer(name) for name in ("talks", "gone", "silent")]
    peers[0].deliver(b"x")
    peers[1].deliver(b"y")
    peers[1].closed = True
    known = list(peers)
    assert list(receive_all(selector, [link], known, 0.25)) == [(peers[0], b"x")]
    assert read == ["a", "b"] and waited == [0.25] and link.refusals == []
    assert known == [peers[0], peers[2]]


# ---------------------------------------------------------------- in one process


def test_both_ends_of_a_link_in_one_process() -> None:
    link = InProcessLink("pair")
    (peer,) = link.peers
    assert (link.name, peer.name, peer.is_signed, peer.waits, peer.joins_frames) == ("pair", "pair", False, True, True)
    link.send(b"to vehicle")
    assert peer.take() == b"to vehicle"
    assert peer.is_idle()
    peer.write(b"1")
    assert not peer.is_idle() and link.receive() == b""
    peer.flush()
    peer.accept(b"23")
    assert peer.is_idle() and link.receive() == b"123" and link.receive() == b""


def test_a_lossy_one_loses_frame_by_frame() -> None:
    link = InProcessLink(drop_to_client=lambda frame: frame == b"2", drop_to_vehicle=lambda data: data == b"x")
    (peer,) = link.peers
    assert not peer.waits and not peer.joins_frames and not peer.is_idle(), "frames must come one by one"
    for frame in (b"1", b"2", b"3"):
        peer.write(frame)
    peer.flush()
    assert link.receive() == b"13"
    link.send(b"x")
    link.send(b"y")
    assert peer.take() == b"y"


class Writer:
    def __init__(self) -> None:
        self.kept: list[Any] = []

    def frame(self, time_us: int, raw: bytes) -> None:
        self.kept.append((time_us, raw))

    def write(self, data: bytes) -> None:
        self.kept.append(data)

    def close(self) -> None:
        self.kept.append("closed")


def test_a_log_keeps_frames_with_their_times_in_their_order() -> None:
    writer, clock = Writer(), SimpleNamespace(time_us=10)
    link = LogLink(writer, clock)
    (peer,) = link.peers
    assert (link.name, peer.is_log, peer.is_signed, peer.waits, peer.spools, peer.stamps) == (
        "log", True, False, True, True, True,
    )  # fmt: skip
    peer.write(b"a")
    peer.write(b"b")
    peer.flush()
    clock.time_us = 20
    peer.write(b"c")
    peer.spooled(b"spool")
    peer.flush()
    assert writer.kept == [(10, b"a"), (10, b"b"), (20, b"c"), b"spool"] and peer.outbox == []
    link.close()
    assert writer.kept[-1] == "closed" and peer.closed


# ---------------------------------------------------------------- datagrams


class Socket:
    """As much of one as UDP needs; ``fails``: nothing can be sent."""

    def __init__(self, *incoming: Any, fails: bool = False) -> None:
        self.sent: list[tuple[bytes, Any]] = []
        self.incoming, self.fails = list(incoming), fails

    def sendto(self, data: bytes, address: Any) -> None:
        if self.fails:
            raise OSError("no route")
        self.sent.append((data, address))

    def recvfrom(self, size: int) -> Any:
        assert size == 65535
        if not self.incoming:
            raise BlockingIOError
        found = self.incoming.pop(0)
        if isinstance(found, Exception):
            raise found
        return found


@pytest.mark.parametrize(
    ("sizes", "datagrams"),
    [
        ([], []),
        ([10], [10]),
        ([10, 20, 30], [60]),
        ([1000, 400], [1400]),
        ([1000, 401], [1000, 401]),
        ([1400, 1], [1400, 1]),
        ([2000, 10], [2000, 10]),  # one frame is never cut up
        ([700, 700, 700], [1400, 700]),
    ],
)
def test_frames_are_packed_into_datagrams_that_pass_an_ethernet(sizes: list[int], datagrams: list[int]) -> None:
    sock: Any = Socket()
    peer = _UdpPeer("u", sock, ("127.0.0.1", 14550))
    frames = [bytes([k]) * size for k, size in enumerate(sizes)]
    for frame in frames:
        peer.write(frame)
    peer.flush()
    assert DATAGRAM_BYTES == 1400 and [len(data) for data, _ in sock.sent] == datagrams
    assert b"".join(data for data, _ in sock.sent) == b"".join(frames) and peer.outbox == []
    assert {address for _, address in sock.sent} <= {("127.0.0.1", 14550)}


def test_a_datagram_that_cannot_be_sent_is_lost() -> None:
    sock: Any = Socket(fails=True)
    peer = _UdpPeer("u", sock, ("127.0.0.1", 14550))
    peer.write(b"a")
    peer.flush()
    assert peer.outbox == []


def link_of(*incoming: Any) -> Any:
    link: Any = object.__new__(udp.UdpInLink)
    Link.__init__(link, "udpin:x")
    link._socket, link._by_address = Socket(*incoming), {}
    return link


def test_each_address_is_a_peer_and_a_refused_datagram_is_passed_over() -> None:
    here, there = ("10.0.0.1", 1), ("10.0.0.2", 2)
    link = link_of((b"a", here), (b"b", there), ConnectionRefusedError(), (b"c", here))
    link._readable()
    assert [(peer.name, peer.take()) for peer in link.peers] == [
        ("udpin:x 10.0.0.1:1", b"ac"), ("udpin:x 10.0.0.2:2", b"b"),
    ]  # fmt: skip


def test_of_many_peers_the_silent_one_gives_way_and_is_told_why(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(udp, "MAX_PEERS", 2)
    a, b, c = (("10.0.0.1", k) for k in (1, 2, 3))
    link = link_of((b"1", a), (b"2", b), (b"3", a))
    link._readable()
    first, second = link.peers
    link._socket.incoming = [(b"4", c)]
    link._readable()
    assert second.closed and second.why_closed == "more than 2 peers; silent for longest" and not first.closed
    assert [peer.address for peer in link.peers] == [a, c]
    link._socket.incoming = [(b"5", b)]
    link._readable()
    assert [peer.address for peer in link.peers] == [c, b] and first.closed, "it comes as another one"


def test_a_flood_does_not_keep_the_vehicle_from_flying() -> None:
    link = link_of(*[(b"x", ("10.0.0.1", 1))] * 300)
    link._readable()
    assert len(link.peers[0].take()) == 256 and len(link._socket.incoming) == 44


# ---------------------------------------------------------------- connections


class Connection:
    """As much of a TCP socket as a peer needs; it takes ``room`` bytes."""

    def __init__(self, room: float = 0.0) -> None:
        self.room, self.sent, self.incoming = room, list[int](), list[Any]()
        self.breaks: OSError | None = None

    def send(self, data: bytes) -> int:
        if self.breaks:
            raise self.breaks
        if self.room <= 0:
            raise BlockingIOError
        size = int(min(len(data), self.room))
        self.room -= size
        self.sent.append(size)
        return size

    def recv(self, size: int) -> bytes:
        assert size == 65536
        found = self.incoming.pop(0)
        if isinstance(found, Exception):
            raise found
        return found  # type: ignore[no-any-return]


def connected(room: float = 0.0) -> tuple[Any, Any, Any]:
    """A peer, its socket and its link."""
    sock, gone = Connection(room), list[str]()
    link: Any = SimpleNamespace(forget=lambda peer, sock: gone.append(peer.why_closed), gone=gone)
    link.deliver = lambda peer, data: peer.deliver(data)
    return _TcpPeer("t", sock, link), sock, link  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("size", "congested", "dropped"),
    [
        (1, False, False), (262_144, False, False), (262_145, True, False), (4_194_304, True, False),
        (4_194_305, True, True),
    ],
)  # fmt: skip
def test_a_client_that_does_not_read_is_spared_and_then_dropped(size: int, congested: bool, dropped: bool) -> None:
    peer, sock, link = connected()
    peer.write(b"a")
    peer.write(bytes(size - 1))
    peer.flush()
    assert (peer.congested, peer.closed, peer.outbox) == (congested, dropped, [])
    text = "client does not read: 4194305 bytes unsent, at most 4194304 are kept"
    assert link.gone == [text] * dropped
    sock.room = 1e9
    peer.flush()
    assert sock.sent == ([] if dropped else [65536] * (size // 65536) + [size % 65536] * (size % 65536 > 0))


@pytest.mark.parametrize(("error", "why"), [(OSError(32, "Broken pipe"), "Broken pipe"), (OSError("odd"), "odd")])
def test_a_connection_that_breaks_while_something_is_sent_is_lost(error: OSError, why: str) -> None:
    peer, sock, link = connected(room=1e9)
    sock.breaks = error
    peer.write(b"a")
    peer.flush()
    peer.write(b"b")
    peer.flush()
    assert peer.closed and link.gone == [f"connection lost: {why}"] and sock.sent == []


def test_what_a_socket_takes_in_part_goes_on_later() -> None:
    peer, sock, _ = connected(room=70_000)
    peer.write(bytes(100_000))
    peer.flush()
    sock.room = 1e9
    peer.flush()
    assert sock.sent == [65536, 4464, 30_000]


HTTP = "client speaks HTTP, not MAVLink"


@pytest.mark.parametrize(
    ("incoming", "heard", "why"),
    [
        ([b"abc"], b"abc", None), ([BlockingIOError()], b"", None), ([b""], b"", "client closed the connection"),
        ([OSError(104, "reset")], b"", "connection lost: reset"), ([OSError("odd")], b"", "connection lost: odd"),
        ([b"GET / HT"], b"", HTTP), ([b"GE", b"T /"], b"GE", HTTP), ([b"OPTIONS / HTTP"], b"", HTTP),
        ([b"GETS", b"GET /"], b"GETSGET /", None),
    ],
)  # fmt: skip
def test_what_comes_over_a_connection(incoming: Any, heard: bytes, why: str | None) -> None:
    peer, sock, link = connected()
    sock.incoming = list(incoming)
    for _ in incoming:
        peer.readable()
    assert peer.take() == heard and link.gone == ([] if why is None else [why]) and peer.closed == bool(why)
    peer.drop("again")
    peer.drop("and again")
    assert link.gone == [why or "again"], "told once"


# ---------------------------------------------------------------- faults


@pytest.mark.parametrize(
    ("given", "nothing"),
    [
        ({}, True),
        ({"seed": 5}, True),
        ({"direction": "to-client"}, True),
        ({"loss": 0.1}, False),
        ({"delay": (0.0, 0.1)}, False),
        ({"cuts": ((1.0, 2.0),)}, False),
        ({"bandwidth": 1e9}, False),
    ],
)
def test_a_fault_of_a_direction_or_a_seed_alone_does_nothing(given: Any, nothing: bool) -> None:
    assert LinkFaults(**given).does_nothing == nothing


@pytest.mark.parametrize(
    ("direction", "acts"),
    [("both", (True, True)), ("to-vehicle", (True, False)), ("to-client", (False, True))],
)
def test_directions(direction: str, acts: tuple[bool, bool]) -> None:
    faults = LinkFaults(direction=direction)
    assert (faults.acts("to-vehicle"), faults.acts("to-client")) == acts


@pytest.mark.parametrize(("delay", "delays"), [(0.5, (0.5, 0.5)), ((0.1, 0.4), (0.1, 0.4)), ((0.2, 0.2), (0.2, 0.2))])
def test_a_delay_is_a_time_or_any_time_between_two(delay: Any, delays: tuple[float, float]) -> None:
    assert LinkFaults(delay=delay).delays == delays


@pytest.mark.parametrize(
    "given",
    [
        {"loss": 0.0}, {"loss": 1.0}, {"duplicates": 1}, {"reordering": 1.0}, {"corruption": 1.0}, {"delay": 3600.0},
        {"delay": (0.0, 3600.0)}, {"jitter": 3600.0}, {"bandwidth": 10.0}, {"cuts": ((0.0, 0.1), (5, 6))},
    ],
)  # fmt: skip
def test_values_at_their_edges_are_taken(given: Any) -> None:
    LinkFaults(**given)


@pytest.mark.parametrize(
    ("given", "error"),
    [
        ({"loss": -0.01}, "loss -0.01 is not a share from 0 to 1"),
        ({"duplicates": 1.01}, "duplicates 1.01 is not a share from 0 to 1"),
        ({"corruption": True}, "corruption True is not a share from 0 to 1"),
        ({"reordering": math.nan}, "reordering nan is not a share from 0 to 1"),
        ({"delay": 3600.1}, "delay 3600.1 is not a time from 0 to 3600 s, or a pair (low, high) of them"),
        ({"delay": (0.2, 0.1)}, "delay (0.2, 0.1): the first time is longer than the second"),
        ({"delay": (0.1, 0.2, 0.3)}, "delay (0.1, 0.2, 0.3) is not a time from 0 to 3600 s"),
        ({"jitter": -0.1}, "jitter -0.1 is not a time from 0 to 3600 s"),
        ({"bandwidth": 9.9}, "bandwidth 9.9 is not 10 bytes/s or more, or None"),
        ({"bandwidth": math.inf}, "bandwidth inf is not 10 bytes/s or more, or None"),
        ({"cuts": ((2.0, 2.0),)}, "cut (2.0, 2.0) is not a pair (begin, end) of simulated times [s], begin first"),
        ({"cuts": ((1.0, 2.0, 3.0),)}, "cut (1.0, 2.0, 3.0) is not a pair"),
        ({"direction": "up"}, "direction 'up' is none of both, to-vehicle, to-client"),
        ({"seed": 1.5}, "seed 1.5 is not a whole number"),
    ],
)
def test_values_beyond_them_are_named(given: Any, error: str) -> None:
    with pytest.raises(OptionError) as told:
        LinkFaults(**given)
    assert f"link fault {error}" in str(told.value)


@pytest.mark.parametrize(
    ("texts", "faults"),
    [
        ({}, None),
        ({"loss": []}, None),
        ({"loss": ["0.1", "0.2"]}, LinkFaults(loss=0.2)),
        ({"delay": ["0.5"]}, LinkFaults(delay=0.5)),
        ({"delay": ["0.1..0.4"]}, LinkFaults(delay=(0.1, 0.4))),
        ({"cut": ["1..2", "5..6.5"]}, LinkFaults(cuts=((1.0, 2.0), (5.0, 6.5)))),
        ({"direction": ["to-client"], "seed": ["7"]}, LinkFaults(direction="to-client", seed=7)),
    ],
)
def test_words_of_options(texts: Any, faults: LinkFaults | None) -> None:
    assert LinkFaults.of_texts(texts) == faults


@pytest.mark.parametrize(
    ("texts", "error"),
    [
        ({"cut": ["5"]}, "--link-cut '5' is not BEGIN..END"), ({"seed": ["1.5"]}, "--link-seed '1.5' is not NUMBER"),
        ({"delay": ["0.1.."]}, "--link-delay '0.1..' is not SECONDS|LOW..HIGH"),
        ({"loss": ["much"]}, "--link-loss 'much' is not SHARE"),
    ],
)  # fmt: skip
def test_words_that_are_no_value_are_named_with_their_option(texts: Any, error: str) -> None:
    with pytest.raises(OptionError) as told:
        LinkFaults.of_texts(texts)
    assert str(told.value) == error


# ---------------------------------------------------------------- how many


def test_sixty_four_addresses_are_peers() -> None:
    link = link_of(*[(b"x", ("10.0.0.1", port)) for port in range(1, 66)])
    link._readable()
    assert [peer.address[1] for peer in link.peers] == list(range(2, 66))


class Listener(Connection):
    """A socket that listens; whoever wants to come is let in at once."""

    def accept(self) -> Any:
        if not self.incoming:
            raise BlockingIOError
        made = Connection()
        made.setblocking = made.setsockopt = made.close = lambda *how: None  # type: ignore[attr-defined]
        return made, ("10.0.0.1", self.incoming.pop(0))


def test_sixty_four_connections_are_peers() -> None:
    link = tcp.TcpServerLink(0)
    link._socket.close()
    link._socket = Listener()  # type: ignore[assignment]
    link._socket.incoming = list(range(1, 66))  # type: ignore[attr-defined]
    for _ in range(65):
        link._accept()
    assert [peer.name.rpartition(":")[2] for peer in link.peers] == [str(port) for port in range(2, 66)]


def test_who_does_not_answer_is_given_five_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def connect(address: Any, seconds: float) -> None:
        asked.append((address, seconds))
        raise OSError(111, "Connection refused")

    monkeypatch.setattr(tcp.socket, "create_connection", connect)
    with pytest.raises(LinkAddressError, match=r"link tcpclient:10\.0\.0\.1:5760 cannot be opened: Connection refused"):
        tcp.TcpClientLink("10.0.0.1", 5760)
    assert asked == [(("10.0.0.1", 5760), 5.0)]


def test_a_link_that_sends_has_its_peer_from_the_start() -> None:
    link = open_link("udp:127.0.0.1:14777")
    assert [peer.name for peer in link.peers] == ["udpout:127.0.0.1:14777 127.0.0.1:14777"]
    assert isinstance(link, udp.UdpOutLink) and link.local_address[0] == "127.0.0.1"
    link.close()
    other = udp.UdpOutLink("10.255.255.1", 14777)
    assert other.local_address[0] == "0.0.0.0"
    other.close()
