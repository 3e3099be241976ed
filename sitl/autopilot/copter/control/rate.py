# SPDX-License-Identifier: BSD-3-Clause
"""Rate loops: body rates to roll, pitch and yaw demands of the motors (ATC_RAT_*), every tick."""

from __future__ import annotations

from ....core.kernels import law
from ....core.vectors import Vec3
from ...control.pid import pid_gains, relax_integrator, reset_filter, update_pid
from ..parameters.control import Attitude
from .spool import SpoolState
from .state import DT, MotorsState, RateState

RELAX_TIME = 0.16
"""Time constant with which integrators decay on the ground [s] (ArduPilot's)."""


@law
def control_rates(rate: RateState, motors: MotorsState, target: Vec3, rates: Vec3, params: Attitude) -> None:
    """Demands of the motors that bring body rates [rad/s] to their target.

    The mixer's limit flags of the last tick hold integrators. The trim of the last flight is forgotten while the
    motors stand or idle on the ground.
    """
    if motors.spool_state == SpoolState.SHUT_DOWN:
        reset_integrators(rate)
    elif motors.spool_state == SpoolState.GROUND_IDLE:
        relax_integrators(rate)
    motors.roll = update_pid(rate.roll, target.x, rates.x, DT, motors.limit_roll, pid_gains(params.RAT_RLL))
    motors.pitch = update_pid(rate.pitch, target.y, rates.y, DT, motors.limit_pitch, pid_gains(params.RAT_PIT))
    motors.yaw = update_pid(rate.yaw, target.z, rates.z, DT, motors.limit_yaw, pid_gains(params.RAT_YAW))
    if motors.excited:
        motors.excited = False
        motors.roll += motors.excitation.x
        motors.pitch += motors.excitation.y
        motors.yaw += motors.excitation.z


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
