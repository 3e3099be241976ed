# SPDX-License-Identifier: BSD-3-Clause
"""What AUTOTUNE makes of its twitches: when one is over, which gain changes, when a step is done.

A twitch asks for a rate (or an angle) at once. Its greatest rate, and how far that bounces back, tell whether the gains
are too high: a bounce of more than AUTOTUNE_AGGR of it is one. Each step changes a gain by 5 % a twitch until four
twitches have succeeded: D up until it bounces, D down until it does not, P up until the rate is passed, then the
angle's P down until the angle is not passed, and up until it is. For yaw the filter of the error (FLTE) may stand
in for D. The numbers were found from the ATUN and ATDE messages of a real ArduPilot.
"""

from __future__ import annotations

from ....core.kernels import law
from .autotune_gains import YAW
from .state import AutotuneState, AxisGains

# Steps, by ArduPilot's numbers in logs
RATE_D_UP, RATE_D_DOWN, RATE_P_UP, ANGLE_P_DOWN, ANGLE_P_UP = 0, 1, 2, 4, 5

# What a twitch comes to
GOES_ON, MEASURED, TOO_LARGE, TWITCH_AT_LEAST = 0, 1, 2, 3

# What a change of gains comes to
CHANGED, D_AT_LIMIT, NO_D, NO_P = 0, 1, 2, 3

ENOUGH = 4
"""So many twitches that succeed end a step."""
RISEN = 0.632
"""Part of the goal that must be reached in a third of the time that a twitch takes at most."""
_STEP = 0.05
_MARGIN = 0.2
_P_MIN, _P_MAX = 0.01, 2.0
_ANGLE_P_MIN, _ANGLE_P_MAX = 0.5, 40.0
_SCALE_MIN = 0.2
TIMEOUT_US = 2_000_000


@law
def measure_rate(t: AutotuneState, rate: float, goal: float, time_us: int) -> None:
    """Follow a twitch of a rate ``goal`` [rad/s]; ``rate`` is in its direction."""
    if rate > t.rate_max:
        t.rate_max = t.rate_min = rate
        t.accel = rate / max(1e-6 * (time_us - t.begun_us), 1e-3)
    elif rate < t.rate_min and t.rate_max > 0.25 * goal:
        t.rate_min = rate
    if t.rate_max < RISEN * goal:
        t.limit_us = min(3 * (time_us - t.begun_us), TIMEOUT_US)


@law
def measure_angle(t: AutotuneState, angle: float, rate: float, goal: float, time_us: int) -> None:
    """Follow a twitch of an angle ``goal`` [rad]; ``angle`` and ``rate`` [rad/s] are in its direction."""
    if rate > t.rate_max:
        t.rate_max = t.rate_min = rate
        t.accel = rate / max(1e-6 * (time_us - t.begun_us), 1e-3)
    t.rate_min = min(t.rate_min, rate)
    if angle > t.angle_max:
        t.angle_max = t.angle_min = angle
    elif angle < t.angle_min and t.angle_max > 0.25 * goal:
        t.angle_min = angle
    if t.angle_max < RISEN * goal:
        t.limit_us = min(3 * (time_us - t.begun_us), TIMEOUT_US)


@law
def judge_rate(t: AutotuneState, rate: float, angle: float, goal: float, angle_limit: float, aggr: float) -> int:
    """Whether a twitch of a rate is over before its time; it may not lean or turn beyond ``angle_limit`` [rad]."""
    if t.rate_max > goal or t.rate_max - t.rate_min > aggr * t.rate_max:
        return MEASURED
    if angle < angle_limit:
        return GOES_ON
    if rate > t.rate_min:
        return MEASURED
    if t.scale <= _SCALE_MIN:
        return TWITCH_AT_LEAST
    t.scale *= 0.9
    return TOO_LARGE


@law
def judge_angle(t: AutotuneState, goal: float, aggr: float) -> int:
    """Whether a twitch of an angle is over before its time."""
    over = t.angle_max > goal or t.angle_max - t.angle_min > aggr * t.angle_max
    return MEASURED if over else GOES_ON


@law
def succeed(t: AutotuneState) -> None:
    """Count a success; a failure of the next twitch is not believed."""
    t.ignore_next = True
    t.count += 1


@law
def succeed_unless_ignored(t: AutotuneState) -> None:
    """Count a success, unless it follows a failure: that one is not believed."""
    if not t.ignore_next:
        t.count += 1
    t.ignore_next = False


@law
def fail(t: AutotuneState) -> None:
    """Count a failure."""
    t.count = max(t.count - 1, 0)


@law
def fail_unless_ignored(t: AutotuneState) -> bool:
    """Count a failure, unless it follows a success: that one is not believed. Whether it counts."""
    if t.ignore_next:
        t.ignore_next = False
        return False
    fail(t)
    return True


