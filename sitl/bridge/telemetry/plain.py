# SPDX-License-Identifier: BSD-3-Clause
"""Messages that a law builds, built in plain Python."""

from __future__ import annotations

from functools import cache
from typing import Any

from ...core.records import as_bytes
from ...vehicle.record import Vehicle
from ..mavlink_firmware import MavlinkFirmware
from ..wire.choose import Builder, message_of
from ..wire.message import Message
from ..wire.port import Port


@cache
def _kind(builder: Builder) -> tuple[type[Message], bool]:
    """(The message that a law builds, whether it takes the port.)"""
    return message_of(builder), builder.__code__.co_argcount == 3  # type: ignore[attr-defined]


def filled(builder: Builder, v: Vehicle, port: Port | None = None) -> Any:
    """The message as it is now; None when the vehicle has nothing to say. ``port``: where the law takes one."""
    cls, takes_port = _kind(builder)
    m: Any = cls()
    said = builder(m, v, port) if takes_port else builder(m, v)
    return m if said else None


def built(profile: MavlinkFirmware, v: Vehicle, name: str) -> Any:
    """A message of a firmware's laws as it is now; None when the vehicle has nothing to say."""
    law = next(law for law in profile.core.builders if message_of(law).kind.name == name)
    return filled(law, v)


def build(builder: Builder, v: Vehicle, port: Port) -> bytes:
    """The payload now; empty when the vehicle has nothing to say."""
    m = filled(builder, v, port)
    return b"" if m is None else bytes(as_bytes(m, m.dtype))
