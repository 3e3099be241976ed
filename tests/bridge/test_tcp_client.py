# SPDX-License-Identifier: BSD-3-Clause
"""``tcpclient:HOST:PORT``: a link that goes to where a client listens."""

from __future__ import annotations

import selectors
import socket
from collections.abc import Iterator
from typing import Any

import pytest

from sitl.bridge.links.link import LinkAddressError, receive_all
from sitl.bridge.links.tcp import TcpClientLink
from tests.ports import free_port


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(10.0)
        yield server


def test_bytes_go_both_ways_until_the_client_leaves(listener: socket.socket) -> None:
    link = TcpClientLink("127.0.0.1", listener.getsockname()[1])
    client, _ = listener.accept()
    seen: list[Any] = []
    with selectors.DefaultSelector() as selector:
        link.attach(selector, seen.append)
        (peer,) = link.peers
        assert seen == [peer] and link.name == f"tcpclient:127.0.0.1:{listener.getsockname()[1]}" == peer.name
        client.sendall(b"hello")
        assert list(receive_all(selector, [link], seen, 1.0)) == [(peer, b"hello")]
        peer.write(b"abc")
        peer.write(b"def")
        peer.flush()
        assert client.recv(6, socket.MSG_WAITALL) == b"abcdef"
        client.close()
        assert list(receive_all(selector, [link], seen, 1.0)) == []
        assert peer.closed and link.peers == [] == seen
        assert not selector.get_map(), "nobody listens to it any more"
        link.close()


def test_what_is_queued_is_sent_before_it_closes(listener: socket.socket) -> None:
    link = TcpClientLink("127.0.0.1", listener.getsockname()[1])
    client, _ = listener.accept()
    with client:
        (peer,) = link.peers
        peer.write(b"last words")
        link.close()
        assert client.recv(10, socket.MSG_WAITALL) == b"last words" and client.recv(100) == b""
        assert peer.closed and peer.why_closed == "vehicle closed"


def test_nobody_there_is_named() -> None:
    port = free_port()
    with pytest.raises(
        LinkAddressError, match=rf"link tcpclient:127\.0\.0\.1:{port} cannot be opened: Connection refused"
    ):
        TcpClientLink("127.0.0.1", port)
