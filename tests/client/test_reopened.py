# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that closes its TCP port to boot is connected to again."""

from __future__ import annotations

import contextlib
import socket
import threading

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.client.byte_socket import ByteSocket
from sitl.client.connection import Remote
from sitl.client.endpoint import Inbox
from sitl.errors import LinkLostError

_HEARTBEAT = message("HEARTBEAT")


@pytest.mark.parametrize("closes", [0, 2])
def test_a_vehicle_that_boots_is_reached_again(closes: int) -> None:
    """Before its port is gone, an ArduPilot takes connections that it closes."""
    listener = socket.create_server(("127.0.0.1", 0))
    taken: list[socket.socket] = []

    def vehicle() -> None:
        with contextlib.suppress(OSError):
            for _ in range(1 + closes):
                listener.accept()[0].close()
            taken.append(listener.accept()[0])
            heartbeat = _HEARTBEAT.payload(type=2, autopilot=3, mavlink_version=3)
            taken[0].sendall(encode_v2(_HEARTBEAT, heartbeat, 0, 4, 1))

    thread = threading.Thread(target=vehicle, daemon=True)
    thread.start()
    link = Remote(ByteSocket(f"tcp:127.0.0.1:{listener.getsockname()[1]}"), Inbox(), 20.0)
    try:
        with pytest.raises(LinkLostError, match="has closed it"):
            link.find()
        assert link.reopen() and link.inbox.system == 4
    finally:
        link.stream.close()
        listener.close()
        thread.join(20.0)
        for one in taken:
            one.close()


def test_one_that_does_not_come_back_is_lost_and_datagrams_have_no_connection() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        stream = ByteSocket(f"tcp:127.0.0.1:{listener.getsockname()[1]}")
    with pytest.raises(LinkLostError, match="refused"):
        Remote(stream, Inbox(), 0.0).reopen()
    datagrams = ByteSocket("udpout:127.0.0.1:9")
    assert not Remote(datagrams, Inbox(), 0.0).reopen()
    datagrams.close()
