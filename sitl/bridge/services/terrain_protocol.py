# SPDX-License-Identifier: BSD-3-Clause
"""Heights of the ground, asked of ground stations: TERRAIN_REQUEST, TERRAIN_DATA, TERRAIN_CHECK.

https://mavlink.io/en/services/terrain.html. The grid is here; the vehicle's record has the square around the vehicle
(``autopilot.terrain``). Those who are sent TERRAIN_REPORT are asked; where nobody is, the ground is a plain.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ...autopilot.fence.state import POINTS
from ...autopilot.mission.item import COMMANDS, MissionItem
from ...autopilot.terrain import grid
from ...autopilot.terrain.grid import NOTHING, PARTS, Block, Blocks, Part
from ...core.constants import NEVER
from ...core.geodesy import add_offset, offset_ne
from ..channel import Channel
from ..dialect import message
from ..host import Host
from ..listener import Sender
from ..wire.streams import interval_of
from .service import Handler, Service

REPORT, REQUEST = message("TERRAIN_REPORT"), message("TERRAIN_REQUEST")
TERRAIN = "TERRAIN_", grid.SIM_TERRAIN
"""Beginnings of the names of its parameters."""
EVERY_US = 2_000_000
"""A block is asked for so often, as ArduPilot does."""
NO_DOWNLOAD, LONGEST = 1, 10_000
"""TERRAIN_OPTIONS; greatest TERRAIN_SPACING [m]."""
BLOCKS_MAX = 256
"""More are forgotten, the oldest first."""
CHECKED_MAX = 8
"""Locations of TERRAIN_CHECK that are kept."""
Source = Callable[[float, float], float | None]
"""Height of the ground [m above sea level] at a latitude and a longitude [deg]; None: not known."""
LAT_MAX, LON_MAX = 900_000_000, 1_800_000_000
START_RADIUS = 100.0
"""The estimate's origin is so near to where the vehicle was switched on, or the simulated ground stays flat [m]."""


