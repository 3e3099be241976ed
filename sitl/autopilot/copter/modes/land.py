# SPDX-License-Identifier: BSD-3-Clause
"""LAND: descends where it is, fast down to LAND_ALT_LOW and then at LAND_SPEED, until it has landed; on a target
where one is seen (PLND_*).

``precision_land.descend`` is also the last part of RTL and of AUTO's land command.
"""

from __future__ import annotations

from ....core.kernels import law
from ...arming_checks import ArmingMethod
from ...modes import ModeReason, ModeResult, ask
from ..control.spool import DesiredSpoolState, SpoolState
from ..parameters.flight_modes import Pilot
from ..state import Vehicle
from ..terrain_following import height_over_ground
from . import auto_yaw, descent, ground, precision_land
from .alt_hold import ALT_HOLD
from .loiter import LOITER
from .mode import CopterMode, never_arms, yes
from .state import LandState, PilotState

LAND = 9

PAUSE_US = 4_000_000
"""A landing that a failsafe began waits so long, for the pilot to notice."""

_CANCEL_BEHAVIOUR = 2
"""PILOT_THR_BHV: a high throttle stick cancels the landing."""
_CANCEL_THROTTLE = 0.7


@law
def start(v: Vehicle) -> int:
    """Enter; with position control when there is a position."""
    ap = v.autopilot
    descent.begin(ap.modes, v.time_us, ap.control, ap.estimate, ap.params)
    ap.modes.land.with_position = ap.estimate.position_ok
    return ModeResult.ACCEPTED


@law
def run(v: Vehicle) -> None:
    """One tick of the mode LAND."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    auto_yaw.follow_pilot(modes, control.attitude, est)
    follow_state(modes.land, v.time_us, est.position_ok)
    finish(v)
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    height = height_over_ground(v)
    if is_cancelled(modes.pilot, p.PILOT):
        ask(modes, LOITER if est.position_ok else ALT_HOLD, ModeReason.THROTTLE_LAND_ESCAPE)
    elif modes.land.with_position:
        precision_land.descend(v)
    else:
        descent.descend_blind(modes, height, ap.arming.landed_maybe, control, est, p)


@law
def follow_state(land: LandState, time_us: int, position_ok: bool) -> None:
    """The pause ends; without a position it is a landing without one to its end."""
    if land.pause and time_us - land.start_us >= PAUSE_US:
        land.pause = False
    if land.with_position and not position_ok:
        land.with_position = False


@law
def finish(v: Vehicle) -> None:
    """Disarm when landed and the motors have come down to idle."""
    ap = v.autopilot
    if ap.arming.landed and ap.control.motors.spool_state == SpoolState.GROUND_IDLE:
        ground.disarm(v, ArmingMethod.LANDING)


@law
def is_cancelled(sticks: PilotState, p: Pilot) -> bool:
    """Whether the pilot's high throttle asks for LOITER (or ALT_HOLD) instead."""
    return (int(p.THR_BHV) & _CANCEL_BEHAVIOUR) != 0 and sticks.throttle > _CANCEL_THROTTLE


MODE = CopterMode(
    number=LAND,
    name="LAND",
    start=start,
    run=run,
    standard_mode=7,
    autonomous=True,
    may_arm=never_arms,
    is_landing=yes,
)
