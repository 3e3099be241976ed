# SPDX-License-Identifier: BSD-3-Clause
"""A mission on its way in: items as messages, results, the upload itself.

Numbers of MAV_MISSION_RESULT that the protocol itself gives.

(those of items are in ``autopilot.mission.validate``).
"""

from __future__ import annotations

from collections.abc import Container
from typing import Any

import numpy as np

from ...autopilot.mission.item import COMMANDS, STORED, MissionItem
from ...autopilot.mission.storage import stored, whole
from ...autopilot.mission.validate import check
from ...core.mavlink import MavMissionResult
from ..channel import Channel
from ..dialect import MessageType, message
from ..listener import Sender

ITEM_INT, ITEM = message("MISSION_ITEM_INT"), message("MISSION_ITEM")
_DEGE7 = np.float32(1e7)
_SAME_FRAME = {5: 0, 6: 3, 11: 10}
"""The _INT frames mean the same as the frames without; they are kept (and given back) as those."""


def from_int(fields: Any, taken: Container[int]) -> tuple[MissionItem, int]:
    """Item of a MISSION_ITEM_INT and its MAV_MISSION_RESULT; ``taken`` are the commands that missions may hold."""
    return _checked(fields, fields.x, fields.y, taken)


def from_float(fields: Any, taken: Container[int]) -> tuple[MissionItem, int]:
    """Item of a MISSION_ITEM (degrees) and its MAV_MISSION_RESULT; degE7 in single precision, as in ArduPilot."""
    known = COMMANDS.get(fields.command)
    if known is None or not known.has_location:
        return _checked(fields, whole(fields.x), whole(fields.y), taken)
    for value, most, refusal in (
        (fields.x, 90.0, MavMissionResult.INVALID_PARAM5_X),
        (fields.y, 180.0, MavMissionResult.INVALID_PARAM6_Y),
    ):
        if not abs(value) <= most:
            return _checked(fields, 0, 0, taken)[0], refusal
    x, y = (whole(float(np.float32(value) * _DEGE7)) for value in (fields.x, fields.y))
    return _checked(fields, x, y, taken)


def _checked(fields: Any, x: int, y: int, taken: Container[int]) -> tuple[MissionItem, int]:
    frame = _SAME_FRAME.get(fields.frame, fields.frame)
    p1, p2, p3, p4 = fields.param1, fields.param2, fields.param3, fields.param4
    item = MissionItem(fields.command, frame, p1, p2, p3, p4, x, y, fields.z, fields.autocontinue)
    result = check(item, taken)
    return (stored(item) if result == MavMissionResult.ACCEPTED and item.command in STORED else item), result


def _common(item: MissionItem, seq: int, is_current: bool, target: Sender, kind: int) -> dict[str, Any]:
    return {
        "param1": item.p1, "param2": item.p2, "param3": item.p3, "param4": item.p4, "z": item.z, "seq": seq,
        "command": item.command, "frame": item.frame, "autocontinue": item.autocontinue,
        "current": int(is_current),
        "target_system": target[0], "target_component": target[1], "mission_type": kind,
    }  # fmt: skip


def to_int(item: MissionItem, seq: int, is_current: bool, target: Sender, kind: int) -> tuple[MessageType, bytes]:
    """MISSION_ITEM_INT of an item."""
    return ITEM_INT, ITEM_INT.payload(x=item.x, y=item.y, **_common(item, seq, is_current, target, kind))


def to_float(item: MissionItem, seq: int, is_current: bool, target: Sender, kind: int) -> tuple[MessageType, bytes]:
    """MISSION_ITEM of an item."""
    known = COMMANDS.get(item.command)
    scale = 1e-7 if known is None or known.has_location else 1.0
    return ITEM, ITEM.payload(x=item.x * scale, y=item.y * scale, **_common(item, seq, is_current, target, kind))


TIMEOUT_US = 8_000_000
"""Without an item for so long [simulated us] the upload is given up (ArduPilot's value)."""
ASK_AGAIN_US = 1_000_000


class Upload:
    """Items ``first`` .. ``stop - 1`` of a list (MAV_MISSION_TYPE ``kind``), collected in order; ``base`` is what a
    partial write goes into.
    """

    def __init__(
        self,
        channel: Channel,
        sender: Sender,
        kind: int,
        first: int,
        stop: int,
        base: tuple[MissionItem, ...],
        now_us: int,
    ) -> None:
        self.channel = channel
        self.sender = sender
        self.kind = kind
        self.first = first
        self.stop = stop
        self.next = first
        self.deadline_us = now_us + TIMEOUT_US
        self.began_us = self.asked_us = now_us
        self._ask_us = now_us + ASK_AGAIN_US
        self._base = base
        self._items: list[MissionItem] = []

    def snapshot(self) -> tuple[Any, ...]:
        """Immutable; begins with the channel's number."""
        times = (self.deadline_us, self._ask_us, self.began_us, self.asked_us)
        return (
            self.channel.number,
            self.sender,
            self.kind,
            self.first,
            self.stop,
            self._base,
            tuple(self._items),
            *times,
        )

    @classmethod
    def restored(cls, state: tuple[Any, ...], channel: Channel) -> Upload:
        """The upload as it was."""
        _, sender, kind, first, stop, base, items, deadline_us, ask_us, began_us, asked_us = state
        upload = cls(channel, sender, kind, first, stop, base, 0)
        upload._items, upload.next = list(items), first + len(items)
        upload.deadline_us, upload._ask_us = deadline_us, ask_us
        upload.began_us, upload.asked_us = began_us, asked_us
        return upload

    @property
    def due_us(self) -> int:
        """When to ask again or to give up."""
        return min(self._ask_us, self.deadline_us)

    @property
    def complete(self) -> bool:
        """All items are there."""
        return self.next == self.stop

    def asked(self, now_us: int) -> None:
        """The next item was asked for."""
        self.asked_us = now_us
        self._ask_us = now_us + ASK_AGAIN_US

    def add(self, item: MissionItem, now_us: int) -> None:
        """The item asked for has come."""
        self._items.append(item)
        self.next += 1
        self.deadline_us = now_us + TIMEOUT_US

    def merged(self) -> tuple[MissionItem, ...]:
        """The whole mission as it becomes."""
        return (*self._base[: self.first], *self._items, *self._base[self.stop :])
