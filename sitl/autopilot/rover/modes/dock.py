# SPDX-License-Identifier: BSD-3-Clause
"""DOCK: drives to a target that its sensor sees (PLND_*, DOCK_*), and stops shortly before it."""

from __future__ import annotations

import math

from ....core.algebra import direction, dot2, horizontal, norm2, turned
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...events import Event, emit
from ...landing_target.estimator import target_position
from ...modes import ModeResult
from ..control import position, speed
from ..control.steering import lat_accel_max
from ..parameters import Parameters
from ..state import Vehicle
from . import drive
from .mode import POSITION_TO_HOLD, Destination, RoverMode
from .state import Modes

DOCK = 8

NO_TARGET, NO_DIRECTION, ARRIVED = 0, 1, 2
"""What DOCK_DID says."""
_TEXTS: dict[int, str | tuple[int, str]] = {
    NO_TARGET: "Dock: target not acquired",
    NO_DIRECTION: "Dock: Set DOCK_DIR or disable heading correction",
    ARRIVED: (MavSeverity.INFO, "Dock: Docking complete"),
}
DOCK_DID = Event(62, MavSeverity.NOTICE, _TEXTS)
BACK = 4
"""PLND_ORIENT of a sensor that looks back: the vehicle docks in reverse."""
LAST_PART = 3.0
"""So near [m] the dock must be seen, and the path is straight."""
SLOWEST = 0.5
"""A vehicle that is not in line with the dock is no slower than this [m/s]."""
ASIDE_MAX = 0.2
"""Distance of the dock from the line ahead [m] that counts as wholly out of line."""
SLOW_FROM, SLOW_TO = 15.0, 5.0
"""Distances from the dock [m] between which being out of line comes to count."""


@law
def start(v: Vehicle) -> int:
    """Enter: the dock must be seen, and its direction be known where it is to be entered from there."""
    ap = v.autopilot
    p, control = ap.params, ap.control
    if p.PLND.ENABLED == 0.0 or not ap.landing_target.acquired:
        emit(ap.events, v.time_us, DOCK_DID, float(NO_TARGET), 0.0)
        return ModeResult.INIT_FAILED
    if p.DOCK.HDG_CORR_EN != 0.0 and p.DOCK.DIR < 0.0:
        emit(ap.events, v.time_us, DOCK_DID, float(NO_DIRECTION), 0.0)
        return ModeResult.INIT_FAILED
    accel = p.ATC.ACCEL_MAX
    speed_max = p.DOCK.SPEED if p.DOCK.SPEED > 0.0 else p.WP.SPEED
    position.set_limits(control.position, speed_max, accel, lat_accel_max(p.ATC), accel)
    position.init(control.position, ap.estimate)
    control.position.reversed = int(p.PLND.ORIENT) == BACK
    ap.modes.dock.done = False
    return ModeResult.ACCEPTED


@law
def run(v: Vehicle) -> None:
    """One period."""
    ap = v.autopilot
    dock, t, control, p = ap.modes.dock, ap.landing_target, ap.control, ap.params
    if t.acquired:
        dock.pos = target_position(t, ap.estimate)
    away = dock.pos - horizontal(ap.estimate.pos)
    if not dock.done and ap.estimate.position_ok:
        dock.distance = norm2(away)
        if dock.distance <= p.DOCK.STOP_DIST or (dock.distance < LAST_PART and not t.acquired):
            dock.done = True
            emit(ap.events, v.time_us, DOCK_DID, float(ARRIVED), 0.0)
    if dock.done or not ap.estimate.position_ok:
        speed.stop(control, ap.arming.armed, p)
        return
    position.input_pos(control.position, dock.pos - lead_in(away, dock.distance, p))
    position.follow_target(control, ap.estimate, ap.arming.armed, p)
    drive.turn(control, ap.estimate, ap.modes.pilot, control.position.desired_turn_rate, p)
    aside = turned(away, -ap.estimate.yaw).y
    drive.on_path(v, slowed(control.position.desired_speed, aside, dock.distance))


@law
def lead_in(away: Vec2, distance: float, p: Parameters) -> Vec2:
    """How far before the dock the vehicle aims, towards a dock ``away`` [m] from it: the line of DOCK_DIR."""
    if p.DOCK.HDG_CORR_EN == 0.0 or distance < LAST_PART:
        return Vec2(0.0, 0.0)
    heading = math.radians(p.DOCK.DIR)
    line = direction(heading)
    return p.DOCK.HDG_CORR_WT * abs(dot2(away, line)) * line


@law
def slowed(wanted: float, aside: float, distance: float) -> float:
    """A speed [m/s] as it suits a dock ``aside`` of the line ahead [m] at a ``distance`` [m]."""
    if abs(wanted) < SLOWEST:
        return wanted
    out_of_line = min(abs(aside) / ASIDE_MAX, 1.0)
    weight = constrain(1.0 - (distance - SLOW_TO) / (SLOW_FROM - SLOW_TO), 0.0, 1.0)
    return math.copysign(max(SLOWEST, abs(wanted) * (1.0 - out_of_line * weight)), wanted)


@law
def destination(modes: Modes) -> Destination:
    """The dock."""
    return Destination(POSITION_TO_HOLD, modes.dock.pos)


MODE = RoverMode(
    number=DOCK,
    name="DOCK",
    start=start,
    run=run,
    needs_position=True,
    autonomous=True,
    destination=destination,
)
