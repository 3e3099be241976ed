# SPDX-License-Identifier: BSD-3-Clause
"""From a line of sight to the position of the target."""

from __future__ import annotations

import math

from ...core.algebra import (
    dot,
    horizontal,
    multiply,
    norm,
    quat_from_euler,
    quat_from_rotation_vector,
    rotate,
    turned,
    with_down,
    yaw_of,
)
from ...core.border import Sensors
from ...core.kernels import law
from ...core.vectors import Euler, Quat, Vec3
from ..params.precision_landing import PrecisionLanding
from ..state import Estimate
from .orientation import axis, mounted
from .state import BODY, LEVEL_SENSOR, LandingTarget

FAR = 1000.0
"""A target further off [m] is seen by no sensor."""


@law
def take(t: LandingTarget, line: Vec3, frame: int, distance: float, time_us: int) -> None:
    """Note what a sensor has measured: a direction, of any length, and a distance [m], 0 where it has none."""
    length = norm(line)
    if length > 0.0:
        t.line, t.frame, t.distance, t.line_us = line * (1.0 / length), frame, max(distance, 0.0), time_us


@law
def attitude_then(est: Estimate, lag: float) -> Quat:
    """Attitude ``lag`` [s] ago."""
    return multiply(est.q, quat_from_rotation_vector(est.rates * -lag))


@law
def height_over_ground(sensors: Sensors, q: Quat) -> float:
    """What a range-finder that looks down says [m]; below 0: there is none, or it sees nothing."""
    if sensors.rangefinder_count == 0:
        return -1.0
    found = float(sensors.rangefinder_range[0]) * rotate(q, Vec3(0.0, 0.0, 1.0)).z
    return found if found < math.inf else -1.0


@law
def direction(t: LandingTarget, q: Quat, p: PrecisionLanding, orientation: int) -> Vec3:
    """The line of sight, NED, of a vehicle of attitude ``q``."""
    line = with_down(turned(horizontal(t.line), math.radians(0.01 * p.YAW_ALIGN)), t.line.z)
    if t.frame != BODY:
        line = mounted(line, orientation)
    return rotate(quat_from_euler(Euler(0.0, 0.0, yaw_of(q))) if t.frame == LEVEL_SENSOR else q, line)


@law
def measure(t: LandingTarget, est: Estimate, height: float, p: PrecisionLanding, orientation: int) -> bool:
    """Work out ``place`` of a new measurement; False: it reports none.

    ``height``: over the ground [m], below 0 unknown. ``orientation``: where the sensor looks.
    """
    q = attitude_then(est, p.LAG)
    line, middle = direction(t, q, p, orientation), rotate(q, axis(orientation))
    ahead = dot(line, middle)
    if ahead <= 0.0 or (t.distance <= 0.0 and height <= 0.0):
        return False
    sensor = rotate(q, Vec3(p.CAM_POS_X, p.CAM_POS_Y, p.CAM_POS_Z))
    distance = t.distance
    if distance <= 0.0:
        distance = max(height - abs(dot(sensor, middle)), 0.0) / ahead
    if distance > FAR:
        return False
    t.measured_pos = distance * line + sensor
    return True
