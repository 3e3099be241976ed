# SPDX-License-Identifier: BSD-3-Clause
"""What ground stations and companions did to a vehicle, step by step."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from sitl.autopilot.mission.item import MissionItem
from sitl.core.mavlink import MavCmd

from .log import LoggedMessage

Sender = tuple[int, int]
"""System and component id."""


@dataclass(frozen=True)
class Step:
    """One thing that was done. ``time`` is since the log's first frame [s]."""

    time: float
    sender: Sender


@dataclass(frozen=True)
class Send(Step):
    """A message, to be sent as it was."""

    name: str
    fields: dict[str, Any]
    result: int | None = None
    """MAV_RESULT that the vehicle answered; None: the log has no answer."""

    @property
    def command(self) -> int | None:
        """Number of the command, if it is one."""
        if self.name == "SET_MODE":
            return MavCmd.DO_SET_MODE
        return int(self.fields["command"]) if self.name in ("COMMAND_LONG", "COMMAND_INT") else None

    @property
    def title(self) -> str:
        """Description of the step."""
        if self.name in ("COMMAND_LONG", "COMMAND_INT"):
            return f"command {self.command}"
        if self.name == "PARAM_SET":
            return f"parameter {_text(self.fields['param_id'])} = {self.fields['param_value']:g}"
        return self.name

    @property
    def needs_ready(self) -> bool:
        """Whether a vehicle does it only when it is ready, and the one of the log did."""
        if self.result not in (None, 0):
            return False
        if self.command == MavCmd.COMPONENT_ARM_DISARM:
            return float(self.fields["param1"]) == 1.0
        return self.command in (MavCmd.DO_SET_MODE, MavCmd.NAV_TAKEOFF, MavCmd.MISSION_START)


@dataclass(frozen=True)
class Upload(Step):
    """A mission was uploaded."""

    items: tuple[MissionItem, ...]
    result: int | None = None
    """MAV_MISSION_RESULT that the vehicle answered."""

    title = "mission upload"
    needs_ready = False


PASSED = frozenset((
    "COMMAND_LONG", "COMMAND_INT", "SET_MODE", "PARAM_SET", "RC_CHANNELS_OVERRIDE", "MANUAL_CONTROL",
    "SET_POSITION_TARGET_LOCAL_NED", "SET_POSITION_TARGET_GLOBAL_INT", "SET_ATTITUDE_TARGET", "SET_HOME_POSITION",
    "SET_GPS_GLOBAL_ORIGIN", "MISSION_SET_CURRENT", "MISSION_CLEAR_ALL", "HEARTBEAT",
))  # fmt: skip
"""Messages that change what a vehicle does: sent again as they were."""
QUESTIONS = frozenset((410, 510, 511, 512, 519, 520, 521, 527))
"""Commands that only ask for something: left out."""
GLOBAL_FRAMES = (0, 3, 5, 6, 10, 11)
LEFT_OUT = {
    "MISSION_WRITE_PARTIAL_LIST": "a part of a mission",
    "SET_ACTUATOR_CONTROL_TARGET": "direct control of the outputs",
    "GPS_INJECT_DATA": "GPS corrections",
    "GPS_RTCM_DATA": "GPS corrections",
    "VISION_POSITION_ESTIMATE": "positions from outside",
    "FENCE_POINT": "a fence",
    "RALLY_POINT": "rally points",
}
"""Messages that we cannot send again, in words."""


@dataclass
class Found:
    """Steps in the order of the log, and what was left out."""

    steps: list[Step] = field(default_factory=list)
    left_out: dict[str, int] = field(default_factory=dict)
    """Description -> number of messages."""


def _text(value: Any) -> str:
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value)


def item_of(message: LoggedMessage) -> MissionItem:
    """A mission item of MISSION_ITEM or MISSION_ITEM_INT."""
    f = message.fields
    x, y = f.x, f.y
    if message.name == "MISSION_ITEM":
        scale = 1e7 if f.frame in GLOBAL_FRAMES else 1e4
        x, y = round(x * scale), round(y * scale)
    return MissionItem(
        int(f.command), int(f.frame), float(f.param1), float(f.param2), float(f.param3), float(f.param4),
        int(x), int(y), float(f.z), int(f.autocontinue),
    )  # fmt: skip
