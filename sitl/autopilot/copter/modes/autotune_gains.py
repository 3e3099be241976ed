# SPDX-License-Identifier: BSD-3-Clause
"""The gains that AUTOTUNE changes: those from before, those found, and which of them the parameters hold."""

from __future__ import annotations

from ....core.kernels import law
from ...events import Event, emit
from ...params.gains import PidGains
from ..parameters.control import Attitude
from ..state import Vehicle
from .state import AutotuneState, AxisGains

# Axes; yaw's error filter and yaw's D are tuned one after the other
ROLL, PITCH, YAW, YAW_D = 0, 1, 2, 3
AXES = 4

# Phases (``AutotuneState.phase``)
IDLE = 0
TUNING = 1
FOUND = 2  # gains were found; the parameters still hold those from before
TRIED = 3  # the parameters hold those found
RETURNED = 4  # the parameters hold those from before again
FAILED = 5
PAUSED = 6  # the mode was left before its end; the parameters hold those from before

AUTOTUNE_DID = Event(63)  # a: what, b: a number of it; its words are in ``autotune``

# What it reports (AUTOTUNE_DID)
STARTED, STOPPED, PROGRESS, COMPLETE, SUCCESS, FAILURE, OVERRIDDEN, TRIES, SAVED, RESTORED, INCOMPLETE, D_LIMIT = range(
    12
)
MEASURED = 12  # for the log alone: a twitch is over

TESTING_I = 0.1
"""I between twitches, as a part of P: it must not interfere,"""
TWITCHING_I = 0.01
"""and in twitches."""


@law
def report(v: Vehicle, did: int, number: float) -> None:
    """Report what it did."""
    emit(v.autopilot.events, v.time_us, AUTOTUNE_DID, float(did), number)


@law
def loop(p: Attitude, axis: int) -> PidGains:
    """Gains of an axis's rate loop."""
    if axis == ROLL:
        return p.RAT_RLL
    return p.RAT_PIT if axis == PITCH else p.RAT_YAW


@law
def before(t: AutotuneState, axis: int) -> AxisGains:
    """Gains from before."""
    if axis == ROLL:
        return t.roll_before
    return t.pitch_before if axis == PITCH else t.yaw_before


@law
def found(t: AutotuneState, axis: int) -> AxisGains:
    """Gains found so far."""
    if axis == ROLL:
        return t.roll
    return t.pitch if axis == PITCH else t.yaw


@law
def read(p: Attitude, axis: int, g: AxisGains) -> None:
    """From the parameters."""
    gains = loop(p, axis)
    g.rate_p, g.rate_i, g.rate_d = gains.P, gains.I, gains.D
    g.error_hz, g.target_hz = gains.FLTE, gains.FLTT
    if axis == ROLL:
        g.angle_p, g.accel = p.ANG_RLL_P, p.ACCEL_R_MAX
    elif axis == PITCH:
        g.angle_p, g.accel = p.ANG_PIT_P, p.ACCEL_P_MAX
    else:
        g.angle_p, g.accel = p.ANG_YAW_P, p.ACCEL_Y_MAX


@law
def write(p: Attitude, axis: int, g: AxisGains, integral: float, target_hz: float, accel: float) -> None:
    """To the parameters, with another I, filter of the target [Hz] and acceleration [cdeg/s^2]."""
    gains = loop(p, axis)
    gains.P, gains.I, gains.D = g.rate_p, integral, g.rate_d
    gains.FLTE, gains.FLTT = g.error_hz, target_hz
    if axis == ROLL:
        p.ANG_RLL_P, p.ACCEL_R_MAX = g.angle_p, accel
    elif axis == PITCH:
        p.ANG_PIT_P, p.ACCEL_P_MAX = g.angle_p, accel
    else:
        p.ANG_YAW_P, p.ACCEL_Y_MAX = g.angle_p, accel


@law
def remember(v: Vehicle) -> None:
    """The gains from before are those that the parameters hold now."""
    t = v.autopilot.modes.autotune
    for axis in range(YAW_D):
        read(v.autopilot.params.ATC, axis, before(t, axis))


@law
def restore(v: Vehicle) -> None:
    """The parameters hold the gains from before."""
    t, p = v.autopilot.modes.autotune, v.autopilot.params.ATC
    for axis in range(YAW_D):
        g = before(t, axis)
        write(p, axis, g, g.rate_i, g.target_hz, g.accel)


@law
def steady(v: Vehicle) -> None:
    """Between twitches: the gains from before, with little I on the axis that is being tuned."""
    restore(v)
    t = v.autopilot.modes.autotune
    g = before(t, t.axis)
    loop(v.autopilot.params.ATC, t.axis).I = TESTING_I * g.rate_p


@law
def twitch(v: Vehicle) -> None:
    """In a twitch: those found so far, without filter of the target and limit of the acceleration."""
    t = v.autopilot.modes.autotune
    g = found(t, t.axis)
    write(v.autopilot.params.ATC, t.axis, g, TWITCHING_I * g.rate_p, 0.0, 0.0)


@law
def use(v: Vehicle) -> None:
    """The parameters hold the gains found, of the axes that are tuned."""
    t, p = v.autopilot.modes.autotune, v.autopilot.params.ATC
    for axis in range(AXES):
        if (t.done >> axis) & 1 != 0:
            g = found(t, axis)
            write(p, axis, g, g.rate_p * (1.0 if axis < YAW else 0.1), before(t, axis).target_hz, g.accel)


@law
def has_found(t: AutotuneState) -> bool:
    """Whether all axes have been tuned."""
    return t.phase == FOUND or t.phase == TRIED or t.phase == RETURNED


@law
def try_gains(v: Vehicle, on: bool) -> None:
    """Fly with the gains found, or with those from before."""
    t = v.autopilot.modes.autotune
    if not has_found(t):
        report(v, INCOMPLETE, 0.0)
    elif on:
        if t.phase != TRIED:
            remember(v)
        use(v)
        t.phase = TRIED
        report(v, TRIES, float(t.done))
    else:
        restore(v)
        t.phase = RETURNED
        report(v, RESTORED, 0.0)


@law
def leave(v: Vehicle) -> None:
    """The mode is left: gains from before, until it is entered again."""
    t = v.autopilot.modes.autotune
    if t.phase == IDLE:
        return
    give_back(v)
    if t.phase == TUNING:
        t.phase = PAUSED
    elif has_found(t):
        t.phase = RETURNED
    report(v, STOPPED, 0.0)


@law
def give_back(v: Vehicle) -> None:
    """Gains that AUTOTUNE put into the parameters are taken out of them; those that a client set later stay."""
    t = v.autopilot.modes.autotune
    if t.phase == TUNING or t.phase == TRIED:
        restore(v)


@law
def settle(v: Vehicle, landed: bool) -> None:
    """At disarming: gains found and not given back stay if the vehicle has ``landed``; others are forgotten."""
    t = v.autopilot.modes.autotune
    if landed and (t.phase == FOUND or t.phase == TRIED):
        use(v)
        report(v, SAVED, float(t.done))
    else:
        give_back(v)
    t.phase = IDLE
