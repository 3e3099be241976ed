# SPDX-License-Identifier: BSD-3-Clause
"""THROW: armed in the hand with motors off; after a throw it starts the motors, levels, stops and hovers.

THROW_TYPE 1: dropped, not thrown. It must be within THROW_ALT_MIN and THROW_ALT_MAX. In the air it climbs by
THROW_ALT_ACSND, or sinks by THROW_ALT_DCSND when dropped, stops, and goes on with THROW_NEXTMODE.
"""

from __future__ import annotations

import math

from ....core.algebra import norm2, rotate
from ....core.constants import GRAVITY
from ....core.elementary import cos
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.vectors import Vec2, Vec3
from ...control.shaping import Motion
from ...events import Event, emit
from ...modes import ModeReason, ModeResult, ask
from ...state import Estimate
from ..control import altitude, altitude_start, attitude, position, position_start, throttle_mix
from ..control.spool import DesiredSpoolState, SpoolState
from ..control.state import Control
from ..parameters import Parameters
from ..parameters.flight_modes import Throw
from ..state import Vehicle
from . import ground
from .auto import AUTO
from .brake import BRAKE, DECELERATION, SPEED_D
from .guided import GUIDED
from .land import LAND
from .loiter import LOITER
from .mode import CopterMode
from .rtl import RTL
from .state import ThrowState

THROW = 18

# Stages (``ThrowState.stage``)
DISARMED = 0
WAITING = 1
SPOOLING_UP = 2
UPRIGHTING = 3
TO_HEIGHT = 4
STOPPING = 5

_TEXTS = {
    WAITING: "waiting for throw",
    SPOOLING_UP: "throw detected - spooling motors",
    UPRIGHTING: "throttle is unlimited - uprighting",
    TO_HEIGHT: "uprighted - controlling height",
    STOPPING: "height achieved - controlling position",
}
THROW_STAGE = Event(33, MavSeverity.INFO, _TEXTS)  # a: stage

NEXT_MODES = (AUTO, GUIDED, LOITER, RTL, LAND, BRAKE)
"""THROW_NEXTMODE: any other stays in THROW."""

# Thresholds: ArduPilot's
_HIGH_SPEED = 5.0  # [m/s]
_VERTICAL_SPEED = 0.5  # [m/s]
_FALLING = 0.25  # less than this of gravity is felt
_CONFIRM_US = 500_000
_CONFIRM_SPEED = 2.5  # lost upwards within that time [m/s]
_UPRIGHT = cos(math.radians(30.0))
_NEAR = 0.5  # [m]
_HALF_THROTTLE = 0.5


@law
def start(v: Vehicle) -> int:
    """Enter, disarmed."""
    ap = v.autopilot
    if ap.arming.armed:
        return ModeResult.INIT_FAILED
    ap.modes.throw.stage = DISARMED
    ap.modes.throw.released_us = 0
    ap.modes.throw.passed_on = False
    return ModeResult.ACCEPTED


@law
def may_be_thrown(est: Estimate, height: float, p: Throw) -> bool:
    """Whether this tick looks like a throw: falls freely or fast, in the right direction, and nothing holds it.

    ``height``: above home [m].
    """
    felt = Vec3(est.acc_ned.x, est.acc_ned.y, est.acc_ned.z - GRAVITY)
    released = felt.x * felt.x + felt.y * felt.y + felt.z * felt.z < GRAVITY * GRAVITY
    vel = est.vel
    fast = vel.x * vel.x + vel.y * vel.y + vel.z * vel.z > _HIGH_SPEED * _HIGH_SPEED
    moves = vel.z > _VERTICAL_SPEED if p.TYPE >= 1.0 else vel.z < -_VERTICAL_SPEED
    above = p.ALT_MIN <= 0.0 or height > p.ALT_MIN
    below = p.ALT_MAX <= 0.0 or height < p.ALT_MAX
    return (felt.z > -_FALLING * GRAVITY or fast) and moves and released and above and below


@law
def is_thrown(state: ThrowState, est: Estimate, time_us: int, height: float, p: Throw) -> bool:
    """Whether it was thrown: what looks like it goes on as a fall; ``height``: above home [m]."""
    if state.released_us == 0 or time_us - state.released_us > _CONFIRM_US:
        if may_be_thrown(est, height, p):
            state.released_us = time_us
            state.released_speed = est.vel.z
    within = state.released_us != 0 and time_us - state.released_us < _CONFIRM_US
    return within and est.vel.z - state.released_speed > _CONFIRM_SPEED


