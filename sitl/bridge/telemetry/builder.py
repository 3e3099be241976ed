# SPDX-License-Identifier: BSD-3-Clause
"""The laws that build a vehicle's telemetry, and what they build in plain Python."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from ..autopilot_api import Vehicle
from ..dialect import message
from ..mavlink_firmware import MavlinkFirmware
from ..wire.choose import Builder, message_of
from ..wire.port import Port
from . import channels, fence_status, flow, motion, ranging, sensors, status
from .plain import build
from .shell import shell_builders

_MODULES = (motion, sensors, ranging, status, channels, fence_status, flow)
_registered: dict[int, Builder] = {}


def register_message(builder: Builder) -> Builder:
    """Make a message of another package known in this process: every bridge made from now on can send it.

    Args:
        builder: the law (``sitl.bridge.wire.choose``); it comes before another one for the same message.

    Raises:
        TypeError: its first argument is no Message.
    """
    _registered[message_of(builder).kind.id] = builder
    return builder


def compiled(own: tuple[Builder, ...]) -> tuple[Builder, ...]:
    """The laws that build a firmware's telemetry in the core, one a message, in the order of the messages' numbers.

    Args:
        own: telemetry that only this firmware has, or has in its own way: it comes before what all firmwares share.
    """
    found: dict[int, Builder] = {}
    for module in _MODULES:
        found |= by_number(module.MESSAGES)
    found |= by_number(own)
    return tuple(found[number] for number in sorted(found))


def shell_messages(vehicle: Vehicle, profile: MavlinkFirmware, port: Port) -> dict[int, Callable[[], bytes]]:
    """What the shell builds for a vehicle: message number -> function that gives the payload now.

    It comes before a law of the core for the same message. ``port``: in place of a client's, for laws that take one.
    """
    found: dict[int, Callable[[], bytes]] = {
        message(name).id: partial(shell, vehicle, profile) for name, shell in shell_builders(vehicle).items()
    }
    return found | {number: partial(build, builder, vehicle.v, port) for number, builder in _registered.items()}


def by_number(builders: tuple[Builder, ...]) -> dict[int, Builder]:
    """Laws by the number of the message that each builds."""
    return {message_of(builder).kind.id: builder for builder in builders}
