# SPDX-License-Identifier: BSD-3-Clause
"""Links by which bytes reach a client: in process, UDP, TCP; and links written as text: ``udp:127.0.0.1:14550``."""

from __future__ import annotations

from .faults import LinkFaults
from .inprocess import InProcessLink, LogLink
from .link import Link, LinkAddressError, Peer
from .tcp import TcpClientLink, TcpServerLink
from .udp import UdpInLink, UdpOutLink

__all__ = [
    "InProcessLink", "Link", "LinkAddressError", "LinkFaults", "LogLink", "Peer", "TcpClientLink", "TcpServerLink",
    "UdpInLink", "UdpOutLink", "open_link",
]  # fmt: skip

ALLOWED = (
    "udp:HOST:PORT or udpout:HOST:PORT (send there), udpin:[HOST:]PORT (listen for datagrams), "
    "tcp:[HOST:]PORT or tcpin:[HOST:]PORT (listen for connections)"
)
LOCAL = "127.0.0.1"


def parse(text: str) -> tuple[str, str, int]:
    """(kind, host, port) of a link text; kind is "udpout", "udpin" or "tcp"."""
    kind, _, rest = text.partition(":")
    kinds = {"udp": "udpout", "udpout": "udpout", "udpin": "udpin", "tcp": "tcp", "tcpin": "tcp"}
    if kind not in kinds:
        raise LinkAddressError(f"link {text!r}: {kind!r} is not a kind of link; allowed: {ALLOWED}")
    host, colon, port_text = rest.removeprefix("//").rpartition(":")
    if not port_text or (not colon and not port_text.isdigit()):
        raise LinkAddressError(f"link {text!r}: the port is missing; allowed: {ALLOWED}")
    if not host and kinds[kind] == "udpout":
        raise LinkAddressError(f"link {text!r}: the host is missing; allowed: {ALLOWED}")
    if not (port_text.isascii() and port_text.isdigit() and 0 < int(port_text) < 65536):
        raise LinkAddressError(f"link {text!r}: {port_text!r} is not a port (1 .. 65535); allowed: {ALLOWED}")
    return kinds[kind], host or LOCAL, int(port_text)


def open_link(text: str) -> Link:
    """Open the link that ``text`` describes."""
    kind, host, port = parse(text)
    try:
        if kind == "udpout":
            return UdpOutLink(host, port)
        return UdpInLink(host, port) if kind == "udpin" else TcpServerLink(port, host)
    except OSError as error:
        raise LinkAddressError(f"link {text!r} cannot be opened: {error.strerror or error}") from error
