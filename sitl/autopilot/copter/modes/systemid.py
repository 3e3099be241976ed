# SPDX-License-Identifier: BSD-3-Clause
"""SYSTEMID: STABILIZE, or holding its position, with an added chirp, for system identification (SID_*).

SID_AXIS says what the chirp is added to: 1 to 3 the roll, pitch [deg] and turn rate [deg/s] that the sticks ask for,
4 to 6 the same without feed-forward, 7 to 9 the body rates asked for [deg/s], 10 to 12 the motors' demands and 13 the
throttle [-1 .. 1]; 14 and 15 the position measured, to the right and forward [m], 16 and 17 the velocity [m/s], 18 and
19 the velocity asked for [m/s]. It begins a second after the mode, and is logged in SIDS and SIDD.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from ....core.algebra import turned
from ....core.elementary import acos, cos, exp, log, sin
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.vectors import Vec2, Vec3
from ...control.shaping import Motion2
from ...events import Event, Row, emit
from ...modes import ModeResult
from ...notes import Text
from .. import pilot
from ..control import altitude, attitude, position, throttle_mix
from ..control.spool import DesiredSpoolState
from ..control.state import DT
from ..parameters.flight_modes import SystemId
from ..state import Vehicle
from . import alt_hold, ground, stabilize
from .acro import ACRO
from .loiter import LOITER
from .mode import CopterMode, never_arms
from .stabilize import STABILIZE
from .state import SystemIdState

SYSTEMID = 25

# SID_AXIS
ROLL, PITCH, YAW = 1, 2, 3
WITHOUT_FF_ROLL, WITHOUT_FF_PITCH, WITHOUT_FF_YAW = 4, 5, 6
RATE_ROLL, RATE_YAW = 7, 9
MOTORS_ROLL, MOTORS_YAW = 10, 12
THROTTLE = 13
POSITION_RIGHT, POSITION_FORWARD, VELOCITY_RIGHT, VELOCITY_FORWARD, SPEED_RIGHT, SPEED_FORWARD = range(14, 20)

# What it reports (SYSTEM_ID_DID)
STARTED = 0  # and the axis
FINISHED = 1
LANDED = 2
LEANS = 3  # and how far [deg]
NO_AXIS = 4
BAD_PARAMETERS = 5
REFUSED_NO_AXIS, REFUSED_ON_GROUND, REFUSED_AUTOMATIC, REFUSED_BY_SPEED = 6, 7, 8, 9

REFUSALS = {
    REFUSED_NO_AXIS: "No axis selected, SID_AXIS = 0",
    REFUSED_ON_GROUND: "Aircraft must be flying",
    REFUSED_AUTOMATIC: "Axis requires manual throttle",
    REFUSED_BY_SPEED: "Axis requires switch from Loiter",
}
"""Status texts (MAV_SEVERITY_WARNING)."""

DELAY = 1.0
"""From the mode's begin to the chirp's [s]."""
SAMPLE_TICKS = 4


class Chirp(NamedTuple):
    """A sine whose frequency rises."""

    magnitude: float
    first: float  # frequency at the start [rad/s]
    last: float  # and at the end
    constant: float  # so long at the first frequency [s]
    fade_in: float  # [s]
    length: float  # [s], with all of it
    fade_out: float  # [s]


def text(did: int, number: float, lean_max: float) -> str:
    """Status text of SYSTEM_ID_DID; ``lean_max`` [deg]."""
    endings = {
        LANDED: "Stopped: Landed",
        LEANS: f"Stopped: lean={number:f} max={lean_max:f}",
        FINISHED: "Finished",
        NO_AXIS: "Stopped: axis = 0",
        BAD_PARAMETERS: "Parameter Error",
        STARTED: f"Starting: axis={number:.0f}",
    }
    return REFUSALS[did] if did in REFUSALS else f"SystemID {endings[did]}"


def _texts(v: Any, did: float, number: float) -> list[Text]:
    said = text(int(did), number, v.autopilot.params.ANGLE_MAX * 0.01)
    return [Text(MavSeverity.WARNING if int(did) in REFUSALS else MavSeverity.INFO, said)]


def _settings(v: Any, did: float, number: float) -> list[Row]:
    p = v.autopilot.params.SID
    chirp = (p.MAGNITUDE, p.F_START_HZ, p.F_STOP_HZ, p.T_FADE_IN, chirp_of(p).constant, p.T_REC, p.T_FADE_OUT)
    return [("SIDS", (int(p.AXIS), *chirp))] if did == STARTED else []


def _sample(v: Any, a: float, b: float) -> list[Row]:
    state, rates, acc = v.autopilot.modes.systemid, v.autopilot.estimate.rates, v.sensors.acc
    chirp = (state.time, state.value, state.frequency / (2.0 * math.pi))
    return [("SIDD", (*chirp, *(math.degrees(x) for x in rates), *acc))]


SYSTEM_ID_DID = Event(52, says=_texts, log=_settings)  # a: what, b: a number of it
SYSTEM_ID_SAMPLE = Event(53, log=_sample)


@law
def chirp_of(p: SystemId) -> Chirp:
    """The chirp that the parameters ask for: two periods of the first frequency, then the sweep."""
    constant = 2.0 / p.F_START_HZ if p.F_START_HZ > 0.0 else 0.0
    first, last = 2.0 * math.pi * p.F_START_HZ, 2.0 * math.pi * p.F_STOP_HZ
    return Chirp(p.MAGNITUDE, first, last, constant, p.T_FADE_IN, p.T_REC, p.T_FADE_OUT)


@law
def is_possible(c: Chirp) -> bool:
    """Whether there is such a chirp."""
    return c.first > 0.0 and c.last > 0.0 and c.fade_in >= 0.0 and c.fade_out >= 0.0 and c.length > c.constant


@law
def loudness(c: Chirp, t: float) -> float:
    """Share of the magnitude at time ``t`` [s]: raised cosines at both ends."""
    left = c.length - t
    if t <= 0.0 or left < 0.0:
        return 0.0
    if t <= c.fade_in:
        return 0.5 - 0.5 * cos(math.pi * t / c.fade_in)
    return 0.5 - 0.5 * cos(math.pi * left / c.fade_out) if left < c.fade_out else 1.0


@law
def frequency(c: Chirp, t: float) -> float:
    """[rad/s] at time ``t`` [s]: it rises exponentially."""
    if t <= c.constant:
        return c.first
    return c.first * exp(log(c.last / c.first) * min((t - c.constant) / (c.length - c.constant), 1.0))


@law
def phase(c: Chirp, t: float) -> float:
    """Of the sine at time ``t`` [rad]: the integral of the frequency, zero where the sweep begins."""
    growth = log(c.last / c.first)
    if t <= c.constant or growth == 0.0:
        return c.first * (t - c.constant)
    return (frequency(c, t) - c.first) * (c.length - c.constant) / growth


@law
def value(c: Chirp, t: float) -> float:
    """The chirp at time ``t`` [s]."""
    return loudness(c, t) * c.magnitude * sin(phase(c, t))


@law
def report(v: Vehicle, did: int, number: float) -> None:
    """Report what it did."""
    emit(v.autopilot.events, v.time_us, SYSTEM_ID_DID, float(did), number)


@law
def refusal(v: Vehicle, axis: int) -> int:
    """Why the chirp cannot be flown from here (REFUSED_*), 0 when it can."""
    ap = v.autopilot
    if axis == 0:
        return REFUSED_NO_AXIS
    if not ap.arming.armed or ap.arming.landed:
        return REFUSED_ON_GROUND
    if POSITION_RIGHT <= axis <= SPEED_FORWARD:
        return 0 if ap.modes.number == LOITER else REFUSED_BY_SPEED
    return 0 if ap.modes.number in (STABILIZE, ACRO) else REFUSED_AUTOMATIC


@law
def start(v: Vehicle) -> int:
    """Enter in flight: from LOITER for the axes of the position, from a mode with a throttle by hand for the others."""
    ap = v.autopilot
    state, axis = ap.modes.systemid, int(ap.params.SID.AXIS)
    why = refusal(v, axis)
    if why != 0:
        report(v, why, 0.0)
        return ModeResult.INIT_FAILED
    state.time = 0.0
    state.testing = True
    state.holds_position = POSITION_RIGHT <= axis <= SPEED_FORWARD
    state.hold_pos = ap.control.pos_ne.pos_desired
    state.vel = Vec2(0.0, 0.0)
    report(v, STARTED, float(axis))
    return ModeResult.ACCEPTED


@law
def stop(v: Vehicle, did: int, number: float) -> None:
    """End the chirp; the mode goes on without it."""
    v.autopilot.modes.systemid.testing = False
    report(v, did, number)


@law
def sample(v: Vehicle) -> float:
    """One tick of the chirp: its value, 0 when there is none."""
    ap = v.autopilot
    state, chirp = ap.modes.systemid, chirp_of(ap.params.SID)
    if state.testing and not is_possible(chirp):
        stop(v, BAD_PARAMETERS, 0.0)
    if not state.testing:
        return 0.0
    state.time += DT
    state.frequency = frequency(chirp, state.time - DELAY)
    lean, lean_max = math.degrees(acos(min(ap.control.attitude.cos_lean, 1.0))), ap.params.ANGLE_MAX * 0.01
    if ap.arming.landed:
        stop(v, LANDED, 0.0)
    elif lean > lean_max:
        stop(v, LEANS, lean)
    elif state.time > DELAY + chirp.fade_in + chirp.constant + chirp.length + chirp.fade_out:
        stop(v, FINISHED, 0.0)
    elif int(ap.params.SID.AXIS) == 0:
        stop(v, NO_AXIS, 0.0)
    return value(chirp, state.time - DELAY) if state.testing else 0.0


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    state, axis = ap.modes.systemid, int(ap.params.SID.AXIS)
    state.value = sample(v)
    if state.holds_position:
        run_at_position(v, axis, state.value)
    else:
        run_by_hand(v, axis, state.value)
    if state.testing and ap.control.tick % SAMPLE_TICKS == 0:
        emit(ap.events, v.time_us, SYSTEM_ID_SAMPLE, 0.0, 0.0)


@law
def run_by_hand(v: Vehicle, axis: int, added: float) -> None:
    """One tick as STABILIZE flies, with ``added`` to an axis."""
    ap = v.autopilot
    control, sticks, p = ap.control, ap.modes.pilot, ap.params
    throttle = stabilize.throttle(sticks, p)
    if ground.spool_by_stick(ap.arming, sticks.throttle_zero, control.motors):
        attitude.reset_yaw_target(control.attitude, ap.estimate.yaw)
        throttle = 0.0
    lean_max, yaw_rate = math.radians(p.ANGLE_MAX * 0.01), sticks.yaw_rate
    lean = pilot.lean_angles(sticks, lean_max, lean_max)
    if axis in (ROLL, WITHOUT_FF_ROLL):
        lean = attitude.Lean(lean.roll + math.radians(added), lean.pitch)
    elif axis in (PITCH, WITHOUT_FF_PITCH):
        lean = attitude.Lean(lean.roll, lean.pitch + math.radians(added))
    elif axis in (YAW, WITHOUT_FF_YAW):
        yaw_rate += math.radians(added)
    elif axis == THROTTLE:
        throttle += added
    feed_forward = p.ATC.RATE_FF_ENAB
    if WITHOUT_FF_ROLL <= axis <= WITHOUT_FF_YAW and ap.modes.systemid.testing:
        p.ATC.RATE_FF_ENAB = 0.0
    attitude.input_euler_roll_pitch_yaw_rate(control, ap.estimate, p, lean, yaw_rate)
    p.ATC.RATE_FF_ENAB = feed_forward
    if RATE_ROLL <= axis <= RATE_YAW:
        control.attitude.rate_target += along(axis - RATE_ROLL, math.radians(added))
    elif MOTORS_ROLL <= axis <= MOTORS_YAW:
        control.motors.excited = True
        control.motors.excitation = along(axis - MOTORS_ROLL, added)
    throttle_mix.set_throttle_out(control, p, throttle, True, p.PILOT.THR_FILT)


@law
def along(axis: int, size: float) -> Vec3:
    """A vector along an axis 0, 1, 2."""
    return Vec3(size if axis == 0 else 0.0, size if axis == 1 else 0.0, size if axis == 2 else 0.0)


@law
def run_at_position(v: Vehicle, axis: int, added: float) -> None:
    """One tick of holding a position, with ``added`` to what is measured or asked for; the sticks turn and climb."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    is_forward = axis in (POSITION_FORWARD, VELOCITY_FORWARD, SPEED_FORWARD)
    push = turned(Vec2(added, 0.0) if is_forward else Vec2(0.0, added), est.yaw)
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    path = control.pos_ne
    path.disturbed = axis <= VELOCITY_FORWARD
    zero = Vec2(0.0, 0.0)
    path.disturbance_pos = push if axis <= POSITION_FORWARD else zero
    path.disturbance_vel = push if axis >= VELOCITY_RIGHT else zero
    state = modes.systemid
    follow_speed(state, zero if axis < SPEED_RIGHT else push)
    position.set_pos_vel_accel_ne(path, Motion2(state.hold_pos, state.vel, state.acc))
    position.update_ne(control, est, p)
    alt_hold.set_limits(control.pos_d, p)
    altitude.input_vel_accel_d(control.pos_d, -alt_hold.climb_rate(modes, ap.rc, control.pos_d, p), 0.0)
    altitude.update_d(control, est, p)
    thrust = position.thrust_vector(path)
    attitude.input_thrust_vector_heading_rate(control, est, p, thrust, modes.pilot.yaw_rate)


@law
def follow_speed(state: SystemIdState, vel: Vec2) -> None:
    """The position moves with a velocity [m/s]."""
    state.hold_pos += vel * DT
    state.acc = (vel - state.vel) / DT
    state.vel = vel


MODE = CopterMode(number=SYSTEMID, name="SYSTEMID", start=start, run=run, manual_throttle=True, may_arm=never_arms)
