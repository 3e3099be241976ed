# SPDX-License-Identifier: BSD-3-Clause
"""Messages as records."""

from __future__ import annotations

import importlib
from collections.abc import Iterator

from sitl.bridge import firmware_profile
from sitl.bridge.wire.message import Message


def classes(base: type[Message]) -> Iterator[type[Message]]:
    for found in base.__subclasses__():
        yield found
        yield from classes(found)


def test_each_message_is_declared_once() -> None:
    for kind in ("copter", "rover"):
        firmware_profile.load(kind)
    for module in ("services", "telemetry"):
        importlib.import_module(f"sitl.bridge.{module}")
    for module in ("compiled", "reports", "last_messages"):
        importlib.import_module(f"sitl.envs.mavlink.{module}")
    declared: dict[str, list[str]] = {}
    for found in classes(Message):
        if found.__module__.startswith("sitl."):
            declared.setdefault(found.kind.name, []).append(f"{found.__module__}.{found.__name__}")
    assert len(declared) > 60
    assert {name: places for name, places in declared.items() if len(places) > 1} == {}
