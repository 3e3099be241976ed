# SPDX-License-Identifier: BSD-3-Clause
"""Flight on when vibration biases the vertical acceleration (FS_VIBE_ENABLE).

The estimate then runs away from GPS and barometer: its height and its vertical speed are both too low. After a second
of that, height is controlled by its own rate of change, and with gains that need no measured acceleration, until
fifteen good seconds have passed. https://ardupilot.org/copter/docs/vibration-failsafe.html

ArduPilot's acts when the test of the velocity fails. This estimator follows the GPS faster, so that its test still
passes at a bias of 2 m/s^2, at which ArduPilot's fails; here the errors themselves count.
"""

from __future__ import annotations

from ....core.constants import GRAVITY
from ....core.kernels import inlined, law
from ....core.scalars import TWO_PI
from ...control.pid import Blocked, Pid
from ...state import Estimate
from .state import DT, VibrationState

NOTHING, BEGINS, ENDS = 0, 1, 2
"""What ``watch`` sees."""
LASTS_US, GOOD_US = 1_000_000, 15_000_000
RUNS_SPEED, RUNS_HEIGHT, GOOD_SPEED = 1.0, 0.3, 0.5
"""Errors of the estimate's vertical speed [m/s] and height [m]: above these it runs away, below the last it is good."""
_FILTER = 2.0 * TWO_PI
"""Corner of the complementary filter [rad/s]: ArduPilot's EK3_HRT_FILT."""
_P, _I = 0.25, 0.125
"""Shares of hover throttle per gravity for an acceleration, and of the integrator's for a speed."""


@inlined
def follow_height(filtered: VibrationState, est: Estimate) -> None:
    """Every tick: height, its rate and the bias of the acceleration from a filter with three equal poles."""
    error, w = est.pos.z - filtered.pos, _FILTER
    filtered.bias += error * (w * w * w) * DT
    filtered.vel += (est.acc_ned.z + filtered.bias + error * (3.0 * w * w)) * DT
    filtered.pos += (filtered.vel + error * (3.0 * w)) * DT


@law
def watch(state: VibrationState, est: Estimate, watched: bool, time_us: int) -> int:
    """Ten times a second: BEGINS, ENDS or NOTHING; ``watched``: the vehicle is armed and FS_VIBE_ENABLE is set."""
    error = est.innovation_vel_d
    if watched and error > RUNS_SPEED and est.innovation_pos_d > RUNS_HEIGHT:
        state.good_us = 0
        if state.since_us == 0:
            state.since_us = time_us
        if not state.found and time_us - state.since_us > LASTS_US:
            state.found = True
            return BEGINS
        return NOTHING
    state.since_us = 0
    if not state.found:
        return NOTHING
    if watched and error > GOOD_SPEED:
        state.good_us = 0
        return NOTHING
    if state.good_us == 0:
        state.good_us = time_us
    if time_us - state.good_us <= GOOD_US:
        return NOTHING
    state.found = False
    return ENDS


@law
def throttle_without_acceleration(
    pid: Pid, error: float, accel: float, vel_p: float, hover: float, blocked: Blocked
) -> float:
    """Throttle to be taken off that of hovering for an acceleration [m/s^2] that is not measured.

    Args:
        pid: of the acceleration; its integrator goes on, by the error of the vertical speed.
        error: of the vertical speed, down positive [m/s].
        accel: asked for, down positive.
        vel_p: PSC_VELZ_P.
        hover: throttle.
        blocked: throttle is at its least (down) or greatest (up).
    """
    per_accel = hover / GRAVITY
    shrinks = pid.integrator * error < 0.0
    if shrinks or not (blocked.down or blocked.up):
        pid.integrator += DT * per_accel * error * vel_p * _I
    return _P * per_accel * accel + pid.integrator
