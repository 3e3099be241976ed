# SPDX-License-Identifier: BSD-3-Clause
"""AUTOTUNE: twitches one axis after the other, and finds its gains (AUTOTUNE_*).

Entered in flight. The sticks interrupt it, and fly it with the gains from before; between twitches it leans back to its
position. Disarmed on the ground with the gains found, or while it tries them, it keeps them; left before, or disarmed
in the air, it does not. A switch (180) or entering it again tries them. What a twitch is, is in ``autotune_twitch``;
what it reports, in ``autotune_rules``.
"""

from __future__ import annotations

import math
from typing import Any

from ....core.algebra import horizontal, norm2, quat_from_euler, rotate
from ....core.elementary import atan2, sincos
from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ....core.scalars import PI, constrain, wrap_pi
from ....core.vectors import Euler, Vec3
from ...events import Row, ev
from ...log_events import LogEvent
from ...modes import ModeResult
from ...notes import EventNote, ParametersFound, Text
from .. import pilot
from ..control import attitude
from ..control.spool import SpoolState
from ..control.throttle_mix import lean_limit
from ..state import Vehicle
from . import alt_hold
from . import autotune_gains as gains
from . import autotune_rules as rules
from . import autotune_twitch as twitches
from .alt_hold import ALT_HOLD
from .autotune_gains import FOUND, PAUSED, PITCH, ROLL, TUNING, YAW, YAW_D
from .loiter import LOITER
from .mode import CopterMode, never_arms
from .poshold import POSHOLD
from .stabilize import STABILIZE
from .state import AutotuneState

AUTOTUNE = 15

NAMES = {ROLL: "Roll", PITCH: "Pitch", YAW: "Yaw(E)", YAW_D: "Yaw(D)"}
STEPS = {
    rules.RATE_D_UP: "Rate D Up",
    rules.RATE_D_DOWN: "Rate D Down",
    rules.RATE_P_UP: "Rate P Up",
    rules.ANGLE_P_DOWN: "Angle P Down",
    rules.ANGLE_P_UP: "Angle P Up",
}
_TEXTS = {
    gains.STARTED: "Started", gains.STOPPED: "Stopped", gains.SUCCESS: "Success",
    gains.OVERRIDDEN: "pilot overrides active", gains.RESTORED: "original gains restored",
    gains.INCOMPLETE: "must be complete to test gains", gains.D_LIMIT: "Min Rate D limit reached",
}  # fmt: skip
_FAILURES = {rules.TWITCH_AT_LEAST: "Twitch Size", rules.NO_D: "Rate D Gain", rules.NO_P: "Rate P Gain"}
_SEVERITIES = {
    gains.COMPLETE: MavSeverity.NOTICE,
    gains.SUCCESS: MavSeverity.NOTICE,
    gains.FAILURE: MavSeverity.CRITICAL,
}
"""Of texts; of the others it is INFO."""
_LOGGED = {
    gains.STARTED: LogEvent.AUTOTUNE_INITIALISED,
    gains.STOPPED: LogEvent.AUTOTUNE_OFF,
    gains.SUCCESS: LogEvent.AUTOTUNE_SUCCESS,
    gains.FAILURE: LogEvent.AUTOTUNE_FAILED,
    gains.D_LIMIT: LogEvent.AUTOTUNE_REACHED_LIMIT,
    gains.TRIES: LogEvent.AUTOTUNE_PILOT_TESTING,
    gains.SAVED: LogEvent.AUTOTUNE_SAVEDGAINS,
}

