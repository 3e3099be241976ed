# SPDX-License-Identifier: BSD-3-Clause
"""Another system's position, heading and velocity, as a companion sends them (VISO_*)."""

from __future__ import annotations

import math

from ..core.algebra import norm
from ..core.kernels import law
from ..core.records import Record
from ..core.scalars import finite
from ..core.vectors import Quat, Vec3
from .params.without_gps import VisualOdometry as Settings

MAVLINK = 1
"""VISO_TYPE"""
SILENT_US = 300_000
"""A system that says nothing for so long has failed."""
UNKNOWN_QUALITY = 0
FAR, FAST = 100_000.0, 500.0
"""A position further from its origin [m] or a greater velocity [m/s] is nonsense."""
MOST = 100.0
"""Greatest standard deviation that a message can tell [m, m/s]."""


class Pose(Record):
    """Where the vehicle is."""

    count: int  # reported so far
    time_us: int  # when the last one came
    pos: Vec3  # NED [m]
    q: Quat  # body to NED
    sigma: float  # standard deviation of the position [m]


class Velocity(Record):
    """How fast it moves."""

    count: int
    time_us: int
    vel: Vec3  # NED [m/s], or on the body
    on_body: bool
    sigma: float  # [m/s]


class VisualOdometry(Record):
    """What another system reported last."""

    kind: int  # VISO_TYPE at power-on, where there is such a system; 0 none
    pose: Pose
    velocity: Velocity
    resets: int  # its reset counter: it jumps when it counts
    quality: int  # -1 failed, 0 unknown, 1 .. 100


def power_on(seen: VisualOdometry, p: Settings) -> None:
    """VISO_TYPE chooses the system now, and until the next power-on."""
    seen.kind = int(p.TYPE) if int(p.TYPE) == MAVLINK else 0


@law
def is_healthy(seen: VisualOdometry, time_us: int) -> bool:
    """Whether there is a system that has said something of late."""
    return seen.kind != 0 and time_us - max(seen.pose.time_us, seen.velocity.time_us) < SILENT_US


@law
def takes(seen: VisualOdometry, quality: int, p: Settings) -> bool:
    """Whether a message of this quality is believed (VISO_QUAL_MIN); notes it."""
    seen.quality = quality
    return seen.kind != 0 and (p.QUAL_MIN <= 0.0 or quality >= p.QUAL_MIN)


@law
def sigma_of(variance: float, least: float) -> float:
    """Standard deviation of a variance in a message, at least ``least``; one that is not known counts as that."""
    if not (finite(variance) and variance > 0.0):
        return least
    return min(max(math.sqrt(variance), least), MOST)


@law
def take_pose(seen: VisualOdometry, pos: Vec3, q: Quat, variance: float, time_us: int, p: Settings) -> None:
    """Take a position NED [m], scaled by VISO_SCALE, and an attitude; nonsense is passed over."""
    pos = p.SCALE * pos
    if not norm(pos) <= FAR:
        return
    pose = seen.pose
    pose.pos, pose.q = pos, q
    pose.sigma = sigma_of(variance, p.POS_M_NSE)
    pose.time_us = time_us
    pose.count += 1


@law
def take_velocity(seen: VisualOdometry, vel: Vec3, on_body: bool, variance: float, time_us: int, p: Settings) -> None:
    """Take a velocity [m/s], NED or on the body; nonsense is passed over."""
    if not norm(vel) <= FAST:
        return
    velocity = seen.velocity
    velocity.vel, velocity.on_body = vel, on_body
    velocity.sigma = sigma_of(variance, p.VEL_M_NSE)
    velocity.time_us = time_us
    velocity.count += 1
