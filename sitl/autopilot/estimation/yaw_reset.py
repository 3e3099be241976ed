# SPDX-License-Identifier: BSD-3-Clause
"""When the bank of yaw filters runs, and when the filters jump to its yaw (EK3_GSF_*)."""

from __future__ import annotations

from ...core.algebra import horizontal, yaw_of
from ...core.border import Sensors
from ...core.kernels import law
from ...core.scalars import wrap_pi
from ..events import emit
from ..gps_receivers import Fix, fix_of
from ..params.firmware_parameters import Parameters
from ..state import Autopilot, Estimate
from . import gps, noise, yaw_bank
from .aiding import reset_to_fix
from .covariance import clear
from .estimator_events import EKF_EMERGENCY_YAW
from .magnetometer import clear_samples
from .state import BG, THETA, Ekf
from .yaw_bank import YawBank

TILT = 0.05
"""Standard deviation of the tilt of the bank [rad]."""


@law
def has_bit(mask: float, imu: int) -> bool:
    """Whether a mask has the bit of a filter."""
    return int(mask) >> imu & 1 != 0


@law
def jump(ekf: Ekf, estimate: Estimate, bank: YawBank, fix: Fix, age: float) -> None:
    """Take attitude and gyro bias of the bank, and position and velocity of the last fix, ``age`` [s] old."""
    before = yaw_of(ekf.q)
    ekf.q, ekf.gyro_bias = yaw_bank.attitude(bank), bank.gyro_bias
    clear(ekf.P, THETA, 3, TILT * TILT)
    ekf.P[THETA + 2, THETA + 2] = bank.variance
    clear(ekf.P, BG, 3, noise.INITIAL_GYRO_BIAS * noise.INITIAL_GYRO_BIAS)
    clear_samples(ekf)
    estimate.reset_yaw = wrap_pi(yaw_of(ekf.q) - before)
    estimate.reset_yaw_count += 1
    reset_to_fix(ekf, estimate, fix, age)
    ekf.pos_fused_us = ekf.vel_fused_us = ekf.gps_passed_us = ekf.now_us
    ekf.gps_glitch = False
    ekf.compass_lies = True
    estimate.variance_vel = estimate.variance_pos = estimate.variance_mag = 0.0


@law
def answer(ap: Autopilot, fix: Fix, age: float) -> None:
    """Each filter that may jumps to the yaw that the failsafe has asked for; one stands for both while it is alone."""
    bank, second, params = ap.yaw_bank, ap.second_lane, ap.params.EK3
    if bank.resets >= params.GSF_RST_MAX or not has_bit(params.GSF_USE_MASK, ap.ekf.imu):
        return
    jump(ap.ekf, ap.estimate, bank, fix, age)
    emit(ap.events, ap.ekf.now_us, EKF_EMERGENCY_YAW, float(ap.ekf.imu), 0.0)
    other = 1 - ap.ekf.imu
    if has_bit(params.GSF_USE_MASK, other):
        if second.runs != 0 and second.ekf.phase == ap.ekf.phase:
            jump(second.ekf, second.estimate, bank, fix, age)
        emit(ap.events, ap.ekf.now_us, EKF_EMERGENCY_YAW, float(other), 0.0)
    bank.resets += 1
    bank.asked_us = 0
    bank.runs = False


@law
def take_fix(ap: Autopilot, sensors: Sensors, params: Parameters) -> None:
    """Fuse the receiver's last fix into the bank, and answer the failsafe once its yaw is good."""
    ekf, bank = ap.ekf, ap.yaw_bank
    fix = fix_of(ap.gps.primary, sensors)
    if not gps.is_sane(fix):
        return
    when_us = ekf.gps_arrival_us - gps.delay_of(ap.gps.primary, params)
    yaw_bank.fuse(bank, 0.01 * horizontal(fix.gps_vel), when_us)
    if bank.asked_us != 0 and yaw_bank.is_good(bank):
        answer(ap, fix, 1e-6 * (ekf.now_us - when_us))


@law
def step(ap: Autopilot, sensors: Sensors, has_fix: bool) -> None:
    """Each filter step while the bank runs, or should: while the filter doubts its measurements in the air."""
    ekf, bank, armed = ap.ekf, ap.yaw_bank, ap.arming.armed
    if not armed:
        bank.runs = ekf.compass_lies = ap.second_lane.ekf.compass_lies = False
        bank.resets, bank.asked_us = 0, 0
        return
    if ekf.now_us - bank.asked_us > yaw_bank.ASKED_US:
        bank.asked_us = 0
    if ekf.doubt_us == 0 and bank.asked_us == 0:
        bank.runs = False
    elif not bank.runs and ekf.absolute and has_bit(ap.params.EK3.GSF_RUN_MASK, ekf.imu):
        yaw_bank.begin(bank, ekf.q, ekf.gyro_bias, ekf.acc_bias)
    if not bank.runs:
        return
    yaw_bank.keep(bank, ekf.now_us)
    if has_fix:
        take_fix(ap, sensors, ap.params)
