# SPDX-License-Identifier: BSD-3-Clause
"""The documentation page of everything spoken on MAVLink, made from the tables that the code runs on."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable
from typing import Any

from pymavlink.dialects.v20 import ardupilotmega

from ..autopilot.mission.item import COMMANDS as MISSION_COMMANDS
from ..autopilot.params.table import Values
from ..vehicle.kind import Kind
from ..vehicle.kinds import BUILT_IN, DEFAULT, KINDS
from .bridge import Bridge
from .dialect import message
from .firmware_profile import Profile, load
from .services import ALL_SERVICES
from .services.camera import CameraService
from .services.flight_state import FlightStateService
from .services.mount import MountService
from .services.streams import RATE_PREFIX
from .services.winch import WinchService
from .telemetry.shell import SHELL_BUILDERS
from .wire.choose import message_of


def page(text: str) -> str:
    """``docs/mavlink.md``: its template with the tables put in for their names in braces."""
    tables = {
        "commands": commands,
        "received": received,
        "sent": sent,
        "modes": modes,
        "missions": missions,
        "switches": switches,
    }
    for name, table in tables.items():
        text = text.replace(f"{{{name}}}", table())
    return text


def profiles() -> dict[str, Profile]:
    """Every firmware's profile by the firmware's name."""
    return {name: load(name) for name in BUILT_IN}


def first_sentence(thing: Any) -> str:
    """What a docstring says, on one line, up to the end of its first paragraph."""
    text = " ".join((inspect.getdoc(thing) or "").split("\n\n")[0].split())
    return text.rstrip(".").replace("``", "`")


def command_name(number: int) -> str:
    """MAV_CMD_... without the beginning."""
    known = ardupilotmega.enums["MAV_CMD"]
    return str(known[number].name.removeprefix("MAV_CMD_")) if number in known else NEWER[number]


NEWER = {611: "DO_SET_GLOBAL_ORIGIN"}
"""Commands that a release of pymavlink does not know yet."""


def _table(heads: tuple[str, ...], rows: list[tuple[Any, ...]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def _by_firmware(tables: dict[str, Any]) -> Iterable[tuple[Any, Any, str]]:
    """(key, value, whose) of tables by firmware; what all of them have alike comes once, as "both"."""
    for key in sorted({key for table in tables.values() for key in table}):
        owners: dict[Any, list[str]] = {}
        for name, table in tables.items():
            if key in table:
                owners.setdefault(table[key], []).append(name)
        for names in owners.values():
            yield key, tables[names[0]][key], "both" if len(names) == len(BUILT_IN) else ", ".join(names)


def commands() -> str:
    """Commands by number."""
    rows = []
    tables = {name: {n: e.run for n, e in profile.commands.items()} for name, profile in profiles().items()}
    for number, run, whose in _by_firmware(tables):
        entry = next(p.commands[number] for p in profiles().values() if number in p.commands)
        what = re.sub(r"^[\d, ]+(\(old\))?: *", "", first_sentence(run))
        rows.append((number, command_name(number), whose, "INT only" if entry.int_only else "LONG, INT", what))
    return _table(("number", "command", "vehicle", "as", "what it does"), rows)


class _Nobody:
    """A vehicle that only a bridge without links can have."""

    index, time_us, has_truth_in_record = 0, 0, True

    def __init__(self, kind: Kind) -> None:
        self.firmware = kind.firmware
        self.fleet = kind.record.fleet(1)
        self.v = kind.record.of(self.fleet, 0)
        self.parameters = Values(kind.firmware.table, self.v.autopilot.params)


def handled(name: str = DEFAULT) -> dict[str, type]:
    """Messages that a service acts on, by name; every firmware has the same."""
    services = Bridge(_Nobody(KINDS[name])).services  # type: ignore[arg-type]
    return {message: kind for kind, service in services.items() for message in service.handlers()}


def received() -> str:
    """Messages from clients, by the service that acts on them."""
    found = handled()
    names = {s: [f"{name} ({message(name).id})" for name in sorted(found) if found[name] is s] for s in ALL_SERVICES}
    taken = sorted({message_of(law).kind.name for profile in profiles().values() for law in profile.core.takers})
    rows = [("Set-points and sticks: taken in the core", ", ".join(f"{name} ({message(name).id})" for name in taken))]
    rows += [(first_sentence(service), ", ".join(names[service])) for service in ALL_SERVICES if names[service]]
    return _table(("service", "messages"), rows)


BY_SERVICES: dict[str, Callable[..., Any]] = {
    "CAMERA_FEEDBACK": CameraService.feedback,
    "WINCH_STATUS": WinchService.status,
    "FLIGHT_INFORMATION": FlightStateService.flight,
    "AUTOPILOT_STATE_FOR_GIMBAL_DEVICE": FlightStateService.for_gimbal,
    "MISSION_ITEM_REACHED": FlightStateService.last_reached,
    "GIMBAL_MANAGER_INFORMATION": MountService.information,
    "GIMBAL_MANAGER_STATUS": MountService.status,
    "GIMBAL_DEVICE_ATTITUDE_STATUS": MountService.attitude,
}
"""What services build, by the message's name; some vehicles have none of it."""


def telemetry(profile: Profile) -> dict[str, str]:
    """Content of every message of telemetry, by name."""
    laws: dict[str, Callable[..., Any]] = {message_of(law).kind.name: law for law in profile.core.builders}
    return {name: _content(builder, name) for name, builder in (BY_SERVICES | SHELL_BUILDERS | laws).items()}


def sent() -> str:
    """Telemetry by name: stream group and content."""
    group_of = {
        (vehicle, name): f"{RATE_PREFIX}{ending}"
        for vehicle, profile in profiles().items()
        for ending, names in profile.groups.values()
        for name in names
    }
    rows = []
    for name, content, whose in _by_firmware({vehicle: telemetry(p) for vehicle, p in profiles().items()}):
        vehicle = DEFAULT if whose == "both" else whose
        rows.append((message(name).id, name, whose, group_of.get((vehicle, name), "-"), content))
    return _table(("id", "message", "vehicle", "stream group", "content"), rows)


def _content(builder: Callable[..., Any], name: str) -> str:
    return re.sub(rf"^{name}[:.] *", "", first_sentence(builder))


def modes() -> str:
    """Flight modes by vehicle, in the order of AVAILABLE_MODES."""
    rows = [(name, m.number, m.name, m.description) for name, profile in profiles().items() for m in profile.modes]
    return _table(("vehicle", "number", "mode", "what it does"), rows)


def missions() -> str:
    """Mission items by number."""
    tables = {name: {n: MISSION_COMMANDS[n] for n in KINDS[name].firmware.commands.taken} for name in BUILT_IN}
    rows = [(n, command_name(n), whose, "yes" if c.is_nav else "no") for n, c, whose in _by_firmware(tables)]
    return _table(("number", "command", "vehicle", "navigation"), rows)


def switches() -> str:
    """Functions of switches by number."""
    tables = {name: {n: f.doc for n, f in KINDS[name].firmware.aux_functions.items()} for name in BUILT_IN}
    return _table(("function", "vehicle", "what it does"), [(n, whose, doc) for n, doc, whose in _by_firmware(tables)])
