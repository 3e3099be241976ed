# SPDX-License-Identifier: BSD-3-Clause
"""FOLLOW: follows another vehicle by its position messages (FOLL_*); stops without them."""

from __future__ import annotations

from ....core.algebra import horizontal, norm2
from ....core.elementary import atan2
from ....core.kernels import law
from ....core.vectors import Vec2
from ... import followed_vehicle as lead_motion
from ...events import emit
from ...followed_vehicle import FOLLOW_OFF, FOLLOW_OFFSET
from ...modes import ModeResult
from .. import pilot
from ..control import speed
from ..control.state import DT
from ..state import Vehicle
from . import drive
from .mode import RoverMode

FOLLOW = 6


@law
def start(v: Vehicle) -> int:
    """Enter: FOLL_ENABLE must be set."""
    ap = v.autopilot
    if ap.params.FOLL.ENABLE == 0.0:
        emit(ap.events, v.time_us, FOLLOW_OFF, 0.0, 0.0)
        return ModeResult.INIT_FAILED
    lead_motion.begin(ap.modes.follow)
    return ModeResult.ACCEPTED


@law
def limited(vel: Vec2, speed_max: float) -> Vec2:
    """A velocity of at most ``speed_max`` [m/s]."""
    length = norm2(vel)
    return vel * (speed_max / length) if length > speed_max else vel


@law
def run(v: Vehicle) -> None:
    """One period: the lead's velocity, and more the further away its side is."""
    ap = v.autopilot
    lead, control, p, pos = ap.modes.follow, ap.control, ap.params, ap.estimate.pos
    if not lead_motion.follow(lead, p.FOLL, pos, v.time_us, DT):
        speed.stop(control, ap.arming.armed, p)
        return
    if lead_motion.keep_distance(lead, p.FOLL, pos):
        emit(ap.events, v.time_us, FOLLOW_OFFSET, p.FOLL.OFS_TYPE, 0.0)
    away = horizontal(lead.pos + lead_motion.offset(lead, p.FOLL) - pos)
    wanted = limited(horizontal(lead.vel) + p.FOLL.POS_P * away, p.WP.SPEED)
    if wanted.x == 0.0 and wanted.y == 0.0:
        speed.stop(control, ap.arming.armed, p)
        return
    drive.turn_to(control, ap.estimate, ap.modes.pilot, atan2(wanted.y, wanted.x), p)
    drive.at_speed(v, pilot.nudged(ap.modes.pilot, norm2(wanted), p))


MODE = RoverMode(number=FOLLOW, name="FOLLOW", start=start, run=run, needs_position=True, autonomous=True)
