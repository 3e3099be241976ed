# SPDX-License-Identifier: BSD-3-Clause
"""Another vehicle, as FOLLOW knows it: its reports, and a smooth motion through them.

Between reports the lead is taken to go on as it said; the motion that is followed comes to that within FOLL_ACCEL_* and
FOLL_JERK_*. A report too far from it starts it anew.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..core.algebra import ZERO, horizontal, norm, norm2, turned, with_down
from ..core.kernels import law
from ..core.mavlink import MavSeverity
from ..core.scalars import wrap_pi
from ..core.vectors import Vec2, Vec3
from .control.shaping import (
    Limits,
    Limits2,
    Motion,
    Motion2,
    advance,
    advance_2d,
    shape_pos_vel_accel,
    shape_pos_vel_accel_2d,
)
from .events import Event
from .params.follow_parameters import Follow
from .state import FollowState

FORGET_US = 10_000_000
"""And after so long, another one may be taken (FOLL_SYSID 0)."""
RELATIVE = 1
"""FOLL_OFS_TYPE: offsets turn with the lead."""
_STILL = Vec2(0.0, 0.0)

FOLLOW_OFFSET = Event(42, MavSeverity.INFO, {0: "N-E-D follow offset loaded", 1: "Relative follow offset loaded"})
FOLLOW_OFF = Event(43, MavSeverity.WARNING, "Set FOLL_ENABLE = 1")


class Report(NamedTuple):
    """What a vehicle says of itself."""

    pos: Vec3  # NED from the origin [m]
    vel: Vec3  # [m/s]
    acc: Vec3  # [m/s^2]
    has_heading: bool
    heading: float  # [rad]
    heading_rate: float  # [rad/s]


@law
def is_lead(lead: FollowState, p: Follow, sender: int, time_us: int) -> bool:
    """Whether reports of system id ``sender`` are taken."""
    if p.ENABLE == 0.0:
        return False
    if p.SYSID != 0.0:
        return sender == int(p.SYSID)
    return lead.sender in (0, sender) or time_us - lead.update_us > FORGET_US


@law
def take(lead: FollowState, p: Follow, sender: int, report: Report, time_us: int) -> None:
    """Note a report of the lead. One without heading is of no use where offsets turn with the lead."""
    if p.OFS_TYPE == RELATIVE and not report.has_heading:
        return
    if sender != lead.sender or time_us - lead.update_us > FORGET_US:
        lead.is_known = lead.sends_more = False
    lead.sender, lead.update_us = sender, time_us
    lead.received_pos, lead.received_vel, lead.received_acc = report.pos, report.vel, report.acc
    if report.has_heading:
        lead.received_heading, lead.received_heading_rate = report.heading, report.heading_rate
    else:
        lead.received_heading_rate = 0.0
    if lead.is_known and is_far(lead, p):
        lead.is_known = False


@law
def velocity_change_max(accel_max: float, jerk_max: float, timeout: float) -> float:
    """Largest change of velocity within the time of silence that is borne [s], at these limits."""
    rise = accel_max / jerk_max
    if timeout >= 2.0 * rise:
        return accel_max * (timeout - rise)
    return 0.125 * jerk_max * timeout * timeout


@law
def is_far(lead: FollowState, p: Follow) -> bool:
    """Whether the motion that is followed is too far from the last report to come to it soon."""
    if not is_shaped(p):
        return False
    pos, vel = lead.pos - lead.received_pos, lead.vel - lead.received_vel
    time = 0.5 * p.TIMEOUT
    if norm2(horizontal(pos)) > p.ACCEL_NE * time * time or abs(pos.z) > p.ACCEL_D * time * time:
        return True
    if norm2(horizontal(vel)) > velocity_change_max(p.ACCEL_NE, p.JERK_NE, p.TIMEOUT):
        return True
    return abs(vel.z) > velocity_change_max(p.ACCEL_D, p.JERK_D, p.TIMEOUT)


@law
def is_shaped(p: Follow) -> bool:
    """Whether the limits are given."""
    return min(p.ACCEL_NE, p.JERK_NE, p.ACCEL_D) > 0.0 and min(p.JERK_D, p.ACCEL_H, p.JERK_H) > 0.0


@law
def follow(lead: FollowState, p: Follow, pos: Vec3, time_us: int, dt: float) -> bool:
    """One period of ``dt`` [s] of a vehicle at ``pos`` [m]: the lead's motion now; False: there is none to follow."""
    if p.ENABLE == 0.0 or lead.update_us == 0 or time_us - lead.update_us > p.TIMEOUT * 1e6:
        lead.is_known = False
        return False
    age = (time_us - lead.update_us) * 1e-6
    received_pos = lead.received_pos + (lead.received_vel + 0.5 * lead.received_acc * age) * age
    received_vel = lead.received_vel + lead.received_acc * age
    heading = lead.received_heading + lead.received_heading_rate * age
    if lead.is_known and is_shaped(p):
        shape(lead, p, Motion2(horizontal(received_pos), horizontal(received_vel), horizontal(lead.received_acc)), dt)
        shape_height(lead, p, Motion(received_pos.z, received_vel.z, lead.received_acc.z), dt)
        shape_heading(lead, p, heading, dt)
    else:
        lead.pos, lead.vel, lead.acc = received_pos, received_vel, lead.received_acc
        lead.heading, lead.heading_rate, lead.heading_acc = wrap_pi(heading), lead.received_heading_rate, 0.0
    lead.is_known = p.DIST_MAX <= 0.0 or norm(lead.received_pos - pos) <= p.DIST_MAX
    return lead.is_known


