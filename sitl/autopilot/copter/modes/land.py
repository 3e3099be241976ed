# SPDX-License-Identifier: BSD-3-Clause
"""LAND: descends where it is, fast down to LAND_ALT_LOW and then at LAND_SPEED, until it has landed.

``descend`` is also the last part of RTL and of AUTO's land command.
"""

from __future__ import annotations

import math

from ....core.algebra import ZERO2, turned
from ....core.kernels import law
from ....core.scalars import constrain
from ....core.vectors import Vec2
from ...arming_checks import BY_LANDING
from ...control.shaping import sqrt_controller
from ...modes import ACCEPTED, REASON_THROTTLE_LAND_ESCAPE, ask
from ...state import Estimate
from .. import pilot
from ..control import altitude, attitude, position, position_start
from ..control.state import DT, AltitudeState, Control
from ..parameters import Parameters
from ..parameters.flight import Land, Pilot
from ..state import Vehicle
from . import auto_yaw, ground
from .alt_hold import ALT_HOLD
from .loiter import LOITER
from .mode import CopterMode, never_arms, yes
from .state import LandState, Modes, PilotState

LAND = 9

PAUSE_US = 4_000_000
"""A landing that a failsafe began waits so long, for the pilot to notice."""

_CANCEL_BEHAVIOUR = 2
"""PILOT_THR_BHV: a high throttle stick cancels the landing."""
_CANCEL_THROTTLE = 0.7
_REPOSITION_ACCEL = 0.5
"""The pilot's full stick is WPNAV_ACCEL times this many seconds of speed."""


@law
def start(v: Vehicle) -> int:
    """Enter; with position control when there is a position."""
    ap = v.autopilot
    begin(ap.modes, v.time_us, ap.control, ap.estimate, ap.params)
    ap.modes.land.with_position = ap.estimate.position_ok
    return ACCEPTED


@law
def begin(modes: Modes, time_us: int, control: Control, est: Estimate, p: Parameters) -> None:
    """Prepare a descent from the present motion."""
    ground.set_waypoint_limits(control, p)
    ground.continue_position_control(control, est, p)
    modes.land.start_us = time_us
    modes.land.pause = False
    modes.land.with_position = True
    auto_yaw.set_mode(modes.auto_yaw, auto_yaw.HOLD, control.attitude, est)


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
    control.motors.desired_spool = ground.UNLIMITED
    height = ap.home.pos.z - est.pos.z
    if is_cancelled(modes.pilot, p.PILOT):
        ask(modes, LOITER if est.position_ok else ALT_HOLD, REASON_THROTTLE_LAND_ESCAPE)
    elif modes.land.with_position:
        descend(modes, height, ap.arming.landed_maybe, control, est, p)
    else:
        descend_blind(modes, height, ap.arming.landed_maybe, control, est, p)


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
    if ap.arming.landed and ap.control.motors.spool_state == ground.IS_GROUND_IDLE:
        ground.disarm(v, BY_LANDING)


@law
def is_cancelled(sticks: PilotState, p: Pilot) -> bool:
    """Whether the pilot's high throttle asks for LOITER (or ALT_HOLD) instead."""
    return (int(p.THR_BHV) & _CANCEL_BEHAVIOUR) != 0 and sticks.throttle > _CANCEL_THROTTLE


@law
def descend(modes: Modes, height: float, landed_maybe: bool, control: Control, est: Estimate, p: Parameters) -> None:
    """One tick of a landing with position control from ``height`` above home [m].

    The sticks move the landing place (LAND_REPOSITION).
    """
    vel = stick_velocity(modes.pilot, est.yaw, p)
    if landed_maybe:
        position_start.soften_for_landing_ne(control.pos_ne, est.pos)
    position.input_vel_accel_ne(control.pos_ne, vel, ZERO2)
    sink(control.pos_d, modes.land, height, landed_maybe, p)
    ground.fly(modes.auto_yaw, control, est, p)


@law
def descend_blind(
    modes: Modes, height: float, landed_maybe: bool, control: Control, est: Estimate, p: Parameters
) -> None:
    """One tick of a landing without a position, from ``height`` above home [m]: the sticks lean the vehicle."""
    lean = attitude.Lean(0.0, 0.0)
    if p.LAND.REPOSITION != 0.0:
        lean_max = math.radians(p.ANGLE_MAX * 0.01)
        lean = pilot.lean_angles(modes.pilot, lean_max, lean_max)
    sink(control.pos_d, modes.land, height, landed_maybe, p)
    altitude.update_d(control, est, p)
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, lean, modes.pilot.yaw_rate)


@law
def sink_rate(height: float, limits: AltitudeState, p: Land, pos_p: float) -> float:
    """Descent [m/s] at a height above home [m]: fast above LAND_ALT_LOW, then LAND_SPEED.

    ``pos_p``: gain of the position loop [1/s].
    """
    slow = abs(p.SPEED) * 0.01
    fast = p.SPEED_HIGH * 0.01
    if fast <= 0.0:
        fast = limits.speed_down
    fast = max(fast, slow)
    return constrain(sqrt_controller(height - height_low(p), pos_p, limits.accel_max, DT), slow, fast)


@law
def height_low(p: Land) -> float:
    """LAND_ALT_LOW, at least a metre [m]."""
    return max(p.ALT_LOW * 0.01, 1.0)


@law
def sink(path: AltitudeState, land: LandState, height: float, landed_maybe: bool, p: Parameters) -> None:
    """Descent of this tick, from ``height`` above home [m]."""
    if land.pause:
        altitude.land_at_rate_d(path, 0.0, False)
        return
    near_ground = height < height_low(p.LAND) or landed_maybe
    altitude.land_at_rate_d(path, sink_rate(height, path, p.LAND, p.PSC.POSZ_P), near_ground)


@law
def stick_velocity(sticks: PilotState, yaw: float, p: Parameters) -> Vec2:
    """North and east [m/s] that the sticks ask for at heading ``yaw`` [rad]; zero without LAND_REPOSITION."""
    if p.LAND.REPOSITION == 0.0 or (sticks.roll == 0.0 and sticks.pitch == 0.0):
        return Vec2(0.0, 0.0)
    speed_max = p.WPNAV.ACCEL * 0.01 * _REPOSITION_ACCEL
    forward_right = pilot.limit_stick(Vec2(-sticks.pitch * speed_max, sticks.roll * speed_max), speed_max)
    return turned(forward_right, yaw)


MODE = CopterMode(
    number=LAND,
    name="LAND",
    start=start,
    run=run,
    standard_mode=7,
    uses_position=True,
    autonomous=True,
    may_arm=never_arms,
    is_landing=yes,
)
