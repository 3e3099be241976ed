# SPDX-License-Identifier: BSD-3-Clause
"""MAVLink over UDP. Every remote address is a peer of its own; answers go to where the question came from."""

from __future__ import annotations

import contextlib
import socket

from .link import DatagramLink, Peer

Address = tuple[str, int]
DATAGRAM_BYTES = 1400
"""Frames are packed into datagrams up to this size, so that they pass an Ethernet without being cut up."""
MAX_PEERS = 64
_READS_AT_ONCE = 256


class _UdpPeer(Peer):
    waits = True

    def __init__(self, name: str, sock: socket.socket, address: Address) -> None:
        super().__init__(name)
        self._socket = sock
        self.address = address

    def flush(self) -> None:
        datagram = b""
        for frame in self.outbox:
            if datagram and len(datagram) + len(frame) > DATAGRAM_BYTES:
                self._send(datagram)
                datagram = b""
            datagram += frame
        self.outbox.clear()
        if datagram:
            self._send(datagram)

    def _send(self, datagram: bytes) -> None:
        with contextlib.suppress(OSError):  # nobody there, no route, buffer full: UDP may lose datagrams
            self._socket.sendto(datagram, self.address)


class _UdpLink(DatagramLink):
    def __init__(self, name: str, bind: Address) -> None:
        super().__init__(name, bind)
        self._by_address: dict[Address, _UdpPeer] = {}

    @property
    def local_address(self) -> Address:
        """(host, port) that the socket is bound to."""
        host, port = self._socket.getsockname()[:2]
        return host, port

    def _peer(self, address: Address) -> _UdpPeer:
        peer = self._by_address.get(address)
        if peer is None:
            if len(self._by_address) >= MAX_PEERS:
                silent = self.silent_for_longest()
                silent.closed, silent.why_closed = True, f"more than {MAX_PEERS} peers; silent for longest"
                self._by_address = {at: one for at, one in self._by_address.items() if one is not silent}
                self.peers.remove(silent)
            peer = _UdpPeer(f"{self.name} {address[0]}:{address[1]}", self._socket, address)
            self._by_address[address] = peer
            self.add_peer(peer)
        return peer

    def _readable(self) -> None:
        for _ in range(_READS_AT_ONCE):
            try:
                data, address = self._socket.recvfrom(65535)
            except BlockingIOError:
                return
            except OSError:
                continue  # an earlier datagram was refused (ICMP); the socket is still good
            self.deliver(self._peer(address), data)


class UdpOutLink(_UdpLink):
    """Sends to ``host:port`` from the start.

    A client that answers from another address becomes a peer as well.
    """

    def __init__(self, host: str, port: int) -> None:
        target = socket.getaddrinfo(host, port, socket.AF_INET, socket.SOCK_DGRAM)[0][4]
        super().__init__(f"udpout:{host}:{port}", ("127.0.0.1" if str(target[0]).startswith("127.") else "0.0.0.0", 0))
        self._peer((str(target[0]), int(target[1])))


class UdpInLink(_UdpLink):
    """Listens on ``host:port``; each address that sends becomes a peer."""

    def __init__(self, host: str = "127.0.0.1", port: int = 0) -> None:
        super().__init__(f"udpin:{host}:{port}", (host, port))
