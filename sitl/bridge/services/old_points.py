# SPDX-License-Identifier: BSD-3-Clause
"""The protocols of before missions had types: FENCE_POINT for one area to stay in, RALLY_POINT.

Points come one by one, in any order. FENCE_TOTAL counts the point of return (0), the corners, and the first one again.
"""

from __future__ import annotations

from typing import Any

from ...autopilot.fence.items import FEWEST_CORNERS
from ...autopilot.mission.item import MissionItem
from ...core.mavlink import MavCmd, MavFrame, MavSeverity
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from .fence_and_rally import counted
from .mission_protocol import MissionService
from .service import Handler, StatefulService
from .statustext import StatusTextService

FENCE, RALLY = message("FENCE_POINT"), message("RALLY_POINT")
AROUND = 2
"""Points that FENCE_TOTAL counts besides the corners."""
Location = tuple[int, int]
NOWHERE: Location = (0, 0)


class OldPointService(StatefulService):
    """FENCE_POINT, FENCE_FETCH_POINT, RALLY_POINT, RALLY_FETCH_POINT."""

    kept = ("_warned",)

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._warned: tuple[str, ...] = ()

    def handlers(self) -> dict[str, Handler]:
        return {
            "FENCE_POINT": self._set_fence_point,
            "FENCE_FETCH_POINT": self._fetch_fence_point,
            "RALLY_POINT": self._set_rally_point,
            "RALLY_FETCH_POINT": self._fetch_rally_point,
        }

    def _warn(self, text: str) -> None:
        self.bridge.get(StatusTextService).say(MavSeverity.WARNING, text)

    def _deprecated(self, name: str) -> None:
        if name not in self._warned:
            self._warned += (name,)
            self.bridge.get(StatusTextService).say(MavSeverity.INFO, f"Received message ({name}) is deprecated")

    def _total(self, name: str) -> int:
        return int(self.bridge.vehicle.parameters[name])

    # ------------------------------------------------------------------ fence

    def _fence(self) -> tuple[Location | None, list[Location]]:
        """The point of return and the corners of the first area to stay in."""
        items, _ = self.bridge.get(MissionService).lists
        back = [(item.x, item.y) for item in items if item.command == MavCmd.NAV_FENCE_RETURN_POINT]
        inner = [item for item in items if item.command == MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION]
        corners = [(item.x, item.y) for item in inner[: int(inner[0].p1)]] if inner else []
        return (back[0] if back else None), corners

    def _set_fence_point(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._deprecated("FENCE_POINT")
        total, k = self._total("FENCE_TOTAL"), fields.idx
        if fields.count != total:
            self._warn(f"Invalid fence point, bad count ({fields.count} vs {total})")
        elif k >= total:
            self._warn(f"Invalid fence point, index past total ({k} >= {total})")
        elif total < FEWEST_CORNERS + AROUND:
            self._warn("Invalid FENCE_TOTAL, must be at least 5")
        elif not (abs(fields.lat) <= 90.0 and abs(fields.lng) <= 180.0):
            self._warn("Invalid fence point, bad lat or lng")
        else:
            back, corners = self._fence()
            location = (round(fields.lat * 1e7), round(fields.lng * 1e7))
            if k == 0:
                back = location
            elif k < total - 1:
                if len(corners) != total - AROUND:
                    corners = [NOWHERE] * (total - AROUND)
                corners[k - 1] = location
            self._keep(back, corners)

    def _keep(self, back: Location | None, corners: list[Location]) -> None:
        items = [MissionItem(MavCmd.NAV_FENCE_RETURN_POINT, MavFrame.GLOBAL, x=back[0], y=back[1])] if back else []
        items += [
            MissionItem(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, MavFrame.GLOBAL, len(corners), x=x, y=y)
            for x, y in corners
        ]
        self.bridge.get(MissionService).replace_fence(tuple(items))

    def _fetch_fence_point(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._deprecated("FENCE_FETCH_POINT")
        total, k = self._total("FENCE_TOTAL"), fields.idx
        if k >= total:
            self._warn(f"Invalid fence point, index past total({k} >= {total})")
            return
        back, corners = self._fence()
        lat, lon = NOWHERE
        if k == 0 and back is None and not corners:
            self._warn("Failed to get return point")
        elif k == 0:
            lat, lon = back or _middle(corners)
        elif corners and (k <= len(corners) or k == total - 1):
            lat, lon = corners[(k - 1) % len(corners)]
        system, component = sender
        point = {"idx": k, "count": total, "lat": lat * 1e-7, "lng": lon * 1e-7}
        channel.send(FENCE, FENCE.payload(target_system=system, target_component=component, **point))

    # ------------------------------------------------------------------ rally points

    def _set_rally_point(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._deprecated("RALLY_POINT")
        total, k = self._total("RALLY_TOTAL"), fields.idx
        if k >= total:
            self._warn("Bad rally point ID")
        elif fields.count != total:
            self._warn("Bad rally point count")
        else:
            missions = self.bridge.get(MissionService)
            fence, points = missions.lists
            changed = list(counted(points, total))
            changed[k] = MissionItem(
                MavCmd.NAV_RALLY_POINT, MavFrame.GLOBAL_RELATIVE_ALT, x=fields.lat, y=fields.lng, z=float(fields.alt)
            )
            missions.keep(fence, tuple(changed))

    def _fetch_rally_point(self, channel: Channel, fields: Any, sender: Sender) -> None:
        self._deprecated("RALLY_FETCH_POINT")
        total, k = self._total("RALLY_TOTAL"), fields.idx
        if k >= total:
            self._warn("Bad rally point ID")
            return
        _, points = self.bridge.get(MissionService).lists
        item = counted(points, total)[k]
        system, component = sender
        point = {"idx": k, "count": total, "lat": item.x, "lng": item.y, "alt": int(item.z)}
        channel.send(RALLY, RALLY.payload(target_system=system, target_component=component, **point))


def _middle(corners: list[Location]) -> Location:
    """The middle of the area's extent, which stands in for a point of return."""
    lats, lons = zip(*corners, strict=True)
    return (min(lats) + max(lats)) // 2, (min(lons) + max(lons)) // 2
