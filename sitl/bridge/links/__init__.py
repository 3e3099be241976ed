# SPDX-License-Identifier: BSD-3-Clause
"""Ways for bytes to reach a client: in process, UDP, TCP."""

from .inprocess import InProcessLink, LogLink
from .link import Link, LinkAddressError, Peer, open_link
from .tcp import TcpServerLink
from .udp import UdpInLink, UdpOutLink

__all__ = [
    "InProcessLink",
    "Link",
    "LinkAddressError",
    "LogLink",
    "Peer",
    "TcpServerLink",
    "UdpInLink",
    "UdpOutLink",
    "open_link",
]
