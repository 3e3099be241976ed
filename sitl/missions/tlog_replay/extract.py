# SPDX-License-Identifier: BSD-3-Clause
"""Finds in a log what was done to the vehicle: commands, missions, parameters, sticks, set-points."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from typing import Any

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.params.parm_files import FileValues
from sitl.core.mavlink import MavCmd
from sitl.scenario import Home
from sitl.vehicle.kinds import KINDS

from .log import Log, LoggedMessage
from .steps import LEFT_OUT, PASSED, QUESTIONS, Found, Send, Sender, Step, Upload, item_of

ANSWER_S = 3.0
"""An answer that comes later is none."""
UPLOAD_S = 60.0
"""An upload takes no longer than this."""
GROUND_STATION: Sender = (255, 190)
ITEMS = ("MISSION_ITEM", "MISSION_ITEM_INT")


@dataclass(frozen=True)
class Script:
    """The vehicle and the steps to fly."""

    log: Log
    home: Home | None
    """Position of the vehicle before it was armed; None: the log has none."""
    steps: list[Step]
    parameters: dict[str, float]
    """Parameters of the vehicle that affect how it flies."""
    notes: list[str]
    """What could not be taken over, in words."""


def extract(log: Log) -> Script:
    """All that was done to the log's vehicle."""
    notes: list[str] = []
    found = _commanded(log)
    flown = [
        step
        for step in found.steps
        if isinstance(step, Send) and step.command in (MavCmd.COMPONENT_ARM_DISARM, MavCmd.DO_SET_MODE)
    ]
    moves = [step for step in found.steps if isinstance(step, Send) and step.name.startswith("SET_POSITION")]
    armed = [time for time, state in log.changes("armed") if state]
    if not flown and not moves:
        found.steps += _observed(log)
        notes.append(
            "the log has no commands: modes, arming and mission are taken from what the vehicle says of itself"
        )
    elif armed and not any(step.command == MavCmd.COMPONENT_ARM_DISARM for step in flown):
        found.steps += [
            step for step in _observed(log) if isinstance(step, Send) and step.command == MavCmd.COMPONENT_ARM_DISARM
        ]
        notes.append("nobody arms the vehicle by command: it is armed when it says that it is")
    if log.clock_set:
        notes.append(f"the clock of the log was set {log.clock_set} times: what it jumped is left out")
    if armed and armed[0] <= 1.0:
        notes.append("the log begins with an armed vehicle: here it begins on the ground")
    found.steps.sort(key=lambda step: step.time)
    notes += [f"left out: {what} ({count} messages)" for what, count in sorted(found.left_out.items())]
    home = home_of(log)
    if home is None:
        notes.append("the log has no position of the vehicle: it starts at the default home")
    return Script(log, home, found.steps, parameters_of(log), notes)


def _commanded(log: Log) -> Found:
    """Steps from the messages that others sent to the vehicle."""
    found = Found()
    answers: dict[int, list[tuple[float, int]]] = defaultdict(list)
    for message in log.of_vehicle("COMMAND_ACK"):
        answers[int(message.fields.command)].append((message.time, int(message.fields.result)))
    sent = log.to_vehicle()
    for at, message in enumerate(sent):
        sender = (message.system, message.component)
        if message.name == "MISSION_COUNT":
            if _is_of_a_mission(message):
                _take(found, _upload(log, message, sent[at + 1 :], sender))
            else:
                _count(found, "fences and rally points")
        elif message.name in LEFT_OUT:
            _count(found, LEFT_OUT[message.name])
        elif message.name in PASSED:
            fields: dict[str, Any] = message.fields._asdict()
            step = Send(message.time, sender, message.name, fields)
            if step.command in QUESTIONS:
                continue
            if step.command is not None:
                step = Send(message.time, sender, message.name, fields, _answer(answers[step.command], message.time))
            found.steps.append(step)
    return found


def _answer(answers: list[tuple[float, int]], time: float) -> int | None:
    """The first answer from ``time`` on; it is used up."""
    for at, (when, result) in enumerate(answers):
        if when >= time:
            if when > time + ANSWER_S:
                return None
            del answers[: at + 1]
            return result
    return None


def _count(found: Found, what: str) -> None:
    found.left_out[what] = found.left_out.get(what, 0) + 1


def _take(found: Found, upload: Upload | None) -> None:
    if upload is None:
        _count(found, "a mission upload that is not whole in the log")
    else:
        found.steps.append(upload)


