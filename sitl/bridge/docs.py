# SPDX-License-Identifier: BSD-3-Clause
"""The documentation page of everything spoken on MAVLink, made from the tables that the code runs on."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega

from ..autopilot.mission.item import COMMANDS as MISSION_COMMANDS
from ..core.records import view
from ..vehicle import VEHICLE_DTYPE
from .bridge import Bridge
from .dialect import message
from .services import ALL_SERVICES
from .services.commands import TABLE as COMMANDS
from .services.modes import MODES
from .services.streams import GROUPS, RATE_PREFIX
from .telemetry.builder import builders


def page(text: str) -> str:
    """``docs/mavlink.md``: its template with the tables put in for their names in braces."""
    tables = {"commands": commands, "received": received, "sent": sent, "modes": modes, "missions": missions}
    for name, table in tables.items():
        text = text.replace(f"{{{name}}}", table())
    return text


def first_sentence(thing: Any) -> str:
    """What a docstring says, on one line, up to the end of its first paragraph."""
    text = " ".join((inspect.getdoc(thing) or "").split("\n\n")[0].split())
    return text.rstrip(".").replace("``", "`")


def command_name(number: int) -> str:
    """MAV_CMD_... without the beginning."""
    return str(ardupilotmega.enums["MAV_CMD"][number].name.removeprefix("MAV_CMD_"))


def _table(heads: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def commands() -> str:
    """Commands by number."""
    rows = []
    for number, entry in sorted(COMMANDS.items()):
        what = re.sub(r"^[\d, ]+(\(old\))?: *", "", first_sentence(entry.run))
        rows.append((number, command_name(number), "INT only" if entry.int_only else "LONG, INT", what))
    return _table(("number", "command", "as", "what it does"), rows)


class _Nobody:
    """A vehicle that only a bridge without links can have."""

    index, time_us = 0, 0

    def __init__(self) -> None:
        self.fleet = np.zeros(1, VEHICLE_DTYPE)
        self.v = view(self.fleet, 0)


def handled() -> dict[str, type]:
    """Messages that a service acts on, by name."""
    services = Bridge(_Nobody()).services  # type: ignore[arg-type]
    return {name: kind for kind, service in services.items() for name in service.handlers()}


def received() -> str:
    """Messages from clients, by the service that acts on them."""
    found = handled()
    names = {s: [f"{name} ({message(name).id})" for name in sorted(found) if found[name] is s] for s in ALL_SERVICES}
    rows = [(first_sentence(service), ", ".join(names[service])) for service in ALL_SERVICES if names[service]]
    return _table(("service", "messages"), rows)


def sent() -> str:
    """Telemetry by name: stream group and content."""
    group_of = {name: f"{RATE_PREFIX}{ending}" for ending, names in GROUPS.values() for name in names}
    rows = []
    for name, builder in sorted(builders().items()):
        rows.append((message(name).id, name, group_of.get(name, "-"), _content(builder, name)))
    return _table(("id", "message", "stream group", "content"), rows)


def _content(builder: Callable[..., Any], name: str) -> str:
    return re.sub(rf"^{name}[:.] *", "", first_sentence(builder))


def modes() -> str:
    """Flight modes by number."""
    return _table(("number", "mode"), [(number, name) for number, name, *_ in MODES])


def missions() -> str:
    """Mission items by number."""
    rows = [(n, command_name(n), "yes" if c.is_nav else "no") for n, c in sorted(MISSION_COMMANDS.items())]
    return _table(("number", "command", "flown"), rows)
