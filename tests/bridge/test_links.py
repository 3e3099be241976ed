# SPDX-License-Identifier: BSD-3-Clause
"""Sockets on free ports of the loopback interface, on the test's clock; a connection that leads back to itself."""

from __future__ import annotations

import contextlib
import errno
import socket

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.frame import Splitter
from sitl.bridge.links import LinkAddressError, TcpServerLink, UdpInLink, UdpOutLink, open_link, parse, tcp
from sitl.bridge.links.tcp import CONGESTED_BYTES, refuse_echo
from sitl.bridge.services.statustext import StatusTextService
from tests.bridge.fakes import Bench

LOCAL = "127.0.0.1"
TRIES = 200


def packed(message: object, system: int = 255) -> bytes:
    return message.pack(mavlink.MAVLink(None, srcSystem=system, srcComponent=190))  # type: ignore[attr-defined]


REQUEST = packed(mavlink.MAVLink_command_long_message(1, 1, 512, 0, 30, 0, 0, 0, 0, 0, 0))


def names(data: bytes) -> list[str]:
    return [f.kind.name for f in Splitter().feed(data)]


def receive(bench: Bench) -> None:
    """Let the bridge read; the loopback may take a moment of wall time."""
    bench.bridge.wait(2.0)
    bench.bridge.receive()


def test_tcp_clients_are_separate_and_may_leave(bench: Bench) -> None:
    link = TcpServerLink(0)
    bench.bridge.add_link(link)
    one, two = (socket.create_connection(link.local_address) for _ in range(2))
    for s in (one, two):
        s.settimeout(5.0)
    for _ in range(TRIES):
        receive(bench)
        if len(bench.bridge.channels) == 3:
            break
    one.sendall(REQUEST)
    receive(bench)
    assert names(one.recv(4096)) == ["COMMAND_ACK", "ATTITUDE"]
    two.setblocking(False)
    with pytest.raises(BlockingIOError):
        two.recv(1)
    one.close()
    for _ in range(TRIES):
        receive(bench)
        if len(bench.bridge.channels) == 2:
            break
    assert len(bench.bridge.channels) == 2
    assert "closed" in bench.bridge.dropped[0]
    two.close()
    bench.bridge.close()


def test_a_tcp_client_that_does_not_read_cannot_stall_the_vehicle(bench: Bench) -> None:
    link = TcpServerLink(0)
    bench.bridge.add_link(link)
    deaf = socket.create_connection(link.local_address)
    receive(bench)
    peer = bench.bridge.channels[1].peer
    bench.bridge.stream_to(link, {"EXTRA1": 400})
    for _ in range(100):
        bench.run(10.0)
        bench.client.receive()
        if peer.congested:
            break
    assert peer.congested and len(peer._pending) < 2 * CONGESTED_BYTES  # type: ignore[attr-defined]
    say = bench.bridge.get(StatusTextService).say
    for _ in range(200_000):
        say(6, "word for word, until the queue of the client that does not read is full " * 3)
        bench.bridge.flush()
        bench.client.link.receive()
        if peer.closed:
            break
    assert len(bench.bridge.channels) == 1
    assert "does not read" in bench.bridge.dropped[0]
    deaf.close()
    bench.bridge.close()


def test_a_silent_tcp_client_gives_way_to_another_one(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tcp, "MAX_CONNECTIONS", 2)
    link = TcpServerLink(0)
    bench.bridge.add_link(link)
    clients = []
    for k in range(4):
        clients.append(socket.create_connection(link.local_address, timeout=5.0))
        receive(bench)
        if k == 0:
            clients[0].send(b"something")
            receive(bench)
    assert len(bench.bridge.channels) == 3
    assert clients[1].recv(1) == b"" and clients[2].recv(1) == b""
    assert len(bench.bridge.dropped) == 2
    assert all("more than 2 clients; silent for longest" in note for note in bench.bridge.dropped)
    clients[0].close()
    receive(bench)
    assert len(bench.bridge.channels) == 2
    bench.bridge.close()
    for c in clients:
        c.close()


@pytest.mark.parametrize(
    "pieces",
    [(b"POST / HTTP/1.1\r\n\r\n" + REQUEST,), (b"GE", b"T / HTTP/1.1\r\n\r\n", REQUEST), (b"OPTIONS ", REQUEST)],
)
def test_what_a_site_lets_a_browser_post_is_not_heard(bench: Bench, pieces: tuple[bytes, ...]) -> None:
    link = TcpServerLink(0)
    bench.bridge.add_link(link)
    with socket.create_connection(link.local_address) as browser:
        for piece in pieces:
            with contextlib.suppress(OSError):  # it may have been dropped already
                browser.sendall(piece)
            receive(bench)
        for _ in range(TRIES):
            receive(bench)
            if bench.bridge.dropped:
                break
        assert "client speaks HTTP, not MAVLink" in bench.bridge.dropped[0] and not link.peers
        browser.settimeout(5.0)
        with contextlib.suppress(ConnectionResetError):
            assert "COMMAND_ACK" not in names(browser.recv(4096))
    bench.bridge.close()


@pytest.mark.parametrize("before", [b"G", b"GOT ", b"noise POST ", b"PO" + REQUEST])
def test_bytes_before_a_frame_are_no_browser(bench: Bench, before: bytes) -> None:
    link = TcpServerLink(0)
    bench.bridge.add_link(link)
    with socket.create_connection(link.local_address) as client:
        client.settimeout(5.0)
        client.sendall(before + REQUEST)
        receive(bench)
        receive(bench)
        assert names(client.recv(4096))[0] == "COMMAND_ACK"
    bench.bridge.close()