@law
def fits_rate(t: AutotuneState) -> bool:
    """Whether the greatest rate is near enough below the target for measuring D."""
    return (1.0 - _MARGIN) * t.target <= t.rate_max <= t.target


@law
def fit_rate(t: AutotuneState, g: AxisGains, least: float) -> int:
    """Change P (D too when P is at its least) so that the rate comes near the target. What that came to."""
    if t.rate_max < t.target:
        g.rate_p = min(g.rate_p + _STEP * g.rate_p, _P_MAX)
        return NO_D if g.rate_p >= _P_MAX else CHANGED
    g.rate_p -= _STEP * g.rate_p
    if g.rate_p >= _P_MIN:
        return CHANGED
    g.rate_p = _P_MIN
    d = get_d(t, g) * (1.0 - _STEP)
    set_d(t, g, max(d, least))
    return NO_D if d <= least else CHANGED


@law
def get_d(t: AutotuneState, g: AxisGains) -> float:
    """D, or the filter of yaw's error in its place."""
    return g.error_hz if t.axis == YAW else g.rate_d


@law
def set_d(t: AutotuneState, g: AxisGains, d: float) -> None:
    """The same."""
    if t.axis == YAW:
        g.error_hz = d
    else:
        g.rate_d = d


@law
def bounces(t: AutotuneState, aggr: float) -> bool:
    """Whether the rate fell back."""
    return t.rate_max - t.rate_min > aggr * t.rate_max


@law
def raise_d(t: AutotuneState, g: AxisGains, most: float, aggr: float) -> int:
    """RATE_D_UP: more until it bounces."""
    if bounces(t, aggr):
        succeed(t)
    elif fail_unless_ignored(t):
        d = get_d(t, g) * (1.0 + 2.0 * _STEP)
        set_d(t, g, min(d, most))
        if d >= most:
            t.count = ENOUGH
    return CHANGED


@law
def lower_d(t: AutotuneState, g: AxisGains, least: float, aggr: float) -> int:
    """RATE_D_DOWN: less until it does not bounce; at its least the step is done."""
    if not bounces(t, aggr):
        succeed_unless_ignored(t)
        return CHANGED
    t.ignore_next = True
    fail(t)
    d = get_d(t, g) * (1.0 - _STEP)
    set_d(t, g, max(d, least))
    if d > least:
        return CHANGED
    t.count = ENOUGH
    return D_AT_LIMIT


@law
def raise_p(t: AutotuneState, g: AxisGains, least: float, aggr: float) -> int:
    """RATE_P_UP: P until the target is passed; a bounce just below it takes from both gains."""
    if t.rate_max > t.target * (1.0 + 0.5 * aggr):
        succeed(t)
        return CHANGED
    d = get_d(t, g)
    if bounces(t, aggr) and (1.0 - _MARGIN) * t.target < t.rate_max < t.target and d > least:
        fail(t)
        d -= _STEP * d
        set_d(t, g, max(d, least))
        g.rate_p = max(g.rate_p - _STEP * g.rate_p, _P_MIN)
        t.backwards = not t.backwards  # the same side again
        if g.rate_p <= _P_MIN:
            return NO_P
        return NO_D if d <= least and t.axis != YAW else CHANGED
    if fail_unless_ignored(t):
        g.rate_p = min(g.rate_p + _STEP * g.rate_p, _P_MAX)
        if g.rate_p >= _P_MAX:
            t.count = ENOUGH
    return CHANGED


@law
def lower_angle_p(t: AutotuneState, g: AxisGains, aggr: float) -> None:
    """ANGLE_P_DOWN: less until the target is not passed."""
    if t.angle_max < t.target * (1.0 + 0.5 * aggr):
        succeed_unless_ignored(t)
        return
    t.ignore_next = True
    fail(t)
    g.angle_p = max(g.angle_p - _STEP * g.angle_p, _ANGLE_P_MIN)
    if g.angle_p <= _ANGLE_P_MIN:
        t.count = ENOUGH


@law
def raise_angle_p(t: AutotuneState, g: AxisGains, aggr: float) -> None:
    """ANGLE_P_UP: more until the target is passed, by enough or so that it turns back."""
    turns_back = t.angle_max > t.target and t.rate_min < -aggr * t.rate_max
    if t.angle_max > t.target * (1.0 + 0.5 * aggr) or turns_back:
        succeed(t)
    elif fail_unless_ignored(t):
        g.angle_p = min(g.angle_p + _STEP * g.angle_p, _ANGLE_P_MAX)
        if g.angle_p >= _ANGLE_P_MAX:
            t.count = ENOUGH
