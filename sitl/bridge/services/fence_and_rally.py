# SPDX-License-Identifier: BSD-3-Clause
"""Lists of locations besides the mission: fences and rally points, how many fit, and how they get into the record."""

from __future__ import annotations

from typing import Any

from ...autopilot import rally
from ...autopilot.events import emit
from ...autopilot.fence import items as fence
from ...autopilot.fence.state import CORNERS, POINTS
from ...autopilot.mission.item import RELATIVE_FRAMES, MissionItem
from ...core.mavlink import MavCmd, MavFrame

CORNER_BYTES, POINT_BYTES = 8, 15
NO_POINT = MissionItem(MavCmd.NAV_RALLY_POINT, MavFrame.GLOBAL, autocontinue=0)
"""What RALLY_TOTAL counts beyond the points that were given."""


def most_fence_items(vehicle: Any) -> int:
    """How many items a list of fences may have: BRD_SD_FENCE gives as much space as the record has."""
    if _on_card(vehicle):
        return CORNERS
    return vehicle.firmware.fence_bytes // CORNER_BYTES


def most_rally_points(vehicle: Any) -> int:
    """How many rally points fit."""
    return min(vehicle.firmware.rally_bytes // POINT_BYTES, POINTS)


def _on_card(vehicle: Any) -> bool:
    values = vehicle.parameters
    return "BRD_SD_FENCE" in values.table and values["BRD_SD_FENCE"] > 0.0


def as_fence(item: MissionItem) -> MissionItem:
    """A fence's item as it is kept and sent back: its location, and its number of corners or radius."""
    return MissionItem(item.command, MavFrame.GLOBAL, p1=item.p1, x=item.x, y=item.y, autocontinue=item.autocontinue)


def as_rally_point(item: MissionItem) -> MissionItem:
    """A rally point as it is kept and sent back: its location, at whole metres."""
    return MissionItem(
        MavCmd.NAV_RALLY_POINT, item.frame, x=item.x, y=item.y, z=float(int(item.z)), autocontinue=item.autocontinue
    )


def load_fence(vehicle: Any, items: tuple[MissionItem, ...], *, checked: bool = True) -> None:
    """Put a list of fences into the record; FENCE_TOTAL counts it.

    Raises:
        FenceError: it makes no fence, or does not fit; what was loaded before stays.
    """
    shapes = list(fence.shapes(items))
    if checked and not _on_card(vehicle) and fence.stored_bytes(items, shapes) > vehicle.firmware.fence_bytes:
        raise fence.FenceError("Fence exceeds storage size")
    fence.load(vehicle.v.autopilot.fence, shapes)
    _note(vehicle.v, fence.FENCE_LOADED, items)


def count(items: tuple[MissionItem, ...]) -> int:
    """FENCE_TOTAL: with a point of return and the first corner again at the end, once there is an area to stay in."""
    if not any(item.command == MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION for item in items):
        return 0
    has_return = any(item.command == MavCmd.NAV_FENCE_RETURN_POINT for item in items)
    return min(len(items) + (1 if has_return else 2), 127)


def load_rally(vehicle: Any, items: tuple[MissionItem, ...]) -> None:
    """Put rally points into the record; RALLY_TOTAL says how many of them count."""
    rally.load(vehicle.v.autopilot.rally, [(i.x, i.y, int(i.z), i.frame not in _ABOVE_HOME) for i in items])
    _note(vehicle.v, rally.RALLY_LOADED, items)


def _note(v: Any, code: int, items: tuple[MissionItem, ...]) -> None:
    """An event for logs, but for an empty list."""
    if items:
        emit(v.autopilot.events, v.time_us, code, 0.0, 0.0)


_ABOVE_HOME = (*RELATIVE_FRAMES, 10, 11)


def counted(items: tuple[MissionItem, ...], total: int) -> tuple[MissionItem, ...]:
    """As many rally points as RALLY_TOTAL says."""
    return (items + max(total - len(items), 0) * (NO_POINT,))[: max(total, 0)]
