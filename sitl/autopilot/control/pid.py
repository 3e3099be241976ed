# SPDX-License-Identifier: BSD-3-Clause
"""PID controller with filters on target, error and derivative, feed-forward and a limited integrator.

Target and measurement share a unit u, e.g. rad/s; the gains give the output's:
P [output/u], I [output/(u s)], D [output s/u].
An input that is not finite leaves the state as it is and gives zero output.
"""

from __future__ import annotations

from typing import NamedTuple

from ...core.kernels import inlined, law
from ...core.records import Record
from ...core.scalars import TWO_PI, constrain, finite
from ..params.gains import BasicPidGains, PidGains


class Pid(Record):
    """What a PID loop keeps between periods. Zeros are a valid start."""

    started: bool  # false: the filters take the next input as it is
    target: float  # filtered; the unit of the controlled quantity
    error: float  # filtered
    derivative: float  # of the error, filtered [1/s]
    target_derivative: float  # [1/s]
    integrator: float  # in the unit of the output


class Gains(NamedTuple):
    """Gains, limits and filters of a loop."""

    p: float
    i: float
    d: float
    ff: float  # output per target
    d_ff: float  # output per derivative of the target
    i_max: float  # greatest integrator
    pd_max: float  # greatest proportional and derivative part; 0: no limit
    target_hz: float  # cut-off frequencies of the filters [Hz]; 0: no filter
    error_hz: float
    derivative_hz: float


class Blocked(NamedTuple):
    """Directions in which the output of a loop has no more effect."""

    down: bool
    up: bool


@inlined
def pid_gains(group: PidGains) -> Gains:
    """Gains from parameters."""
    g = group
    return Gains(g.P, g.I, g.D, g.FF, g.D_FF, g.IMAX, g.PDMX, g.FLTT, g.FLTE, g.FLTD)


@inlined
def basic_gains(group: BasicPidGains, i_max: float) -> Gains:
    """Gains from parameters of a loop without a filter of the target; ``i_max`` in the unit of the output."""
    g = group
    return Gains(g.P, g.I, g.D, g.FF, 0.0, i_max, 0.0, 0.0, g.FLTE, g.FLTD)


@inlined
def lowpass_gain(cutoff_hz: float, dt: float) -> float:
    """Part of the difference that a first-order low-pass takes over in one period; 1 without a filter (0 Hz)."""
    x = TWO_PI * cutoff_hz * dt
    if x <= 0.0:
        return 1.0
    return x / (1.0 + x)


@inlined
def filter_error(pid: Pid, target: float, measurement: float, dt: float, gains: Gains) -> None:
    """Bring target, error and derivative up to date."""
    if not pid.started:
        pid.started = True
        pid.target = target
        pid.error = target - measurement
        pid.derivative = 0.0
        pid.target_derivative = 0.0
        return
    new_target = pid.target + lowpass_gain(gains.target_hz, dt) * (target - pid.target)
    error = pid.error + lowpass_gain(gains.error_hz, dt) * (new_target - measurement - pid.error)
    pid.derivative += lowpass_gain(gains.derivative_hz, dt) * ((error - pid.error) / dt - pid.derivative)
    pid.target_derivative = (new_target - pid.target) / dt
    pid.target = new_target
    pid.error = error


@inlined
def integrate(pid: Pid, dt: float, blocked: Blocked, gains: Gains) -> None:
    """Integrate the error unless that would drive the integrator in a blocked direction."""
    if gains.i == 0.0:
        pid.integrator = 0.0
    elif not ((pid.error < 0.0 and blocked.down) or (pid.error > 0.0 and blocked.up)):
        pid.integrator = constrain(pid.integrator + pid.error * gains.i * dt, -gains.i_max, gains.i_max)


@inlined
def update_pid(pid: Pid, target: float, measurement: float, dt: float, saturated: bool, gains: Gains) -> float:
    """Output of a loop whose actuator reports only *that* it is saturated: then the integrator may only shrink."""
    if not (finite(target) and finite(measurement)):
        return 0.0
    filter_error(pid, target, measurement, dt, gains)
    blocked = Blocked(saturated and pid.integrator <= 0.0, saturated and pid.integrator >= 0.0)
    integrate(pid, dt, blocked, gains)
    proportional = pid.error * gains.p + pid.derivative * gains.d
    if gains.pd_max > 0.0:
        proportional = constrain(proportional, -gains.pd_max, gains.pd_max)
    feed_forward = pid.target * gains.ff + pid.target_derivative * gains.d_ff
    return proportional + pid.integrator + feed_forward


@inlined
def update_pid_directional(
    pid: Pid, target: float, measurement: float, dt: float, blocked: Blocked, gains: Gains
) -> float:
    """Output of a loop that knows in which direction its actuator is used up.

    The target is neither filtered nor differentiated, and P and D have no limit of their own.
    """
    if not (finite(target) and finite(measurement)):
        return 0.0
    filter_error(pid, target, measurement, dt, gains)
    integrate(pid, dt, blocked, gains)
    return pid.error * gains.p + pid.derivative * gains.d + pid.integrator + target * gains.ff


@law
def reset_filter(pid: Pid) -> None:
    """The next update takes its inputs as they are."""
    pid.started = False


@law
def relax_integrator(pid: Pid, goal: float, dt: float, time_constant: float) -> None:
    """Let the integrator decay towards ``goal`` with a time constant [s]."""
    pid.integrator += (goal - pid.integrator) * dt / (dt + time_constant)
