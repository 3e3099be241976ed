# SPDX-License-Identifier: BSD-3-Clause
"""TERRAIN_REPORT: how high the ground is below the copter."""

from __future__ import annotations

from ...autopilot.terrain.ground import by_grid
from ...core.kernels import law
from ...vehicle.copter import Copter
from ..telemetry.motion import global_position
from ..telemetry.units import uint16
from ..wire.message import Message


class TerrainReport(Message, name="TERRAIN_REPORT"):
    lat: int
    lon: int
    spacing: int
    terrain_height: float
    current_height: float
    pending: int
    loaded: int


@law
def terrain_report(m: TerrainReport, v: Copter) -> bool:
    """TERRAIN_REPORT: position, terrain altitude [m above sea level], altitude above terrain, numbers of missing and
    loaded parts of the grid; spacing 0: no data here, altitudes use the last known terrain, else that at sea level."""
    ap = v.autopilot
    t = ap.terrain
    difference = ap.home.pos.z - by_grid(t, ap.estimate.pos, ap.home.pos.z).d
    location = global_position(v)
    m.lat, m.lon = location.lat, location.lon
    m.spacing = uint16(float(t.spacing)) if t.is_known else 0
    m.terrain_height = t.home + difference + t.offset
    known = t.was_known or not t.asked
    m.current_height = ap.home.pos.z - ap.estimate.pos.z - difference if known else location.alt
    m.pending, m.loaded = uint16(float(t.pending)), uint16(float(t.loaded))
    return True


MESSAGES = (terrain_report,)
