# SPDX-License-Identifier: BSD-3-Clause
"""The laws that build a vehicle's telemetry, and what they build in plain Python."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from ...core.records import as_bytes
from ...vehicle.record import Vehicle
from ..dialect import MessageType, message
from ..wire.choose import Builder, message_of
from ..wire.message import Message
from ..wire.port import Port
from . import channels, motion, ranging, sensors, status
from .shell import shell_builders

if TYPE_CHECKING:
    from ..profile import Profile

_MODULES = (motion, sensors, ranging, status, channels)
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


def messages(profile: Profile) -> tuple[Builder, ...]:
    """The laws that build a firmware's telemetry, one a message, in the order of the messages' numbers.

    A registered law comes before the firmware's own, and that before the one that all firmwares share.
    """
    found: dict[int, Builder] = {}
    for module in _MODULES:
        found |= by_number(module.MESSAGES)
    found |= by_number(profile.messages) | _registered
    return tuple(found[number] for number in sorted(found))


def by_number(builders: tuple[Builder, ...]) -> dict[int, Builder]:
    """Laws by the number of the message that each builds."""
    return {message_of(builder).kind.id: builder for builder in builders}


@cache
def _kind(builder: Builder) -> tuple[type[Message], bool]:
    """(The message that a law builds, whether it takes the port.)"""
    return message_of(builder), builder.__code__.co_argcount == 3  # type: ignore[attr-defined]


def build(builder: Builder, v: Vehicle, port: Port) -> bytes:
    """The payload that a law builds now, in plain Python; empty when the vehicle has nothing to say."""
    cls, takes_port = _kind(builder)
    m: Any = cls()
    said = builder(m, v, port) if takes_port else builder(m, v)
    return bytes(as_bytes(m, cls.dtype)) if said else b""


@dataclass
class Context:
    """A bridge that asks for payloads by functions without arguments."""

    reader: Any
    vehicle: Any
    profile: Profile
    epoch_us: int


Build = Callable[[], bytes | tuple[bytes, ...]]


def build_all(context: Context) -> dict[int, tuple[MessageType, Build]]:
    """The functions, by message number."""
    port, vehicle = Port(), context.vehicle

    def parts(builder: Builder) -> Build:
        def built() -> bytes | tuple[bytes, ...]:
            port.epoch_us = context.epoch_us
            found = [build(builder, vehicle.v, port)]
            while port.part != 0:
                found.append(build(builder, vehicle.v, port))
            return found[0] if len(found) == 1 else tuple(found)

        return built

    found: dict[int, tuple[MessageType, Build]] = {}
    for builder in messages(context.profile):
        kind = message_of(builder).kind
        found[kind.id] = (kind, parts(builder))
    for name, shell in shell_builders(vehicle).items():
        found[message(name).id] = (message(name), partial(shell, vehicle, context.profile))
    return found