def _upload(log: Log, count: LoggedMessage, after: list[LoggedMessage], sender: Sender) -> Upload | None:
    """The upload that a MISSION_COUNT begins, if all of it is there."""
    items: dict[int, MissionItem] = {}
    end = count.time
    for message in after:
        if message.time > count.time + UPLOAD_S or len(items) == count.fields.count:
            break
        if (message.system, message.component) != sender:
            continue
        if message.name == "MISSION_COUNT":
            return None  # begun again
        if message.name in ITEMS and _is_of_a_mission(message):
            items[int(message.fields.seq)] = item_of(message)
            end = message.time
    if len(items) < count.fields.count:
        return None
    answers = (s for s in log.of_vehicle("MISSION_ACK") if end <= s.time <= end + ANSWER_S)
    result = next((int(s.fields.type) for s in answers), None)
    return Upload(count.time, sender, tuple(items[seq] for seq in sorted(items)), result)


def _is_of_a_mission(message: LoggedMessage) -> bool:
    """Else of a fence, or of rally points (MAV_MISSION_TYPE)."""
    return not getattr(message.fields, "mission_type", 0)


def _observed(log: Log) -> list[Step]:
    """Steps that would explain what the vehicle says of itself."""
    steps: list[Step] = []
    messages = filter(_is_of_a_mission, log.of_vehicle(*ITEMS))
    items = {int(message.fields.seq): item_of(message) for message in messages}
    armed = log.changes("armed")
    first = next((time for time, state in armed if state), log.duration)
    if items and sorted(items) == list(range(len(items))):
        steps.append(Upload(max(first - 5.0, 0.0), GROUND_STATION, tuple(items[seq] for seq in sorted(items))))
    for time, mode in log.changes("mode"):
        fields = {"command": MavCmd.DO_SET_MODE, "param1": 1.0, "param2": float(mode)}
        steps.append(Send(time, GROUND_STATION, "COMMAND_LONG", fields, 0))
    for time, state in armed:
        if state:
            fields = {"command": MavCmd.COMPONENT_ARM_DISARM, "param1": 1.0}
            steps.append(Send(time, GROUND_STATION, "COMMAND_LONG", fields, 0))
    last: tuple[int, ...] = ()
    for message in log.of_vehicle("RC_CHANNELS"):
        sticks = tuple(int(getattr(message.fields, f"chan{k}_raw")) for k in range(1, 5))
        if sticks != last and all(800 <= value <= 2200 for value in sticks):
            fields = {f"chan{k}_raw": value for k, value in enumerate(sticks, 1)}
            steps.append(Send(message.time, GROUND_STATION, "RC_CHANNELS_OVERRIDE", fields))
            last = sticks
    return steps


def home_of(log: Log) -> Home | None:
    """Position of the vehicle when it was first armed, else its first one: latitude, longitude [deg], altitude [m],
    heading
    [deg]."""
    armed = next((time for time, state in log.changes("armed") if state), math.inf)
    home: tuple[float, float, float] | None = None
    heading = 0.0
    for message in log.of_vehicle("GLOBAL_POSITION_INT"):
        f = message.fields
        if (home is not None and message.time > armed) or not (f.lat or f.lon):
            continue
        home = (f.lat * 1e-7, f.lon * 1e-7, f.alt * 1e-3)
        if f.hdg != 65535:
            heading = f.hdg * 1e-2
    if home is None:
        fix = next((s.fields for s in log.of_vehicle("GPS_RAW_INT") if s.fields.fix_type >= 3), None)
        home = (fix.lat * 1e-7, fix.lon * 1e-7, fix.alt * 1e-3) if fix is not None else None
    return (*home, heading) if home is not None else None


def parameters_of(log: Log) -> FileValues:
    """The vehicle's own values, before anybody set them, of what says how it is flown; taken as those of a file."""
    found: dict[str, float] = {}
    prefixes = KINDS[log.kind].flight_parameters
    for message in log.of_vehicle("PARAM_VALUE"):
        name = message.fields.param_id.decode(errors="replace")
        if name.startswith(prefixes) and name not in found and math.isfinite(message.fields.param_value):
            found[name] = float(message.fields.param_value)
    for message in log.to_vehicle():
        if message.name == "PARAM_SET":
            found.pop(message.fields.param_id.decode(errors="replace"), None)
    values = FileValues(found)
    if found:
        values.sources["parameters of the log"] = list(found)
    return values
