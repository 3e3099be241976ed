# SPDX-License-Identifier: BSD-3-Clause
"""Rate loops: body rates to roll, pitch and yaw demands of the motors (ATC_RAT_*), every tick."""

from __future__ import annotations

from ....core.kernels import law
from ...control.pid import relax_integrator, reset_filter, update_saturating
from .motors import GROUND_IDLE, SHUT_DOWN
from .state import DT

RELAX_TIME = 0.16
"""Time constant with which integrators decay on the ground [s] (ArduPilot's)."""


@law
def update(ap):
    """Demands from ``attitude.rate_target`` and ``estimate.rates``; the mixer's limit flags of the last tick
    hold integrators. The trim of the last flight is forgotten while the motors stand or idle on the ground.
    """
    p = ap.params
    motors = ap.control.motors
    if motors.spool_state == SHUT_DOWN:
        reset_integrators(ap)
    elif motors.spool_state == GROUND_IDLE:
        relax_integrators(ap)
    rate = ap.control.rate
    rates = ap.estimate.rates
    target = ap.control.attitude.rate_target
    motors.roll = update_saturating(
        rate.roll, float(target[0]), float(rates[0]), DT, motors.limit_roll != 0,
        p.ATC_RAT_RLL_P, p.ATC_RAT_RLL_I, p.ATC_RAT_RLL_D, p.ATC_RAT_RLL_FF, p.ATC_RAT_RLL_D_FF,
        p.ATC_RAT_RLL_IMAX, p.ATC_RAT_RLL_PDMX, p.ATC_RAT_RLL_FLTT, p.ATC_RAT_RLL_FLTE, p.ATC_RAT_RLL_FLTD,
    )  # fmt: skip
    motors.pitch = update_saturating(
        rate.pitch, float(target[1]), float(rates[1]), DT, motors.limit_pitch != 0,
        p.ATC_RAT_PIT_P, p.ATC_RAT_PIT_I, p.ATC_RAT_PIT_D, p.ATC_RAT_PIT_FF, p.ATC_RAT_PIT_D_FF,
        p.ATC_RAT_PIT_IMAX, p.ATC_RAT_PIT_PDMX, p.ATC_RAT_PIT_FLTT, p.ATC_RAT_PIT_FLTE, p.ATC_RAT_PIT_FLTD,
    )  # fmt: skip
    motors.yaw = update_saturating(
        rate.yaw, float(target[2]), float(rates[2]), DT, motors.limit_yaw != 0,
        p.ATC_RAT_YAW_P, p.ATC_RAT_YAW_I, p.ATC_RAT_YAW_D, p.ATC_RAT_YAW_FF, p.ATC_RAT_YAW_D_FF,
        p.ATC_RAT_YAW_IMAX, p.ATC_RAT_YAW_PDMX, p.ATC_RAT_YAW_FLTT, p.ATC_RAT_YAW_FLTE, p.ATC_RAT_YAW_FLTD,
    )  # fmt: skip


@law
def reset_filters(ap):
    """Start the filters of all three loops afresh."""
    reset_filter(ap.control.rate.roll)
    reset_filter(ap.control.rate.pitch)
    reset_filter(ap.control.rate.yaw)


@law
def relax_integrators(ap):
    """Let the trim of all three loops decay (motors idle on the ground)."""
    relax_integrator(ap.control.rate.roll, 0.0, DT, RELAX_TIME)
    relax_integrator(ap.control.rate.pitch, 0.0, DT, RELAX_TIME)
    relax_integrator(ap.control.rate.yaw, 0.0, DT, RELAX_TIME)


@law
def reset_integrators(ap):
    """Forget the trim of all three loops (motors stand, attitude relaxed)."""
    ap.control.rate.roll.integrator = 0.0
    ap.control.rate.pitch.integrator = 0.0
    ap.control.rate.yaw.integrator = 0.0
