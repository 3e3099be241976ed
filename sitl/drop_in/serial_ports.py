# SPDX-License-Identifier: BSD-3-Clause
"""Serial ports of the simulated autopilot, as ArduPilot's simulator names what they are connected to."""

from __future__ import annotations

from ..bridge.links import Link, TcpClientLink, open_link
from ..bridge.links.link import LinkAddressError
from .command_line import CommandLine

LEAST_PORT = 1000
"""Numbers below are added to the base port."""
GROUND_STATION_PORT = 14550


def waits(device: str) -> bool:
    """Whether the vehicle waits for a client there before it boots."""
    return device.startswith("tcp:") and device.endswith(":wait")


def open_port(line: CommandLine, number: int) -> Link | None:
    """The link of a serial port with MAVLink; None: nothing that there is here is connected to it.

    Raises:
        LinkAddressError: it cannot be opened, or its port is no number.
    """
    device = line.devices.get(number, "none")
    kind, _, rest = device.partition(":")
    words = rest.split(":")
    if kind == "tcp":
        port = _port(number, device, words[0])
        return open_link(f"tcp:{line.address}:{port + line.base_port if port < LEAST_PORT else port}")
    if kind in ("udpclient", "udp", "tcpclient"):
        host = words[0] or "127.0.0.1"
        port = _port(number, device, words[1]) if len(words) > 1 else GROUND_STATION_PORT
        if kind == "tcpclient":
            return TcpClientLink(host, port)
        return open_link(f"{'udpin' if kind == 'udp' else 'udpout'}:{host}:{port}")
    return None


def _port(number: int, device: str, text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text) < 65536):
        raise LinkAddressError(f"--serial{number} {device!r}: {text!r} is not a port (0 .. 65535)")
    return int(text)