@law
def shape(lead: FollowState, p: Follow, reported: Motion2, dt: float) -> None:
    """Horizontal motion."""
    now = Motion2(horizontal(lead.pos), horizontal(lead.vel), horizontal(lead.acc))
    now = advance_2d(now, dt, _STILL, _STILL, _STILL)
    acc = shape_pos_vel_accel_2d(reported, now, Limits2(0.0, p.ACCEL_NE, p.JERK_NE), dt)
    lead.pos, lead.vel = with_down(now.pos, lead.pos.z), with_down(now.vel, lead.vel.z)
    lead.acc = with_down(acc, lead.acc.z)


@law
def shape_height(lead: FollowState, p: Follow, reported: Motion, dt: float) -> None:
    """Vertical motion."""
    now = advance(Motion(lead.pos.z, lead.vel.z, lead.acc.z), dt, 0.0, 0.0, 0.0)
    acc = shape_pos_vel_accel(reported, now, Limits(0.0, 0.0, -p.ACCEL_D, p.ACCEL_D, p.JERK_D), dt)
    lead.pos, lead.vel = with_down(horizontal(lead.pos), now.pos), with_down(horizontal(lead.vel), now.vel)
    lead.acc = with_down(horizontal(lead.acc), acc)


@law
def shape_heading(lead: FollowState, p: Follow, heading: float, dt: float) -> None:
    """Heading."""
    now = advance(Motion(lead.heading, lead.heading_rate, lead.heading_acc), dt, 0.0, 0.0, 0.0)
    reported = Motion(now.pos + wrap_pi(heading - now.pos), lead.received_heading_rate, 0.0)
    accel_max, jerk_max = math.radians(p.ACCEL_H), math.radians(p.JERK_H)
    acc = shape_pos_vel_accel(reported, now, Limits(0.0, 0.0, -accel_max, accel_max, jerk_max), dt)
    lead.heading, lead.heading_rate, lead.heading_acc = wrap_pi(now.pos), now.vel, acc


@law
def offset(lead: FollowState, p: Follow) -> Vec3:
    """Position beside the lead, NED [m]."""
    given = Vec3(p.OFS_X, p.OFS_Y, p.OFS_Z)
    if lead.keeps_distance:
        given = lead.distance
    return with_down(turned(horizontal(given), lead.heading), given.z) if p.OFS_TYPE == RELATIVE else given


@law
def keep_distance(lead: FollowState, p: Follow, pos: Vec3) -> bool:
    """Without offsets, the position beside the lead is where the vehicle at ``pos`` [m] is now; True:
    it has become so."""
    if lead.keeps_distance or p.OFS_X != 0.0 or p.OFS_Y != 0.0 or p.OFS_Z != 0.0:
        return False
    away = pos - lead.received_pos
    turns = p.OFS_TYPE == RELATIVE
    lead.distance = with_down(turned(horizontal(away), -lead.heading), away.z) if turns else away
    lead.keeps_distance = True
    return True


@law
def begin(lead: FollowState) -> None:
    """FOLLOW begins."""
    lead.is_known, lead.keeps_distance, lead.distance = False, False, ZERO