_PAUSE_US = 500_000  # from the sticks' release to the next twitch
_LEVEL_US = 250_000
_PATIENCE_US = 2_000_000  # after it the limits of what is level are those below; twice that after twice the time
_REPORT_US, _WARN_US = 2_000_000, 1_000_000
_LEVEL, _STILL, _YAW_STILL = math.radians(2.5), math.radians(5.0), math.radians(7.5)
_HOLD_LEAN, _HOLD_DISTANCE = math.radians(10.0), 20.0  # [m]
_HOLD_NEAR, _TURN_FAR = 0.1, 5.0  # [m]
_TURN_BACK = math.radians(95.0)
_D_MAX, _ERROR_HZ = 0.2, (1.0, 5.0)
_ANGLE_BACKOFF, _ANGLE_P_MIN = 0.9, 0.5
_ACCEL_MIN, _YAW_ACCEL_MIN = 4000.0, 1000.0  # [cdeg/s^2]
_CDEG = math.degrees(100.0)


def texts(did: int, number: int, t: AutotuneState) -> list[str]:
    """Status texts of AUTOTUNE_DID, without "AutoTune: "."""
    if did == gains.PROGRESS:
        axis, step, percent = number // 10000, number // 1000 % 10, number % 1000
        return [f"{NAMES[axis]} {STEPS[step]} {percent}%"]
    if did == gains.COMPLETE:
        g, name = gains.found(t, number), NAMES[number]
        integral = g.rate_p * (1.0 if number < YAW else 0.1)
        rate = f"{name} Rate: P:{g.rate_p:.3f}, I:{integral:.3f}, D:{g.rate_d:.4f}"
        return [f"{name} complete", rate, f"{name} Angle P:{g.angle_p:.3f}, Max Accel:{g.accel:.0f}"]
    if did in (gains.TRIES, gains.SAVED):
        words = ("Roll ", "Pitch ", "Yaw(E)", "Yaw(D)")
        axes = "".join(word for axis, word in enumerate(words) if number >> axis & 1)
        return [f"{'Pilot Testing' if did == gains.TRIES else 'Saved'} gains for {axes}"]
    if did == gains.FAILURE:
        return [f"{_FAILURES[number]} Determination Failed"]
    return [_TEXTS[did]] if did in _TEXTS else []


def parameters(axes: int) -> tuple[str, ...]:
    """Names of the parameters that hold what was found: bits of axes."""
    names: list[str] = []
    for axis, short, letter in ((ROLL, "RLL", "R"), (PITCH, "PIT", "P"), (YAW, "YAW", "Y"), (YAW_D, "YAW", "Y")):
        if axes >> axis & 1:
            own = "FLTE" if axis == YAW else "D"
            names += [f"ATC_RAT_{short}_{gain}" for gain in ("P", "I", own)]
            names += [f"ATC_ANG_{short}_P", f"ATC_ACCEL_{letter}_MAX"]
    return tuple(dict.fromkeys(names))


def _texts(v: Any, a: float, b: float) -> list[EventNote]:
    did, number = int(a), int(b)
    severity = _SEVERITIES.get(did, MavSeverity.INFO)
    said: list[EventNote] = [
        Text(severity, f"AutoTune: {text}") for text in texts(did, number, v.autopilot.modes.autotune)
    ]
    return [*said, ParametersFound(parameters(number))] if did == gains.SAVED else said


def _rows(v: Any, did: float, number: float) -> list[Row]:
    """ATUN: what a twitch has measured, with the gains that follow from it; EV."""
    if did != gains.MEASURED:
        return [ev(_LOGGED[int(did)])] if did in _LOGGED else []
    t = v.autopilot.modes.autotune
    g = gains.found(t, t.axis)
    least, most = (t.rate_min, t.rate_max) if t.step <= rules.RATE_P_UP else (t.angle_min, t.angle_max)
    measured = (math.degrees(x) for x in (t.target, least, most))
    numbers = (g.rate_p, rules.get_d(t, g), g.angle_p, math.degrees(100.0 * t.accel))
    return [("ATUN", (t.axis, t.step, *measured, *numbers))]


AUTOTUNE_DID = gains.AUTOTUNE_DID.saying(says=_texts, log=_rows)


@law
def next_axis(chosen: int, done: int) -> int:
    """The next axis to tune: bits ``chosen`` without those ``done``; AXES: none."""
    for axis in range(gains.AXES):
        if (chosen >> axis) & 1 != 0 and (done >> axis) & 1 == 0:
            return axis
    return gains.AXES


