# SPDX-License-Identifier: BSD-3-Clause
"""A mission: items that do not change.

How far it is flown is in the vehicle's record (navigation.state), not here. So a snapshot of a vehicle keeps
its mission by reference.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass

from ...core.mavlink import MavCmd, MavMissionResult
from ...errors import SitlError
from .item import STORED, MissionItem
from .validate import check_all

RESULT_NAMES = {
    1: "jump to an item that is not there",
    2: "unsupported frame",
    3: "unsupported command",
    4: "too many items",
    6: "invalid parameter 1",
    7: "invalid parameter 2",
    8: "invalid parameter 3",
    9: "invalid parameter 4",
    10: "invalid latitude",
    11: "invalid longitude",
    12: "invalid altitude",
}


class MissionError(SitlError, ValueError):
    """A mission that the firmware does not take; ``result`` is the MAV_MISSION_RESULT, ``seq`` the item."""

    def __init__(self, text: str, result: int, seq: int) -> None:
        super().__init__(text)
        self.result = result
        self.seq = seq


@dataclass(frozen=True)
class Mission:
    """Items by number. Item 0 is home: the vehicle writes it, and flies from item 1 on."""

    items: tuple[MissionItem, ...] = ()

    @classmethod
    def of(cls, items: Iterable[MissionItem], taken: Container[int] = STORED) -> Mission:
        """A mission of valid items, home first; ``taken``: the commands that a firmware takes.

        Raises:
            MissionError: names the first item that is refused and why.
        """
        all_items = tuple(items)
        result, seq = check_all(all_items, taken)
        if result != MavMissionResult.ACCEPTED:
            item = f" (command {all_items[seq].command}, frame {all_items[seq].frame})" if seq < len(all_items) else ""
            raise MissionError(f"mission item {seq}{item}: {RESULT_NAMES.get(result, result)}", result, seq)
        return cls(all_items)

    def __len__(self) -> int:
        return len(self.items)

    @property
    def present(self) -> bool:
        """Whether there is anything to fly."""
        return len(self.items) > 1

    def get(self, seq: int) -> MissionItem | None:
        """Item ``seq`` that can be flown, None when there is none (0 is home)."""
        return self.items[seq] if 1 <= seq < len(self.items) else None

    def tagged(self, tag: int) -> int:
        """Number of the first JUMP_TAG item with this tag, 0 when there is none."""
        marks = (k for k, item in enumerate(self.items) if item.command == MavCmd.JUMP_TAG and int(item.p1) == tag)
        return next(marks, 0)
