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
        p.ATC.RAT_RLL.P, p.ATC.RAT_RLL.I, p.ATC.RAT_RLL.D, p.ATC.RAT_RLL.FF, p.ATC.RAT_RLL.D_FF,
        p.ATC.RAT_RLL.IMAX, p.ATC.RAT_RLL.PDMX, p.ATC.RAT_RLL.FLTT, p.ATC.RAT_RLL.FLTE, p.ATC.RAT_RLL.FLTD,
    )  # fmt: skip
    motors.pitch = update_saturating(
        rate.pitch, float(target[1]), float(rates[1]), DT, motors.limit_pitch != 0,
        p.ATC.RAT_PIT.P, p.ATC.RAT_PIT.I, p.ATC.RAT_PIT.D, p.ATC.RAT_PIT.FF, p.ATC.RAT_PIT.D_FF,
        p.ATC.RAT_PIT.IMAX, p.ATC.RAT_PIT.PDMX, p.ATC.RAT_PIT.FLTT, p.ATC.RAT_PIT.FLTE, p.ATC.RAT_PIT.FLTD,
    )  # fmt: skip
    motors.yaw = update_saturating(
        rate.yaw, float(target[2]), float(rates[2]), DT, motors.limit_yaw != 0,
        p.ATC.RAT_YAW.P, p.ATC.RAT_YAW.I, p.ATC.RAT_YAW.D, p.ATC.RAT_YAW.FF, p.ATC.RAT_YAW.D_FF,
        p.ATC.RAT_YAW.IMAX, p.ATC.RAT_YAW.PDMX, p.ATC.RAT_YAW.FLTT, p.ATC.RAT_YAW.FLTE, p.ATC.RAT_YAW.FLTD,
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
