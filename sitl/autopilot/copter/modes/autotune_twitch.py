# SPDX-License-Identifier: BSD-3-Clause
"""A twitch of AUTOTUNE: a rate or an angle about one axis, asked for at once, and what is measured of the answer."""

from __future__ import annotations

import math

from ....core.algebra import multiply, quat_from_rotation_vector
from ....core.kernels import law
from ....core.scalars import constrain, wrap_pi
from ....core.vectors import Vec3
from ...control.pid import lowpass_gain
from ..control import attitude
from ..control.motors import hover_throttle
from ..control.state import DT
from ..state import Vehicle
from . import autotune_gains as gains
from . import autotune_rules as rules
from .autotune_gains import PITCH, ROLL, YAW
from .state import AutotuneState, AxisGains

_RATE_MIN, _RATE_MAX = math.radians(45.0), math.radians(180.0)
_YAW_RATE_MIN, _YAW_RATE_MAX = math.radians(15.0), math.radians(90.0)
_YAW_ANGLE_MIN, _YAW_ANGLE_MAX = math.radians(5.0), math.radians(30.0)
_LEAN_MIN, _LEAN_MAX = 1.0 / 3.0, 0.5
"""Twitches lean by so much of ANGLE_MAX."""
_YAW_SHARE = 0.7
"""Of the rate that roll and pitch could be asked for, yaw is."""
_YAW_FILTER_HZ = 10.0


@law
def rate_step(v: Vehicle, g: AxisGains) -> float:
    """Rate [rad/s] that the motors can be asked for at once with these gains."""
    p, axis = v.autopilot.params, v.autopilot.modes.autotune.axis
    loop = gains.loop(p.ATC, axis)
    a = min(lowpass_gain(loop.FLTD, DT), lowpass_gain(g.error_hz, DT))
    rest = 1.0 - a
    hover = constrain(hover_throttle(p.MOT), 0.1, 0.5)
    rate = 2.0 * hover / max(g.rate_p + g.rate_d * a * rest * rest * rest / DT, 1e-6)
    return rate if axis < YAW else _YAW_SHARE * rate


@law
def target(v: Vehicle) -> float:
    """Rate [rad/s] or angle [rad] of the next twitch."""
    t = v.autopilot.modes.autotune
    g, yaws = gains.found(t, t.axis), t.axis >= YAW
    rate = rate_step(v, g)
    if t.step <= rules.RATE_P_UP:
        least, most = (_YAW_RATE_MIN, _YAW_RATE_MAX) if yaws else (_RATE_MIN, _RATE_MAX)
        return constrain(rate, least, max(least, t.scale * most))
    lean_max = math.radians(v.autopilot.params.ANGLE_MAX * 0.01)
    angle = rate / max(g.angle_p, 1e-6)
    if yaws:
        return constrain(angle, _YAW_ANGLE_MIN, _YAW_ANGLE_MAX)
    return constrain(angle, _LEAN_MIN * lean_max, _LEAN_MAX * lean_max)


@law
def begin(v: Vehicle) -> None:
    """The next tick is the first of a twitch."""
    t = v.autopilot.modes.autotune
    t.twitching = True
    t.begun_us = v.time_us
    t.limit_us = rules.TIMEOUT_US
    t.target = target(v)
    t.start_rate, t.start_angle = axis_rate(v), axis_angle(v)
    t.rate_max = t.rate_min = t.angle_max = t.angle_min = t.accel = 0.0
    t.rate = t.start_rate if t.step > rules.RATE_P_UP else 0.0
    gains.twitch(v)


@law
def along(axis: int, size: float) -> Vec3:
    """A vector along an axis."""
    return Vec3(size if axis == ROLL else 0.0, size if axis == PITCH else 0.0, size if axis >= YAW else 0.0)