@law
def begin_climb(state: ThrowState, control: Control, est: Estimate, p: Parameters) -> None:
    """Upright: fly to the height to stop at."""
    altitude_start.set_max_speed_accel_d(control.pos_d, p.PSC, SPEED_D, SPEED_D, DECELERATION)
    altitude_start.init_d(control, est, p)
    change = -p.THROW.ALT_DCSND if p.THROW.TYPE >= 1.0 else p.THROW.ALT_ACSND
    state.target_d = est.pos.z - change


@law
def begin_stop(control: Control, est: Estimate, p: Parameters) -> None:
    """At its height: stop over the ground."""
    legs = p.WPNAV
    position_start.set_max_speed_accel_ne(control.pos_ne, p, legs.SPEED * 0.01, legs.ACCEL * 0.01)
    position_start.init_ne(control, est, p)


@law
def next_stage(v: Vehicle) -> int:
    """The stage that follows when its condition is met, else the present one; prepares what it needs."""
    ap = v.autopilot
    state, control, est, p = ap.modes.throw, ap.control, ap.estimate, ap.params
    if not ap.arming.armed:
        return DISARMED
    if state.stage == DISARMED:
        return WAITING
    if state.stage == WAITING:
        located = est.attitude_ok and est.position_ok
        if located and is_thrown(state, est, v.time_us, ap.home.pos.z - est.pos.z, p.THROW):
            ground.set_landed(ap.arming, False)
            return SPOOLING_UP
    elif state.stage == SPOOLING_UP:
        if control.motors.spool_state == SpoolState.THROTTLE_UNLIMITED:
            return UPRIGHTING
    elif state.stage == UPRIGHTING:
        if rotate(est.q, Vec3(0.0, 0.0, 1.0)).z > _UPRIGHT:
            begin_climb(state, control, est, p)
            ap.arming.auto_armed = True
            return TO_HEIGHT
    elif state.stage == TO_HEIGHT and est.pos.z - state.target_d < _NEAR:
        begin_stop(control, est, p)
        return STOPPING
    return state.stage


@law
def idle(v: Vehicle, spool: int) -> None:
    """One tick without thrust: the controllers follow the vehicle; the motors go to a ``spool`` state."""
    control = v.autopilot.control
    control.motors.desired_spool = spool
    attitude.relax(control, v.autopilot.estimate)
    throttle_mix.set_throttle_out(control, v.autopilot.params, 0.0, False, v.autopilot.params.PILOT.THR_FILT)


@law
def fly(v: Vehicle, stage: int) -> None:
    """One tick of a stage in the air."""
    ap = v.autopilot
    control, est, p = ap.control, ap.estimate, ap.params
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if stage == UPRIGHTING:
        throttle_mix.set_throttle_out(control, p, _HALF_THROTTLE, False, p.PILOT.THR_FILT)
    elif stage == TO_HEIGHT:
        # the target is given outright, not approached softly: it fell
        altitude.set_pos_vel_accel_d(control.pos_d, Motion(ap.modes.throw.target_d, 0.0, 0.0))
        altitude.update_d(control, est, p)
    else:
        ground.brake(control)
        position.update_ne(control, est, p)
        altitude.update_d(control, est, p)
        attitude.input_thrust_vector_heading_rate(control, est, p, position.thrust_vector(control.pos_ne), 0.0)
        return
    attitude.input_euler_roll_pitch_yaw_rate(control, est, p, attitude.Lean(0.0, 0.0), 0.0)


@law
def pass_on(v: Vehicle) -> None:
    """Stopped over a position: ask for the next mode, once."""
    ap = v.autopilot
    state, error = ap.modes.throw, ap.control.pos_ne.pos_error
    if not state.passed_on and norm2(Vec2(error.x, error.y)) < _NEAR:
        state.passed_on = True
        number = int(ap.params.THROW.NEXTMODE)
        if number in NEXT_MODES:
            ask(ap.modes, number, ModeReason.THROW_COMPLETE)


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    state = ap.modes.throw
    stage = next_stage(v)
    if stage != state.stage and stage != DISARMED:
        emit(ap.events, v.time_us, THROW_STAGE, float(stage), 0.0)
    state.stage = stage
    if stage <= WAITING:
        idle(v, DesiredSpoolState.GROUND_IDLE if ap.params.THROW.MOT_START >= 1.0 else DesiredSpoolState.SHUT_DOWN)
    elif stage == SPOOLING_UP:
        idle(v, DesiredSpoolState.THROTTLE_UNLIMITED)
    else:
        fly(v, stage)
        if stage == STOPPING:
            pass_on(v)


MODE = CopterMode(number=THROW, name="THROW", start=start, run=run, needs_position=True, idles_armed=True)
