# SPDX-License-Identifier: BSD-3-Clause
"""Ways for bytes to reach a client: in process, UDP, TCP."""

from .address import LinkAddressError, open_link
from .inprocess import InProcessLink, LogLink
from .link import Link, Peer
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