def test_notes_that_nobody_takes_are_few(bench: Bench) -> None:
    for k in range(3000):
        bench.bridge.dropped.append(f"client {k} is gone")
    assert len(bench.bridge.dropped) == 1000 and bench.bridge.dropped[-1] == "client 2999 is gone"


class _NoRoom:
    """A listening socket that has no descriptor for ``failures`` of the next connections."""

    def __init__(self, sock: socket.socket, failures: int) -> None:
        self._sock, self.failures = sock, failures

    def __getattr__(self, name: str) -> object:
        return getattr(self._sock, name)

    def fileno(self) -> int:
        return self._sock.fileno()

    def accept(self) -> object:
        if self.failures > 0:
            self.failures -= 1
            raise OSError(errno.EMFILE, "Too many open files")
        return self._sock.accept()


@pytest.mark.parametrize("failures", [1, 2])
def test_no_descriptors_left_does_not_keep_the_vehicle_awake(bench: Bench, failures: int) -> None:
    link = TcpServerLink(0)
    bench.bridge.add_link(link)
    first = socket.create_connection(link.local_address, timeout=5.0)
    receive(bench)
    link._socket = _NoRoom(link._socket, failures)  # type: ignore[assignment]
    second = socket.create_connection(link.local_address, timeout=5.0)
    receive(bench)
    assert len(bench.bridge.channels) == 2
    assert len(bench.bridge.dropped) == 1 and "Too many open files" in bench.bridge.dropped[0]
    assert not bench.bridge.wait(0.0), "what cannot be accepted must not be reported again and again"
    if failures == 1:
        assert second.recv(1) == b""
    first.close()
    for _ in range(TRIES):
        receive(bench)
        if len(bench.bridge.channels) == 1:
            break
    third = socket.create_connection(link.local_address, timeout=5.0)
    for _ in range(TRIES):
        receive(bench)
        if len(bench.bridge.channels) == 3 - (failures == 1):
            break
    assert len(bench.bridge.channels) == 3 - (failures == 1), "those that wait are taken when there is room again"
    bench.bridge.close()
    second.close()
    third.close()


def test_udp_in_knows_many_peers(bench: Bench) -> None:
    link = UdpInLink(LOCAL, 0)
    bench.bridge.add_link(link)
    clients = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(3)]
    for c in clients:
        c.settimeout(5.0)
        c.sendto(REQUEST, link.local_address)
    for _ in range(TRIES):
        receive(bench)
        if len(bench.bridge.channels) == 4:
            break
    for c in clients:
        assert names(c.recv(4096)) == ["COMMAND_ACK", "ATTITUDE"]
        c.close()
    bench.bridge.close()


def test_udp_out_speaks_first_and_hears_answers(bench: Bench) -> None:
    ground = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    ground.bind((LOCAL, 0))
    ground.settimeout(5.0)
    bench.bridge.add_link(UdpOutLink(LOCAL, ground.getsockname()[1]))
    bench.run(1.0)
    found = []
    while "HEARTBEAT" not in found:
        data, vehicle = ground.recvfrom(4096)
        found += names(data)
    ground.sendto(REQUEST, vehicle)
    receive(bench)
    while "COMMAND_ACK" not in found:
        found += names(ground.recv(4096))
    assert len(bench.bridge.channels) == 2
    ground.close()
    bench.run(5.0)  # nobody listens any more: no error
    bench.bridge.receive()
    bench.bridge.close()


@pytest.mark.parametrize(("text", "meaning"), [
    ("udp:10.0.0.1:14550", ("udpout", "10.0.0.1", 14550)), ("udpout://host:1", ("udpout", "host", 1)),
    ("udpin:14550", ("udpin", LOCAL, 14550)), ("udpin:0.0.0.0:14550", ("udpin", "0.0.0.0", 14550)),
    ("tcp:5760", ("tcp", LOCAL, 5760)), ("tcpin:0.0.0.0:5760", ("tcp", "0.0.0.0", 5760)),
])  # fmt: skip
def test_addresses(text: str, meaning: tuple[str, str, int]) -> None:
    assert parse(text) == meaning


@pytest.mark.parametrize(
    "text", ["", "udp", "udp:14550", "serial:/dev/x", "tcp:", "tcp:h:0", "udp:h:65536", "udp:h:x", "tcp:²"]
)
def test_bad_addresses_say_what_is_allowed(text: str) -> None:
    with pytest.raises(LinkAddressError, match="allowed"):
        parse(text)


@pytest.mark.parametrize(
    ("text", "part"), [("udp:127.0.0.1", "port"), ("tcp:", "port"), ("tcp:h:", "port"), ("udp:14550", "host")]
)
def test_what_an_address_lacks_is_named(text: str, part: str) -> None:
    with pytest.raises(LinkAddressError, match=f"link '{text}': the {part} is missing"):
        parse(text)


def test_a_port_in_use_is_named() -> None:
    link = TcpServerLink(0)
    port = link.local_address[1]
    with pytest.raises(LinkAddressError, match=str(port)):
        open_link(f"tcp:{port}")
    link.close()


def test_a_connection_with_itself_is_refused() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as own:
        own.bind(("127.0.0.1", 0))
        own.connect(own.getsockname())  # nobody listens there
        with pytest.raises(ConnectionRefusedError):
            refuse_echo(own)
        assert own.fileno() == -1


def test_a_connection_with_another_is_left() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen(1)
        with socket.create_connection(listener.getsockname()) as own:
            refuse_echo(own)
            assert own.fileno() >= 0
