# SPDX-License-Identifier: BSD-3-Clause
"""Rate loops: body rates to roll, pitch and yaw demands of the motors (ATC_RAT_*), every tick."""

from __future__ import annotations

from ....core.algebra import vec3_of
from ....core.kernels import law
from ...control.pid import PidGains, relax_integrator, reset_filter, update_pid
from ..state import Autopilot
from .motors import GROUND_IDLE, SHUT_DOWN
from .state import DT, RateState

RELAX_TIME = 0.16
"""Time constant with which integrators decay on the ground [s] (ArduPilot's)."""


@law
def roll_gains(ap: Autopilot) -> PidGains:
    """ATC_RAT_RLL_*."""
    p = ap.params
    return PidGains(
        p.ATC_RAT_RLL_P, p.ATC_RAT_RLL_I, p.ATC_RAT_RLL_D, p.ATC_RAT_RLL_FF, p.ATC_RAT_RLL_D_FF,
        p.ATC_RAT_RLL_IMAX, p.ATC_RAT_RLL_PDMX, p.ATC_RAT_RLL_FLTT, p.ATC_RAT_RLL_FLTE, p.ATC_RAT_RLL_FLTD,
    )  # fmt: skip


@law
def pitch_gains(ap: Autopilot) -> PidGains:
    """ATC_RAT_PIT_*."""
    p = ap.params
    return PidGains(
        p.ATC_RAT_PIT_P, p.ATC_RAT_PIT_I, p.ATC_RAT_PIT_D, p.ATC_RAT_PIT_FF, p.ATC_RAT_PIT_D_FF,
        p.ATC_RAT_PIT_IMAX, p.ATC_RAT_PIT_PDMX, p.ATC_RAT_PIT_FLTT, p.ATC_RAT_PIT_FLTE, p.ATC_RAT_PIT_FLTD,
    )  # fmt: skip


@law
def yaw_gains(ap: Autopilot) -> PidGains:
    """ATC_RAT_YAW_*."""
    p = ap.params
    return PidGains(
        p.ATC_RAT_YAW_P, p.ATC_RAT_YAW_I, p.ATC_RAT_YAW_D, p.ATC_RAT_YAW_FF, p.ATC_RAT_YAW_D_FF,
        p.ATC_RAT_YAW_IMAX, p.ATC_RAT_YAW_PDMX, p.ATC_RAT_YAW_FLTT, p.ATC_RAT_YAW_FLTE, p.ATC_RAT_YAW_FLTD,
    )  # fmt: skip


@law
def control_rates(ap: Autopilot) -> None:
    """Demands from ``attitude.rate_target`` and ``estimate.rates``; the mixer's limit flags of the last tick
    hold integrators. The trim of the last flight is forgotten while the motors stand or idle on the ground.
    """
    rate = ap.control.rate
    motors = ap.control.motors
    if motors.spool_state == SHUT_DOWN:
        reset_integrators(rate)
    elif motors.spool_state == GROUND_IDLE:
        relax_integrators(rate)
    rates, target = vec3_of(ap.estimate.rates), ap.control.attitude.rate_target
    motors.roll = update_pid(rate.roll, target.x, rates.x, DT, motors.limit_roll, roll_gains(ap))
    motors.pitch = update_pid(rate.pitch, target.y, rates.y, DT, motors.limit_pitch, pitch_gains(ap))
    motors.yaw = update_pid(rate.yaw, target.z, rates.z, DT, motors.limit_yaw, yaw_gains(ap))


@law
def reset_filters(rate: RateState) -> None:
    """Start the filters of all three loops afresh."""
    reset_filter(rate.roll)
    reset_filter(rate.pitch)
    reset_filter(rate.yaw)


@law
def relax_integrators(rate: RateState) -> None:
    """Let the trim of all three loops decay (motors idle on the ground)."""
    relax_integrator(rate.roll, 0.0, DT, RELAX_TIME)
    relax_integrator(rate.pitch, 0.0, DT, RELAX_TIME)
    relax_integrator(rate.yaw, 0.0, DT, RELAX_TIME)


@law
def reset_integrators(rate: RateState) -> None:
    """Forget the trim of all three loops (motors stand, attitude relaxed)."""
    rate.roll.integrator = 0.0
    rate.pitch.integrator = 0.0
    rate.yaw.integrator = 0.0
