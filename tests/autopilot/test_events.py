# SPDX-License-Identifier: BSD-3-Clause
"""Events of the core: what is said and logged of each, and the lists of the firmwares."""

from __future__ import annotations

import pkgutil
import sys
from collections.abc import Iterator
from importlib import import_module
from types import FunctionType
from typing import Any

import pytest

import sitl.autopilot
from sitl.autopilot import events as own
from sitl.autopilot.arming_checks import ARMED
from sitl.autopilot.copter.event_list import EVENTS as COPTER
from sitl.autopilot.events import Event, err, ev, register_event, with_registered
from sitl.autopilot.notes import EventNote, Text
from sitl.autopilot.rover.event_list import EVENTS as ROVER
from sitl.bridge import firmware_profile
from sitl.bridge.dialect import message_by_id
from sitl.core.extensions import ExtensionError
from sitl.core.fingerprint import _referenced
from sitl.core.mavlink import MavSeverity
from sitl.logs.dataflash import formats
from sitl.logs.dataflash.common import EVENT_MESSAGES
from sitl.logs.dataflash.event_messages import EventEncoder
from sitl.vehicle.kinds import KINDS

LISTS = {"copter": COPTER, "rover": ROVER}
FIRMWARES = pytest.mark.parametrize("firmware", LISTS)


def declared() -> Iterator[tuple[str, str, Event]]:
    """(module, name, event) of each that a module of the autopilot has."""
    for module in pkgutil.walk_packages(sitl.autopilot.__path__, "sitl.autopilot."):
        for name, value in vars(import_module(module.name)).items():
            if isinstance(value, Event):
                yield module.name, name, value


def emitted(firmware: str) -> set[Event]:
    """Events that laws of the firmware's core name."""
    core = firmware_profile.load(firmware).core
    waiting: list[Any] = [core.receive, core.transmit, core.run]
    seen: set[int] = set()
    found: set[Event] = set()
    while waiting:
        law = waiting.pop()
        for _, value in _referenced(law):
            if isinstance(value, Event):
                found.add(value)
            elif isinstance(value, FunctionType) and id(value) not in seen:
                seen.add(id(value))
                waiting.append(value)
    return found


@FIRMWARES
def test_what_laws_emit_is_listed(firmware: str) -> None:
    found = emitted(firmware)
    assert len(found) > 25
    assert found <= LISTS[firmware].keys(), sorted(found - LISTS[firmware].keys())


def test_every_event_is_listed_by_the_firmware_that_declares_it() -> None:
    missing = []
    for module, name, event in declared():
        within = [list_ for firmware, list_ in LISTS.items() if f".{firmware}." in module] or [COPTER, ROVER]
        if not any(event in list_ for list_ in within):
            missing.append(f"{module}.{name}")
    assert missing == []


def test_a_code_has_one_name() -> None:
    names: dict[int, set[str]] = {}
    for _, name, event in declared():
        names.setdefault(int(event), set()).add(name)
    assert {code: found for code, found in names.items() if len(found) != 1} == {}
    assert names.keys() == COPTER.keys() | ROVER.keys()
    assert max(names) < 200, "from there on they are those of other packages"


def possible(firmware: str, event: Event) -> list[tuple[float, list[EventNote], list[own.Row]]]:
    """(a, what is told, what is logged) of each ``a`` that the event may have."""
    v: Any = KINDS[firmware].record.of(KINDS[firmware].record.fleet(1), 0)
    found = []
    for a in range(90):  # up to the numbers of MAVLink messages
        try:
            found.append((a, list(event.notes(v, float(a), 1.0)), list(event.rows(v, float(a), 1.0))))
        except (KeyError, IndexError):  # its law emits no such number
            continue
    return found


@FIRMWARES
def test_texts_take_the_numbers_and_logs_have_the_messages(firmware: str) -> None:
    encoder = EventEncoder(formats.number_all(EVENT_MESSAGES))
    for code, event in LISTS[firmware].items():
        found = possible(firmware, event)
        assert found, f"event {code} says nothing of any number"
        for a, notes, rows in found:
            texts = [note.text for note in notes if isinstance(note, Text)]
            assert all(text and "{" not in text and text.isascii() for text in texts), (code, a, texts)
            assert all(encoder.pack(name, 0, *values) for name, values in rows), (code, a)


def test_ignored_set_points_are_named_as_mavlink_does() -> None:
    says = ROVER[29].says
    assert isinstance(says, dict) and len(says) == 2
    assert all(f"Ignoring {message_by_id(number).name};" in text for number, text in says.items())


def test_an_event_is_its_code() -> None:
    lost = Event(40, MavSeverity.CRITICAL, "Potential Thrust Loss ({a:.0f})", log=err(25, 1))
    assert lost == 40 and lost + 1 == 41 and repr(lost) == "40" and f"{lost}" == "40"
    assert lost.notes(None, 3.0, 0.0) == [Text(MavSeverity.CRITICAL, "Potential Thrust Loss (3)")]
    assert lost.rows(None, 3.0, 0.0) == [("ERR", (25, 1))]
    assert Event(4).notes(None, 0.0, 0.0) == [] == Event(4).rows(None, 0.0, 0.0)


def test_what_is_said_may_depend_on_the_numbers() -> None:
    by_number = Event(61, MavSeverity.INFO, {0: "found", 1: (MavSeverity.CRITICAL, "lost at {b:.1f}")})
    assert [by_number.notes(None, a, 2.5) for a in (0.0, 1.0)] == [
        [Text(MavSeverity.INFO, "found")],
        [Text(MavSeverity.CRITICAL, "lost at 2.5")],
    ]
    with pytest.raises(KeyError):
        by_number.notes(None, 2.0, 0.0)
    counted = Event(5, says=lambda v, a, b: [Text(MavSeverity.INFO, v)] * int(a), log=lambda v, a, b: [ev(int(b))])
    assert counted.notes("again", 2.0, 0.0) == [Text(MavSeverity.INFO, "again")] * 2
    assert counted.rows("again", 0.0, 18.0) == [("EV", (18,))]


def test_a_firmware_has_its_own_words() -> None:
    assert COPTER[1] == ROVER[1] == ARMED
    assert COPTER[1].notes(None, 0.0, 0.0) == [Text(MavSeverity.INFO, "Arming motors")]
    assert ROVER[1].notes(None, 0.0, 0.0) == [Text(MavSeverity.INFO, "Throttle armed")]
    assert COPTER[1].log is ROVER[1].log is ARMED.log


@pytest.mark.parametrize("codes", [(1, 3, 2), (1, 2, 2)])
def test_a_list_is_in_the_order_of_its_codes(codes: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="events of the toy: 2 stands behind"):
        with_registered("toy", [Event(code) for code in codes])


TAKEN, FREE, NO_EVENT = Event(2), Event(200), 7


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("TAKEN", "event MODULE:TAKEN: the toy has an event 2 already"),
        ("NO_EVENT", "event MODULE:NO_EVENT: 7 is no Event"),
        ("FREE", None),
    ],
)
def test_events_of_other_packages(name: str, error: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "MODULE", sys.modules[__name__])
    monkeypatch.setenv("SITL_EVENTS", "")
    monkeypatch.setattr(own._EXTENSIONS, "_read", set())
    register_event("toy", f"MODULE:{name}")
    if error is None:
        assert with_registered("toy", [Event(2)]) == {2: 2, 200: FREE}
    else:
        with pytest.raises(ExtensionError, match=error):
            with_registered("toy", [Event(2)])
