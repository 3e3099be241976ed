# SPDX-License-Identifier: BSD-3-Clause
"""Two filters, one on each IMU, and which of them the vehicle is flown by.

While both IMUs show the same, a second filter would say what the first says, so there is one. When they begin to
differ, the second filter begins as a copy of the first, on the other IMU. From then on both run, and the one that
agrees better with GPS and barometer is flown by. When the IMUs have shown the same again for a minute, the second
ends.

What a user sees of it is described in https://ardupilot.org/copter/docs/common-ek3-affinity-lane-switching.html
"""

from __future__ import annotations

from ...core.algebra import yaw_of
from ...core.border import ACC_SILENT, GYRO_SILENT, IMUS_DIFFER, Sensors
from ...core.kernels import law
from ...core.memory import words_of
from ...core.records import Ints
from ...core.scalars import wrap_pi
from ...core.vectors import Vec3
from ..events import emit
from ..params.estimator import Ekf3
from ..sensor_calibration import Calibrated
from ..state import Autopilot, Estimate
from . import alignment
from .alignment import RUN
from .estimator_events import EKF_LANE_SWITCHED
from .state import Ekf

FAILED_SCORE = 1.0
"""A filter with this score disagrees with its sensors: any better one is taken at once."""
LEAD = 1.0
"""Sum of scores, filter step by filter step, by which the other filter must have been better."""
MERGE_US = 60_000_000
"""The second filter ends when the IMUs have shown the same for so long."""


@law
def _copy(to: Ints, source: Ints) -> None:
    for k in range(len(to)):
        to[k] = source[k]


@law
def _exchange(one: Ints, other: Ints) -> None:
    for k in range(len(one)):
        kept = one[k]
        one[k] = other[k]
        other[k] = kept


@law
def acc_of(imu: int, shown: Calibrated, state: int) -> Vec3:
    """Specific force [m/s^2] for the filter of an IMU: of the other one while its own sends nothing."""
    second = imu == 1
    if state & (ACC_SILENT << imu) != 0 and state & (ACC_SILENT << (1 - imu)) == 0:
        second = not second
    return shown.acc2 if second and state & IMUS_DIFFER != 0 else shown.acc


@law
def gyro_of(imu: int, shown: Calibrated, state: int) -> Vec3:
    """Body rates [rad/s] for the filter of an IMU: of the other one while its own sends nothing."""
    second = imu == 1
    if state & (GYRO_SILENT << imu) != 0 and state & (GYRO_SILENT << (1 - imu)) == 0:
        second = not second
    return shown.gyro2 if second and state & IMUS_DIFFER != 0 else shown.gyro


@law
def score(ekf: Ekf, estimate: Estimate, by_compass: bool) -> float:
    """How badly a filter agrees with its sensors: squares of test ratios, 1 at the gates; 0 while it aligns."""
    if ekf.phase != RUN:
        return 0.0
    vel, pos, height = estimate.variance_vel, estimate.variance_pos, estimate.variance_hgt
    worst = max(vel * vel, pos * pos, height * height)
    return max(worst, estimate.variance_mag * estimate.variance_mag) if by_compass else worst


@law
def begin_or_end(ap: Autopilot, sensors: Sensors, now_us: int) -> None:
    """Each tick in which the IMUs differ or there is a second filter."""
    lane = ap.second_lane
    if sensors.imu_state != 0:
        lane.differ_us = now_us
        if lane.runs == 0:
            lane.runs = 1
            lane.lead = 0.0
            _copy(words_of(lane.ekf), words_of(ap.ekf))
            _copy(words_of(lane.estimate), words_of(ap.estimate))
            lane.ekf.imu = 1 - ap.ekf.imu
    elif now_us - lane.differ_us > MERGE_US:
        lane.runs = 0


@law
def switch(ap: Autopilot) -> None:
    """Fly by the other filter; controllers learn of the jump as of any other."""
    lane, seen = ap.second_lane, ap.estimate
    pos, vel = lane.estimate.pos - seen.pos, lane.estimate.vel - seen.vel
    yaw = wrap_pi(yaw_of(lane.estimate.q) - yaw_of(seen.q))
    ne, d, yaws = seen.reset_ne_count + 1, seen.reset_d_count + 1, seen.reset_yaw_count + 1
    rates, acc = seen.rates, seen.acc_ned  # low-passed
    _exchange(words_of(ap.ekf), words_of(lane.ekf))
    _exchange(words_of(seen), words_of(lane.estimate))
    seen.rates, seen.acc_ned = rates, acc
    seen.reset_pos, seen.reset_vel, seen.reset_yaw = pos, vel, yaw
    seen.reset_ne_count, seen.reset_d_count, seen.reset_yaw_count = ne, d, yaws
    lane.lead = 0.0
    emit(ap.events, ap.ekf.now_us, EKF_LANE_SWITCHED, float(ap.ekf.imu), 0.0)


@law
def compare(ap: Autopilot, params: Ekf3) -> None:
    """After a step of both filters: take the other one when it is better by far, or has been better for long."""
    lane, by_compass = ap.second_lane, int(params.AFFINITY) & AFFINITY_COMPASS != 0
    if lane.ekf.phase != RUN or not alignment.is_healthy(lane.ekf):
        return
    own, other = score(ap.ekf, ap.estimate, by_compass), score(lane.ekf, lane.estimate, by_compass)
    if abs(own - other) > params.ERR_THRESH:
        lane.lead = min(max(lane.lead + own - other, -LEAD), LEAD)
    if (other < own and (own >= FAILED_SCORE or lane.lead >= LEAD)) or (ap.arming.armed and ap.ekf.phase != RUN):
        switch(ap)


AFFINITY_COMPASS = 4
"""EK3_AFFINITY"""
