# SPDX-License-Identifier: BSD-3-Clause
"""``sitl physics --listen json:[HOST:]PORT``: serves a plant to an autopilot that speaks ArduPilot's JSON interface."""

from __future__ import annotations

from collections.abc import Callable

from ..plants.json_link import LOCAL, PORT, parse_address
from ..plants.local import LocalPlant
from .json_host import JsonHost


def serve(
    plant: LocalPlant,
    address: str,
    instance: int,
    say: Callable[[str], None],
    running: Callable[[], bool],
) -> None:
    """Listen until ``running()`` is false.

    Args:
        plant: at power-on.
        address: "[HOST:]PORT", "HOST", or "" for the default port of the instance on this machine.
        instance: adds 10 to the default port for each.
        say: prints a message for the user.
        running: checked about every 0.1 s.

    Raises:
        OptionError: the address cannot be had.
    """
    where = parse_address(address, "--listen json:[HOST:]PORT") if address else (LOCAL, PORT + 10 * instance)
    host = JsonHost(plant, where, say)
    say(f"JSON on udp {host.address[0]}:{host.address[1]}")
    try:
        host.serve(running)
    finally:
        host.close()
