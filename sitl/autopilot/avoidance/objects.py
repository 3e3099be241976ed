# SPDX-License-Identifier: BSD-3-Clause
"""The database of objects (OA_DB_*): where the proximity sensor has seen something, for BendyRuler.

An object is a ball around a reading's position, as wide as the beam there. A reading within a known object renews it.
Where all slots are taken, a nearer object replaces the farthest.
"""

from __future__ import annotations

import math

from ...core.algebra import direction, dot, norm, rotate, with_down
from ...core.border import LIDAR_SAMPLES, Sensors
from ...core.elementary import tan
from ...core.kernels import law
from ...core.scalars import finite
from ...core.vectors import Vec3
from ..params.avoidance import ObjectDatabase
from ..state import Autopilot
from .proximity import is_ground, is_ignored, mounted
from .state import OBJECTS, Objects

BENDY_RULER = (1.0, 3.0)
"""OA_TYPE"""
BEAM = math.radians(5.0)
"""Of the readings of a lidar within such an angle the nearest counts [rad]."""


@law
def position(objects: Objects, k: int) -> Vec3:
    """Where object ``k`` is, NED [m]."""
    return Vec3(float(objects.north[k]), float(objects.east[k]), float(objects.down[k]))


@law
def is_known(objects: Objects, k: int, time_us: int) -> bool:
    """Whether there is an object ``k``, seen not too long ago."""
    return objects.until_ms[k] > time_us // 1000


@law
def forget(objects: Objects) -> None:
    """Nothing has been seen."""
    for k in range(OBJECTS):
        objects.until_ms[k] = 0


@law
def note(objects: Objects, at: Vec3, away: float, pos: Vec3, time_us: int, p: ObjectDatabase) -> None:
    """Something was seen at a position, ``away`` from the vehicle at ``pos``, NED [m]."""
    radius = max(p.RADIUS_MIN, away * tan(math.radians(0.5 * p.BEAM_WIDTH)))
    chosen, farthest = -1, away
    for k in range(min(int(p.SIZE), OBJECTS)):
        if not is_known(objects, k, time_us):
            if farthest < math.inf:
                chosen, farthest = k, math.inf
            continue
        gap = position(objects, k) - at
        if dot(gap, gap) <= objects.radius[k] * objects.radius[k]:
            objects.radius[k] = max(float(objects.radius[k]), radius)
            objects.until_ms[k] = until(time_us, p)
            return
        distance = norm(position(objects, k) - pos)
        if distance > farthest:
            chosen, farthest = k, distance
    if chosen >= 0:
        objects.north[chosen], objects.east[chosen], objects.down[chosen] = at.x, at.y, at.z
        objects.radius[chosen] = radius
        objects.until_ms[chosen] = until(time_us, p)


@law
def until(time_us: int, p: ObjectDatabase) -> int:
    """How long what is seen now counts [ms] (OA_DB_EXPIRE; 0: for ever)."""
    return time_us // 1000 + int(p.EXPIRE * 1000.0) if p.EXPIRE > 0.0 else 2**31 - 1


@law
def note_reading(ap: Autopilot, angle: float, distance: float, time_us: int) -> None:
    """A reading [m] at an angle of the sensor [rad]; those that ``proximity.note_reading`` leaves out are left out."""
    seen, p, db, estimate = ap.proximity, ap.params.PRX1, ap.params.OA.DB, ap.estimate
    if not (finite(distance) and seen.range_min <= distance <= seen.range_max):
        return
    if db.DIST_MAX > 0.0 and distance > db.DIST_MAX:
        return
    at = mounted(angle, p)
    if not (is_ignored(at, p) or is_ground(seen, at, distance)):
        ray = rotate(estimate.q, with_down(direction(at) * distance, 0.0))
        note(ap.objects, estimate.pos + ray, distance, estimate.pos, time_us, db)


@law
def are_noted(ap: Autopilot) -> bool:
    """Whether what is seen is kept: for BendyRuler, and where the vehicle is known."""
    return ap.params.OA.TYPE in BENDY_RULER and ap.estimate.position_ok


@law
def note_scan(ap: Autopilot, sensors: Sensors, time_us: int) -> None:
    """The vehicle's own lidar's last scan."""
    samples = min(sensors.lidar_samples, LIDAR_SAMPLES)
    step = sensors.lidar_fov / max(samples - 1, 1)
    first, nearest, angle = 0.0, math.inf, 0.0
    for k in range(samples):
        at, distance = 0.5 * sensors.lidar_fov - k * step, float(sensors.lidar_ranges[k])
        if first - at >= BEAM or k == 0:
            note_reading(ap, angle, nearest, time_us)
            first, nearest = at, math.inf
        if finite(distance) and ap.proximity.range_min <= distance < nearest:
            nearest, angle = distance, at
    note_reading(ap, angle, nearest, time_us)
