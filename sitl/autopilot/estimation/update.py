# SPDX-License-Identifier: BSD-3-Clause
"""The estimator's units: strapdown navigation every tick, a step of the Kalman filter every fifth."""

from __future__ import annotations

from ...core.algebra import IDENTITY
from ...core.kernels import law, unit
from ...core.vectors import Vec3
from .. import events
from . import alignment, barometer, covariance, fusion, gps, history, magnetometer, noise, status, strapdown
from .alignment import CALIBRATE, RUN, TILT, YAW
from .state import POS, VEL

DT = 0.0025
STEP_TICKS = 5
"""Ticks a filter step: 80 Hz."""
HOLD_US = 100_000
"""Period of the synthetic measurements without GPS."""


@law
def hold(ap, now_us):
    """Without GPS: zero velocity and a fixed position on the ground, a loosely fixed position in flight."""
    ekf = ap.ekf
    if now_us - ekf.hold_us < HOLD_US:
        return 0
    ekf.hold_us = now_us
    if ap.arming.armed == 0:
        for k in range(2):
            fusion.fuse_state(ekf, VEL + k, -ekf.vel[k], noise.STILL_VELOCITY * noise.STILL_VELOCITY)
            fusion.fuse_state(ekf, POS + k, ekf.hold_pos[k] - ekf.pos[k], noise.STILL_POSITION * noise.STILL_POSITION)
    else:
        sigma = ap.params.EK3.NOAID_M_NSE
        for k in range(2):
            fusion.fuse_state(ekf, POS + k, ekf.hold_pos[k] - ekf.pos[k], sigma * sigma)
    return 1


@unit
def step(fleet, i):
    """Prediction of the covariance over the last ticks, then fusion of what the sensors brought."""
    v = fleet[i]
    ap = v.autopilot
    ekf = ap.ekf
    now_us = v.time_us
    covariance.predict(ekf, ap.params)
    ekf.step_ticks = 0
    ekf.step_dt = 0.0
    for k in range(3):
        ekf.step_dv[k] = 0.0
    history.keep(ekf, now_us)
    fused = barometer.fuse(ap, now_us)
    fused += magnetometer.fuse(ap, now_us)
    fused += gps.fuse(ap, v.sensors, now_us)
    if ekf.gps_in_use == 0:
        fused += hold(ap, now_us)
    if fused > 0:
        fusion.inject(ekf, ap.params.EK3.ACC_BIAS_LIM, now_us)
        covariance.bound(ekf)
    if ekf.phase == TILT:
        alignment.check_tilt(ekf, ap.events, now_us)
    elif ekf.phase == YAW and ekf.yaw_aligned != 0:
        ekf.phase = RUN
    if ap.arming.armed == 0:
        ekf.ground_d = ekf.pos[2]
        ekf.yaw_in_flight = 0
    if not alignment.healthy(ekf):
        if ekf.gps_in_use != 0:
            events.emit(ap.events, now_us, events.EKF_STOPPED_GPS, 1.0, 0.0)
        alignment.restart(ekf, now_us)
    status.publish_status(ap, now_us)


@law
def _boot(ap, now_us):
    """A tick of gyro calibration."""
    ekf, estimate = ap.ekf, ap.estimate
    if ap.params.EK3.ENABLE == 0:
        return
    if alignment.calibrate(ekf, now_us) != 0:
        barometer.set_ground(ekf)
        alignment.initialise(ekf, now_us)
        events.emit(ap.events, now_us, events.EKF_INITIALISED, 0.0, 0.0)
        return
    ekf.q[0] = 1.0
    estimate.q = IDENTITY
    estimate.status_flags = status.UNINITIALIZED
    estimate.rates = Vec3(ekf.good_gyro[0], ekf.good_gyro[1], ekf.good_gyro[2])


@unit
def update(fleet, i):
    """One tick: ``sensors`` to ``autopilot.estimate``."""
    v = fleet[i]
    ap = v.autopilot
    ekf = ap.ekf
    if ekf.use_external != 0:
        return
    ekf.now_us = v.time_us
    strapdown.read_imu(ekf, v.sensors)
    barometer.read(ekf, v.sensors, v.time_us)
    gps.read(ekf, v.sensors, v.time_us)
    if ekf.phase == CALIBRATE:
        _boot(ap, v.time_us)
        return
    strapdown.advance(ekf, DT)
    magnetometer.read(ekf, v.sensors, v.time_us)
    if ekf.step_ticks >= STEP_TICKS:
        step(fleet, i)
    status.publish(ap, DT)