@law
def axis_rate(v: Vehicle) -> float:
    """Rate about the axis in the twitch's direction [rad/s]."""
    t, rates = v.autopilot.modes.autotune, v.autopilot.estimate.rates
    rate = rates.x if t.axis == ROLL else rates.y if t.axis == PITCH else rates.z
    return -rate if t.backwards else rate


@law
def axis_angle(v: Vehicle) -> float:
    """Roll, pitch or heading in the twitch's direction [rad]."""
    t, euler = v.autopilot.modes.autotune, v.autopilot.estimate.euler
    angle = euler.roll if t.axis == ROLL else euler.pitch if t.axis == PITCH else euler.yaw
    return -angle if t.backwards else angle


@law
def turned(v: Vehicle) -> float:
    """Angle since the twitch began, in its direction [rad]."""
    return wrap_pi(axis_angle(v) - v.autopilot.modes.autotune.start_angle)


@law
def command_rate(v: Vehicle) -> None:
    """One tick of a rate; the attitude reached on the way is the target afterwards."""
    ap = v.autopilot
    t, control, est = ap.modes.autotune, ap.control, ap.estimate
    attitude.jump(control.attitude, est.q, Vec3(0.0, 0.0, 0.0))
    attitude.correct(control.attitude, est, ap.params.ATC)
    rate = t.target + t.start_rate
    control.attitude.rate_target = along(t.axis, -rate if t.backwards else rate)


@law
def command_angle(v: Vehicle, is_first: bool) -> None:
    """One tick of an angle: the target jumps once."""
    ap = v.autopilot
    t, control, p = ap.modes.autotune, ap.control, ap.params.ATC
    if is_first:
        turn = quat_from_rotation_vector(along(t.axis, -t.target if t.backwards else t.target))
        attitude.jump(control.attitude, multiply(control.attitude.target_q, turn), Vec3(0.0, 0.0, 0.0))
    feed_forward = p.RATE_FF_ENAB
    p.RATE_FF_ENAB = 0.0
    attitude.input_rates(control, ap.estimate, ap.params, Vec3(0.0, 0.0, 0.0))
    p.RATE_FF_ENAB = feed_forward


@law
def run(v: Vehicle) -> None:
    """One tick of a twitch."""
    ap = v.autopilot
    t, p = ap.modes.autotune, ap.params
    hertz = _YAW_FILTER_HZ if t.axis >= YAW else 2.0 * gains.loop(p.ATC, t.axis).FLTD
    if t.step <= rules.RATE_P_UP:
        command_rate(v)
        t.rate += lowpass_gain(hertz, DT) * (axis_rate(v) - t.start_rate - t.rate)
        t.came_to = come_of_rate(t, v, p.AUTOTUNE.AGGR)
    else:
        command_angle(v, t.angle_max == 0.0 and v.time_us - t.begun_us <= round(1.5e6 * DT))
        t.rate += lowpass_gain(hertz, DT) * (axis_rate(v) - t.rate)
        goal = t.target * (1.0 + 0.5 * p.AUTOTUNE.AGGR)
        rules.measure_angle(t, turned(v), t.rate, goal, v.time_us)
        t.came_to = rules.judge_angle(t, goal, p.AUTOTUNE.AGGR)
    if t.came_to == rules.GOES_ON and v.time_us - t.begun_us >= t.limit_us:
        t.came_to = rules.MEASURED
    if t.came_to == rules.MEASURED:
        gains.report(v, gains.MEASURED, 0.0)


@law
def come_of_rate(t: AutotuneState, v: Vehicle, aggr: float) -> int:
    """What a twitch of a rate has come to."""
    lean_max = _LEAN_MAX * math.radians(v.autopilot.params.ANGLE_MAX * 0.01)
    goal = t.target * (1.0 + 0.5 * aggr) if t.step == rules.RATE_P_UP else t.target
    rules.measure_rate(t, t.rate, goal, v.time_us)
    return rules.judge_rate(t, t.rate, turned(v), goal, _YAW_ANGLE_MAX if t.axis >= YAW else lean_max, aggr)
