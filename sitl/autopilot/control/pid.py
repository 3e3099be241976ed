# SPDX-License-Identifier: BSD-3-Clause
"""PID controller with filters on target, error and derivative, feed-forward and a limited integrator.

State is a ``Pid`` record. Cut-off frequencies are in Hz, 0 meaning no filter (ArduPilot's *_FLTT,
*_FLTE, *_FLTD). An input that is not a number leaves the state as it is and gives zero output.
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.scalars import TWO_PI, constrain, finite


@law
def lowpass_gain(hz, dt):
    """Part of the difference that a first-order low-pass takes over in one period; 1 without a filter."""
    x = TWO_PI * hz * dt
    if x <= 0.0:
        return 1.0
    return x / (1.0 + x)


@law
def filter_error(pid, target, measurement, dt, hz_target, hz_error, hz_derivative):
    """Bring target, error and derivative up to date."""
    if pid.started == 0:
        pid.started = 1
        pid.target = target
        pid.error = target - measurement
        pid.derivative = 0.0
        pid.target_derivative = 0.0
        return
    old_target = float(pid.target)
    old_error = float(pid.error)
    new_target = old_target + lowpass_gain(hz_target, dt) * (target - old_target)
    error = old_error + lowpass_gain(hz_error, dt) * (new_target - measurement - old_error)
    pid.derivative += lowpass_gain(hz_derivative, dt) * ((error - old_error) / dt - float(pid.derivative))
    pid.target_derivative = (new_target - old_target) / dt
    pid.target = new_target
    pid.error = error


@law
def integrate(pid, ki, most, dt, block_low, block_high):
    """Integrate the error unless that would drive the integrator down (block_low) or up (block_high)."""
    error = float(pid.error)
    if ki == 0.0:
        pid.integrator = 0.0
    elif not ((error < 0.0 and block_low) or (error > 0.0 and block_high)):
        pid.integrator = constrain(float(pid.integrator) + error * ki * dt, -most, most)


@law
def update_saturating(
    pid, target, measurement, dt, saturated,
    kp, ki, kd, kff, kdff, imax, pd_max, hz_target, hz_error, hz_derivative,
):  # fmt: skip
    """Output of a loop whose actuator reports only *that* it is saturated: then the integrator may only
    shrink.
    """
    if not (finite(target) and finite(measurement)):
        return 0.0
    filter_error(pid, target, measurement, dt, hz_target, hz_error, hz_derivative)
    integrator = float(pid.integrator)
    integrate(pid, ki, imax, dt, saturated and integrator <= 0.0, saturated and integrator >= 0.0)
    proportional = float(pid.error) * kp + float(pid.derivative) * kd
    if pd_max > 0.0:
        proportional = constrain(proportional, -pd_max, pd_max)
    ahead = float(pid.target) * kff + float(pid.target_derivative) * kdff
    return proportional + float(pid.integrator) + ahead


@law
def update_directional(
    pid, target, measurement, dt, block_low, block_high, kp, ki, kd, kff, imax, hz_error, hz_derivative
):
    """Output of a loop that knows in which direction its actuator is used up."""
    if not (finite(target) and finite(measurement)):
        return 0.0
    filter_error(pid, target, measurement, dt, 0.0, hz_error, hz_derivative)
    integrate(pid, ki, imax, dt, block_low, block_high)
    return float(pid.error) * kp + float(pid.derivative) * kd + float(pid.integrator) + target * kff


@law
def reset_filter(pid):
    """The next update takes its inputs as they are."""
    pid.started = 0


@law
def relax_integrator(pid, goal, dt, time_constant):
    """Let the integrator decay towards ``goal``."""
    pid.integrator += (goal - float(pid.integrator)) * dt / (dt + time_constant)
