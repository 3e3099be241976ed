# SPDX-License-Identifier: BSD-3-Clause
"""What others see around the vehicle, for its proximity sensor (PRX1_TYPE 2): OBSTACLE_DISTANCE, DISTANCE_SENSOR and
OBSTACLE_DISTANCE_3D.

A DISTANCE_SENSOR looks into one sector: orientations 0 (ahead) to 7, clockwise. The others are left out.
"""

from __future__ import annotations

import math

from ...autopilot.avoidance import objects
from ...autopilot.avoidance.proximity import (
    MAVLINK,
    SECTOR,
    SECTORS,
    Proximity,
    begin_scan,
    end_scan,
    end_sector,
    mounted,
    note_reading,
    sector_of,
)
from ...core.elementary import atan2, hypot, tan
from ...core.kernels import law
from ...core.mavlink import MavFrame
from ...core.scalars import finite
from ...core.vectors import Vec3
from ...vehicle.record import Vehicle
from ..telemetry.ranging import DistanceSensor, ObstacleDistance
from ..wire.message import Message, consecutive

LEVEL = tan(math.radians(15.0))
"""Sectors reach so far up and down."""


class ObstacleDistance3d(Message, name="OBSTACLE_DISTANCE_3D"):
    """A position on the body, forward, right, down, and the sensor's range, all [m]."""

    frame: int
    pos: Vec3 = consecutive("x", "y", "z")
    min_distance: float
    max_distance: float


@law
def obstacles(m: ObstacleDistance, v: Vehicle, sender: int) -> None:
    """OBSTACLE_DISTANCE: readings of all directions [cm]; a sector without a good one sees nothing."""
    seen, p = v.autopilot.proximity, v.autopilot.params
    step = m.increment_f if m.increment_f != 0.0 else float(m.increment)
    if seen.kind != MAVLINK or step == 0.0 or not finite(step + m.angle_offset):
        return
    begin_scan(seen, m.min_distance * 0.01, m.max_distance * 0.01, p.PRX1)
    is_kept = objects.are_noted(v.autopilot)
    for k in range(m.distances.shape[0]):
        angle = m.angle_offset + k * step
        if abs(k * step) < 360.0:
            note_reading(seen, math.radians(angle), m.distances[k] * 0.01, p.PRX1)
            if is_kept:
                objects.note_reading(v.autopilot, math.radians(angle), m.distances[k] * 0.01, v.time_us)
    end_scan(seen, v.time_us, p.PRX.FILT)


@law
def note_one(v: Vehicle, seen: Proximity, angle: float, distance: float) -> None:
    """One reading [m] at an angle [rad]: what its sector sees."""
    p = v.autopilot.params
    note_reading(seen, angle, distance, p.PRX1)
    if objects.are_noted(v.autopilot):
        objects.note_reading(v.autopilot, angle, distance, v.time_us)
    end_sector(seen, sector_of(mounted(angle, p.PRX1)), v.time_us, p.PRX.FILT)
    seen.update_us = v.time_us


@law
def distance(m: DistanceSensor, v: Vehicle, sender: int) -> None:
    """DISTANCE_SENSOR of another one: a reading [cm] of one sector."""
    seen = v.autopilot.proximity
    if seen.kind == MAVLINK and m.orientation < SECTORS:
        begin_scan(seen, m.min_distance * 0.01, m.max_distance * 0.01, v.autopilot.params.PRX1)
        note_one(v, seen, m.orientation * SECTOR, m.current_distance * 0.01)


@law
def obstacle_3d(m: ObstacleDistance3d, v: Vehicle, sender: int) -> None:
    """OBSTACLE_DISTANCE_3D: an obstacle's position on the body; what is far above or below is left out."""
    seen = v.autopilot.proximity
    away = hypot(m.pos.x, m.pos.y)
    is_known = finite(away) and finite(m.min_distance) and finite(m.max_distance)
    if is_known and seen.kind == MAVLINK and m.frame == MavFrame.BODY_FRD and abs(m.pos.z) < away * LEVEL:
        begin_scan(seen, m.min_distance, m.max_distance, v.autopilot.params.PRX1)
        note_one(v, seen, atan2(m.pos.y, m.pos.x), away)