class TerrainService(Service):
    """Terrain data, requested from ground stations."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._ap, self._values = bridge.vehicle.v.autopilot, bridge.vehicle.parameters
        self._terrain: Any = getattr(self._ap, "terrain", None)
        """Its record; None: this firmware has none."""
        self._blocks: Blocks = {}
        self._spacing = 0 if self._terrain is None else self._wanted_spacing()
        """Of the points in ``_blocks`` [m]."""
        self._checked: tuple[Block, ...] = ()
        self._asked: tuple[Block, ...] = ()
        """What has been asked for, the last one last."""
        self._source: Source | None = None
        self._tried: tuple[Block, ...] = ()
        """What the source does not know all of."""
        self._items: tuple[MissionItem, ...] = ()
        self._on_mission: tuple[Block, ...] = ()

    def handlers(self) -> dict[str, Handler]:
        if self._terrain is None:
            return {}
        return {"TERRAIN_DATA": self._data, "TERRAIN_CHECK": self._check}

    def channel_removed(self, channel: Channel) -> None:
        self.look()

    def parameter_changed(self, name: str) -> None:
        if name.startswith(TERRAIN):
            self.look()

    # ------------------------------------------------------------------ whom to ask, and for what

    def look(self) -> None:
        """Clients, streams or parameters have changed."""
        t = self._terrain
        if t is None:
            return
        spacing = self._wanted_spacing()
        if spacing != self._spacing:
            self._spacing, self._blocks, self._checked, self._asked, self._on_mission = spacing, {}, (), (), ()
            self._items = self._tried = ()
            self.look_up()
        t.asked = bool(self._listeners()) or self._uses_source()
        self.due_us = (self.bridge.now_us // EVERY_US + 1) * EVERY_US if t.asked else NEVER
        self._count()
        self._shape()

    def _wanted_spacing(self) -> int:
        return min(max(int(self._values[grid.SPACING]), 1), LONGEST)

    def use(self, source: Source) -> None:
        """Take heights from a source of the simulator's own; what it does not know is asked for."""
        self._source = source
        self.look()

    def _uses_source(self) -> bool:
        return self._source is not None and self._ap.params.TERRAIN.ENABLE > 0.0

    def _fill(self, block: Block) -> None:
        """Take what the source knows of a block."""
        if self._source is None:
            return
        parts = list(self._blocks.get(block, NOTHING))
        for k in range(PARTS):
            parts[k] = parts[k] or grid.measured(block, k, self._spacing, self._source) or ()
        self._keep(block, parts)

    def _keep(self, block: Block, parts: list[Part]) -> None:
        others = {b: held for b, held in self._blocks.items() if b != block}
        if len(others) >= BLOCKS_MAX:
            del others[next(iter(others))]
        self._blocks = {**others, block: tuple(parts)}

    def _listeners(self) -> list[Channel]:
        p = self._ap.params.TERRAIN
        if p.ENABLE <= 0.0 or int(self._values[grid.OPTIONS]) & NO_DOWNLOAD:
            return []
        channels = self.bridge.channels
        return [c for c in channels if not c.peer.is_log and interval_of(c.port, REPORT.id) > 0]

    def _needed(self) -> tuple[Block, ...]:
        """Blocks around the vehicle, at home, on the mission's path, at rally points, and where TERRAIN_CHECK asked."""
        return tuple(dict.fromkeys(self._find_needed()))[:BLOCKS_MAX]

    def _find_needed(self) -> Iterator[Block]:
        est, home, spacing = self._ap.estimate, self._ap.home, self._spacing
        if est.origin_set:
            yield from grid.around(*add_offset(est.origin_lat, est.origin_lon, est.pos.x, est.pos.y), spacing)
        if home.is_set:
            yield grid.block_of(home.lat, home.lon, spacing)
        items = self.bridge.autopilot.mission_items()
        if items is not self._items:
            self._items, self._on_mission = items, tuple(dict.fromkeys(self._along_mission(items)))
        yield from self._on_mission
        rally = self._ap.rally
        for k in range(min(int(self._ap.params.RALLY.TOTAL), POINTS)):
            yield grid.block_of(rally.lat[k], rally.lon[k], spacing)
        yield from self._checked

    def _along_mission(self, items: tuple[MissionItem, ...]) -> Iterator[Block]:
        before: tuple[int, int] | None = None
        for item in items[1:]:
            known = COMMANDS.get(item.command)
            if known is None or not known.has_location or item.no_location:
                continue
            yield grid.block_of(item.x, item.y, self._spacing)
            if before is not None:
                for k, block in enumerate(grid.between(*before, item.x, item.y, self._spacing)):
                    if k >= BLOCKS_MAX:
                        break
                    yield block
            before = item.x, item.y

    def _missing(self, block: Block) -> int:
        """Bits of the parts of a block that are not known."""
        parts = self._blocks.get(block, NOTHING)
        return sum(1 << k for k in range(PARTS) if not parts[k])

    def _count(self) -> None:
        """Tell the core how much is missing."""
        t = self._terrain
        t.loaded = sum(bool(part) for parts in self._blocks.values() for part in parts)
        needed = self._needed()
        if not self._listeners():  # nobody knows more than the source
            needed = tuple(block for block in needed if block not in self._tried)
        missing = sum(self._missing(block).bit_count() for block in needed)
        t.pending = 0 if not t.asked else missing if self._ap.estimate.origin_set else PARTS

    def service(self, now_us: int) -> None:
        self.due_us = (now_us // EVERY_US + 1) * EVERY_US
        listeners = self._listeners()
        missing = [block for block in self._needed() if self._missing(block)]
        if missing and self._uses_source():
            for block in missing:
                if block not in self._tried:
                    self._fill(block)
            self._tried = tuple(missing)
            missing = [block for block in missing if self._missing(block)]
            self.look_up()
        if missing and listeners:
            latest = self._asked[-1] if self._asked else None
            k = missing.index(latest) + 1 if latest in missing else 0
            block = missing[k % len(missing)]
            self._asked = (*(b for b in self._asked if b != block), block)[-BLOCKS_MAX:]
            payload = REQUEST.payload(
                lat=block.lat, lon=block.lon, grid_spacing=self._spacing, mask=self._missing(block)
            )
            for channel in listeners:
                channel.put(REQUEST, payload)
        self._count()

    # ------------------------------------------------------------------ answers

    def _data(self, channel: Channel, m: Any, sender: Sender) -> None:
        """A part of a block: of one that was asked for, with the spacing that was asked for; others are left out."""
        block = self._asked_for(m.lat, m.lon)
        if block is None or m.grid_spacing != self._spacing or m.gridbit >= PARTS or not self._terrain.asked:
            return
        t, parts = self._terrain, list(self._blocks.get(block, NOTHING))
        if not parts[m.gridbit]:
            t.loaded, t.pending = t.loaded + 1, max(t.pending - 1, 0)
        parts[m.gridbit] = tuple(m.data)
        self._keep(block, parts)
        self.look_up()

    def _asked_for(self, lat: int, lon: int) -> Block | None:
        block = Block(lat, lon)
        if block in self._asked:
            return block
        if abs(lat) > LAT_MAX or abs(lon) > LON_MAX:
            return None
        margin = self._values[grid.MARGIN]
        near = [b for b in self._asked if max(map(abs, offset_ne(b.lat, b.lon, lat, lon))) <= margin]
        return near[0] if near else None

    def height(self, lat: float, lon: float) -> float | None:
        """Height of the ground [m above sea level] at a location [degE7]; None: not known."""
        if not self._blocks or abs(lat) > LAT_MAX or abs(lon) > LON_MAX:
            return None
        return grid.height_of(self._blocks, lat, lon, self._spacing)

    def rise(self, lat: float, lon: float) -> float | None:
        """How much higher the ground is at a location [degE7] than at home [m]: 0 where it is a plain; None:
        not known."""
        t = self._terrain
        if t is None or not (t.asked or t.was_known or self._ap.params.TERRAIN.ENABLE <= 0.0):
            return 0.0
        height = self.height(lat, lon) if self._ap.params.TERRAIN.ENABLE > 0.0 else None
        return height - t.home if height is not None and t.was_known else None

    def _check(self, channel: Channel, m: Any, sender: Sender) -> None:
        """TERRAIN_CHECK is answered at once; what is not known there is asked for."""
        t = self._terrain
        height = self.height(m.lat, m.lon)
        if abs(m.lat) <= LAT_MAX and abs(m.lon) <= LON_MAX:
            block = grid.block_of(m.lat, m.lon, self._spacing)
            self._checked = (*(b for b in self._checked if b != block), block)[-CHECKED_MAX:]
            self._count()
        here = self._ap.home.pos.z - self._ap.estimate.pos.z - t.difference
        channel.send(
            REPORT,
            REPORT.payload(
                lat=m.lat, lon=m.lon, spacing=0 if height is None else self._spacing,
                terrain_height=0.0 if height is None else height + t.offset, current_height=here,
                pending=min(t.pending, 65535), loaded=min(t.loaded, 65535),
            ),
        )  # fmt: skip

    # ------------------------------------------------------------------ what the core knows

    def look_up(self) -> None:
        """Give the core the square around the vehicle, and the height at home."""
        t, est, home, spacing = self._terrain, self._ap.estimate, self._ap.home, self._spacing
        if t is None or not est.origin_set or not (self._blocks or t.has_square):
            return
        location = add_offset(est.origin_lat, est.origin_lon, est.pos.x, est.pos.y)
        square = grid.square_of(self._blocks, *location, spacing)
        t.has_square, t.spacing = True, spacing
        t.north, t.east = est.pos.x + square.north, est.pos.y + square.east
        t.is_known = square.corners is not None
        if square.corners is not None:
            t.corners[:] = square.corners
        at_home = self.height(home.lat, home.lon) if home.is_set else None
        if at_home is not None:
            t.home = at_home
            t.was_known = t.was_known or t.is_known
        self._shape()

    def _shape(self) -> None:
        """Whether the simulated ground follows the heights: on a plain without solids, where all is simulated here."""
        t, vehicle, est = self._terrain, self.bridge.vehicle, self._ap.estimate
        t.shapes = False
        is_plain = vehicle.has_truth_in_record and vehicle.has_plain_ground
        if not (self._blocks and is_plain):
            return
        start = vehicle.v.physics.origin
        height = self.height(start.lat, start.lon)
        away = offset_ne(start.lat, start.lon, est.origin_lat, est.origin_lon)
        if height is not None and max(map(abs, away)) < START_RADIUS:
            t.start, t.shapes = height, self._values[grid.SIM_TERRAIN] > 0.0

    def armed(self) -> None:
        """Home is as high as the ground there from now on (TERRAIN_OFS_MAX)."""
        t = self._terrain
        if t is not None and t.was_known:
            most = abs(self._values[grid.OFFSET_MAX])
            t.offset = min(max(float(self._ap.home.alt) - t.home, -most), most)

    # ------------------------------------------------------------------ other times, other boots

    def follow(self, before: TerrainService) -> None:
        """Go on after a reboot: heights stay known."""
        self._blocks, self._spacing, self._asked = before._blocks, before._spacing, before._asked
        self._source = before._source
        self.look()

    def snapshot(self) -> Any:
        held = tuple(self._blocks.items())
        return held, self._spacing, self._checked, self._asked, self._tried, self.due_us

    def restore(self, state: Any) -> None:
        blocks, self._spacing, self._checked, self._asked, self._tried, self.due_us = state
        self._blocks = dict(blocks)
        self._items, self._on_mission = (), ()