@law
def start(v: Vehicle) -> int:
    """Enter in flight; gains that were found are tried."""
    ap = v.autopilot
    t, modes = ap.modes.autotune, ap.modes
    from_mode = modes.number
    flies = ap.arming.armed and not ap.arming.landed and not modes.pilot.throttle_zero
    by_hand = from_mode in (STABILIZE, ALT_HOLD, LOITER, POSHOLD)
    if not by_hand or not flies:
        return ModeResult.INIT_FAILED
    is_new = t.phase != PAUSED and not gains.has_found(t)
    if is_new and next_axis(int(ap.params.AUTOTUNE.AXES), 0) == gains.AXES:
        return ModeResult.INIT_FAILED
    alt_hold.start_vertical(modes.takeoff, ap.control, ap.estimate, ap.params)
    t.holds_position = from_mode in (LOITER, POSHOLD) and ap.estimate.position_ok
    t.overridden_us = 0
    stay_here(v)
    if gains.has_found(t):
        gains.try_gains(v, True)
        return ModeResult.ACCEPTED
    gains.report(v, gains.STARTED, 0.0)
    if is_new:
        begin(v)
    else:
        t.phase = TUNING
        gains.remember(v)
        level_first(v)
    return ModeResult.ACCEPTED


@law
def stay_here(v: Vehicle) -> None:
    """The present position and heading are held."""
    t, est = v.autopilot.modes.autotune, v.autopilot.estimate
    t.hold_pos, t.heading = horizontal(est.pos), est.yaw


@law
def begin(v: Vehicle) -> None:
    """Tune from the beginning."""
    ap = v.autopilot
    t, p = ap.modes.autotune, ap.params
    t.phase = TUNING
    gains.remember(v)
    for axis in range(YAW_D):
        gains.read(p.ATC, axis, gains.found(t, axis))
    t.done = 0
    t.backwards = True
    tune_next_axis(v)


@law
def tune_next_axis(v: Vehicle) -> None:
    """The next axis's first step; the gains from before when there is none."""
    ap = v.autopilot
    t, p = ap.modes.autotune, ap.params.AUTOTUNE
    axis = next_axis(int(p.AXES), t.done)
    if axis == gains.AXES:
        t.phase = FOUND
        gains.restore(v)
        gains.report(v, gains.SUCCESS, 0.0)
        return
    t.axis = axis
    g = gains.found(t, axis)
    if axis == YAW:
        g.error_hz = constrain(g.error_hz, _ERROR_HZ[0], _ERROR_HZ[1])
    else:
        g.rate_d = constrain(g.rate_d, p.MIN_D, _D_MAX)
    begin_step(t, rules.RATE_D_UP)
    level_first(v)


@law
def begin_step(t: AutotuneState, step: int) -> None:
    """Nothing is known of a step yet."""
    t.step = step
    t.count = 0
    t.ignore_next = False
    t.scale = 1.0


@law
def level_first(v: Vehicle) -> None:
    """Level out before the next twitch."""
    t = v.autopilot.modes.autotune
    t.twitching = False
    t.came_to = rules.GOES_ON
    t.levelling_us = t.level_us = v.time_us
    gains.steady(v)


@law
def is_overridden(v: Vehicle, climb: float, flies: bool) -> bool:
    """Whether the sticks fly (``climb``: of the throttle's [m/s]), or nothing does (not ``flies``): gains from before.

    When that has been over for a while it goes on.
    """
    t, sticks = v.autopilot.modes.autotune, v.autopilot.modes.pilot
    leans = sticks.roll != 0.0 or sticks.pitch != 0.0
    if leans:
        t.hold_pos = horizontal(v.autopilot.estimate.pos)
    if t.phase != TUNING:
        return False
    by_sticks = leans or sticks.yaw != 0.0 or climb != 0.0
    if by_sticks or not flies:
        if t.overridden_us == 0:
            gains.restore(v)
            t.warned_us = -_WARN_US
        t.overridden_us = v.time_us
    elif t.overridden_us != 0 and v.time_us - t.overridden_us > _PAUSE_US:
        t.overridden_us = 0
        t.heading = v.autopilot.estimate.yaw
        level_first(v)
    if (by_sticks or flies) and t.overridden_us != 0 and v.time_us - t.warned_us >= _WARN_US:
        t.warned_us = v.time_us
        gains.report(v, gains.OVERRIDDEN, 0.0)
    return t.overridden_us != 0


@law
def hold(v: Vehicle) -> attitude.Lean:
    """Lean back to the position, by the distance. Far off, turn so that the axis being tuned leans little."""
    est, t = v.autopilot.estimate, v.autopilot.modes.autotune
    away = horizontal(est.pos) - t.hold_pos
    distance = norm2(away)
    if not t.holds_position or distance < _HOLD_NEAR:
        return attitude.Lean(0.0, 0.0)
    if distance >= _TURN_FAR:
        heading = atan2(away.y, away.x) + (0.5 * PI if t.axis == PITCH else 0.0)
        t.heading = wrap_pi(heading + (PI if abs(wrap_pi(heading - t.heading)) > _TURN_BACK else 0.0))
    size = _HOLD_LEAN * min(distance / _HOLD_DISTANCE, 1.0) / distance
    s, c = sincos(est.yaw)
    return attitude.Lean(size * (away.x * s - away.y * c), size * (away.x * c + away.y * s))


@law
def run(v: Vehicle) -> None:
    """One tick."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    alt_hold.set_limits(control.pos_d, p)
    climb = alt_hold.climb_rate(modes, ap.rc, control.pos_d, p)
    doing = alt_hold.decide(ap.arming, modes.takeoff, control.motors, climb)
    flies = doing == alt_hold.FLYING and control.motors.spool_state == SpoolState.THROTTLE_UNLIMITED
    overridden = is_overridden(v, climb, flies)
    if flies and modes.autotune.phase == TUNING and not overridden:
        tune(v)
    else:
        if doing in (alt_hold.STOPPED, alt_hold.LANDED_IDLE):
            attitude.reset_yaw_target(control.attitude, est.yaw)
        lean_max = math.radians(p.ANGLE_MAX * 0.01)
        lean = pilot.lean_angles(modes.pilot, lean_max, min(lean_max, lean_limit(control.attitude)))
        if doing == alt_hold.FLYING and modes.pilot.roll == 0.0 and modes.pilot.pitch == 0.0:
            lean = hold(v)
        attitude.input_euler_roll_pitch_yaw_rate(control, est, p, lean, modes.pilot.yaw_rate)
    alt_hold.run_vertical(doing, climb, ap.arming, modes.takeoff, control, est, p)


@law
def tune(v: Vehicle) -> None:
    """One tick of levelling or of a twitch."""
    t = v.autopilot.modes.autotune
    if v.time_us - t.reported_us >= _REPORT_US:
        t.reported_us = v.time_us
        percent = 100 * min(t.count, rules.ENOUGH) // rules.ENOUGH
        gains.report(v, gains.PROGRESS, float(t.axis * 10000 + t.step * 1000 + percent))
    if t.came_to != rules.GOES_ON:
        conclude(v)
    if t.phase == TUNING and t.twitching:
        twitches.run(v)
    else:
        level(v)


@law
def level(v: Vehicle) -> None:
    """One tick of levelling; when it has been level for long enough, a twitch comes next."""
    ap = v.autopilot
    t = ap.modes.autotune
    lean = hold(v)
    thrust = rotate(quat_from_euler(Euler(lean.roll, lean.pitch, ap.estimate.yaw)), Vec3(0.0, 0.0, -1.0))
    heading = attitude.Heading(t.heading, 0.0, True)
    attitude.input_thrust_vector_heading(ap.control, ap.estimate, ap.params, thrust, heading)
    if not is_level(v, lean):
        t.level_us = v.time_us
    elif t.phase == TUNING and v.time_us - t.level_us >= _LEVEL_US:
        twitches.begin(v)


@law
def is_level(v: Vehicle, lean: attitude.Lean) -> bool:
    """Whether the next twitch may begin. Only rates upwards matter, as with ArduPilot."""
    t, euler, rates = v.autopilot.modes.autotune, v.autopilot.estimate.euler, v.autopilot.estimate.rates
    k = min((v.time_us - t.levelling_us) / _PATIENCE_US, 2.0)
    off = max(abs(euler.roll - lean.roll), max(abs(euler.pitch - lean.pitch), abs(wrap_pi(euler.yaw - t.heading))))
    still = rates.x <= k * _STILL and rates.y <= k * _STILL and rates.z <= k * _YAW_STILL
    return off <= k * _LEVEL and still


@law
def fail(v: Vehicle, why: int) -> None:
    """Give up: the gains from before."""
    t = v.autopilot.modes.autotune
    t.phase = gains.FAILED
    t.twitching = False
    gains.restore(v)
    gains.report(v, gains.FAILURE, float(why))


@law
def conclude(v: Vehicle) -> None:
    """The tick after a twitch: another gain, and another step or axis when enough of them succeeded."""
    t = v.autopilot.modes.autotune
    if t.came_to == rules.TWITCH_AT_LEAST:
        fail(v, rules.TWITCH_AT_LEAST)
        return
    if t.came_to == rules.MEASURED:
        learn(v)
        t.backwards = not t.backwards
    if t.phase == TUNING:
        level_first(v)


@law
def change_gains(v: Vehicle) -> int:
    """Change the step's gain by what the twitch showed; what that came to."""
    p = v.autopilot.params.AUTOTUNE
    t, aggr = v.autopilot.modes.autotune, p.AGGR
    g = gains.found(t, t.axis)
    if t.step == rules.ANGLE_P_DOWN:
        rules.lower_angle_p(t, g, aggr)
        return rules.CHANGED
    if t.step == rules.ANGLE_P_UP:
        rules.raise_angle_p(t, g, aggr)
        return rules.CHANGED
    least, most = (_ERROR_HZ[0], _ERROR_HZ[1]) if t.axis == YAW else (p.MIN_D, _D_MAX)
    if t.step == rules.RATE_P_UP:
        return rules.raise_p(t, g, least, aggr)
    if not rules.fits_rate(t):
        return rules.fit_rate(t, g, least)
    if t.step == rules.RATE_D_UP:
        return rules.raise_d(t, g, most, aggr)
    return rules.lower_d(t, g, least, aggr)


@law
def learn(v: Vehicle) -> None:
    """Change a gain; the next step, or axis, when that was enough."""
    t = v.autopilot.modes.autotune
    came_to = change_gains(v)
    if came_to == rules.NO_D or came_to == rules.NO_P:
        fail(v, came_to)
        return
    if came_to == rules.D_AT_LIMIT:
        gains.report(v, gains.D_LIMIT, 0.0)
    if t.count < rules.ENOUGH:
        return
    if t.step != rules.ANGLE_P_UP:
        begin_step(t, rules.ANGLE_P_DOWN if t.step == rules.RATE_P_UP else t.step + 1)
        return
    g = gains.found(t, t.axis)
    g.angle_p = max(_ANGLE_BACKOFF * g.angle_p, _ANGLE_P_MIN)
    g.accel = max(_CDEG * t.accel, _ACCEL_MIN if t.axis < YAW else _YAW_ACCEL_MIN)
    gains.report(v, gains.COMPLETE, float(t.axis))
    t.done |= 1 << t.axis
    tune_next_axis(v)


MODE = CopterMode(number=AUTOTUNE, name="AUTOTUNE", start=start, run=run, climb_stick=True, may_arm=never_arms)
