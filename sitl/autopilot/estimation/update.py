# SPDX-License-Identifier: BSD-3-Clause
"""The estimator's units: strapdown navigation every tick, a step of the Kalman filter every fifth."""

from __future__ import annotations

from ...core.algebra import IDENTITY
from ...core.kernels import inline_unit, law
from ...core.records import Records
from .. import events
from ..inertial_filter import smoothed_acc, smoothed_rates
from ..sensor_calibration import read_sensors
from ..state import Autopilot, Estimate, Vehicle
from . import alignment, barometer, covariance, fusion, gps, history, magnetometer, noise, status, strapdown
from .alignment import CALIBRATE, RUN, TILT, YAW
from .state import POS, VEL, Ekf

DT = 0.0025
STEP_TICKS = 5
"""Ticks a filter step: 80 Hz."""
HOLD_US = 100_000
"""Period of the synthetic measurements without GPS."""


@law
def hold(ekf: Ekf, armed: bool, sigma: float) -> bool:
    """Without GPS: zero velocity and a fixed position on the ground, one fixed within ``sigma`` [m] in flight.

    Whether something was fused.
    """
    if ekf.now_us - ekf.hold_us < HOLD_US:
        return False
    ekf.hold_us = ekf.now_us
    north, east = ekf.hold_pos.x - ekf.pos.x, ekf.hold_pos.y - ekf.pos.y
    if armed:
        fusion.fuse_state(ekf, POS, north, sigma * sigma)
        fusion.fuse_state(ekf, POS + 1, east, sigma * sigma)
    else:
        fusion.fuse_state(ekf, VEL, -ekf.vel.x, noise.STILL_VELOCITY * noise.STILL_VELOCITY)
        fusion.fuse_state(ekf, POS, north, noise.STILL_POSITION * noise.STILL_POSITION)
        fusion.fuse_state(ekf, VEL + 1, -ekf.vel.y, noise.STILL_VELOCITY * noise.STILL_VELOCITY)
        fusion.fuse_state(ekf, POS + 1, east, noise.STILL_POSITION * noise.STILL_POSITION)
    return True


@law
def watch_alignment(ekf: Ekf, log: events.Events, armed: bool) -> None:
    """From phase to phase of the alignment; a filter that lost its health begins anew."""
    if ekf.phase == TILT:
        alignment.check_tilt(ekf, log)
    elif ekf.phase == YAW and ekf.yaw_aligned:
        ekf.phase = RUN
    if not armed:
        ekf.ground_d = ekf.pos.z
        ekf.yaw_in_flight = False
    if not alignment.is_healthy(ekf):
        if ekf.gps_in_use:
            events.emit(log, ekf.now_us, events.EKF_STOPPED_GPS, 1.0, 0.0)
        alignment.restart(ekf)


@inline_unit
def step(fleet: Records[Vehicle], i: int) -> None:
    """Prediction of the covariance over the last ticks, then fusion of what the sensors brought."""
    v = fleet[i]
    ap = v.autopilot
    ekf, estimate, params, armed = ap.ekf, ap.estimate, ap.params.EK3, ap.arming.armed
    covariance.predict(ekf, params)
    alignment.begin_step(ekf)
    history.keep(ekf)
    fused = barometer.fuse(ekf, estimate, params)
    fused |= magnetometer.fuse(ekf, estimate, ap.events, params, armed)
    fused |= gps.fuse(ekf, estimate, ap.events, ap.params, v.sensors)
    if not ekf.gps_in_use:
        fused |= hold(ekf, armed, params.NOAID_M_NSE)
    if fused:
        fusion.inject(ekf, params.ACC_BIAS_LIM)
        covariance.bound(ekf.P)
    watch_alignment(ekf, ap.events, armed)
    status.publish_status(ekf, estimate)


@law
def _boot(ekf: Ekf, estimate: Estimate, log: events.Events) -> None:
    """A tick of gyro calibration."""
    if alignment.calibrate(ekf):
        barometer.set_ground(ekf)
        alignment.initialise(ekf)
        events.emit(log, ekf.now_us, events.EKF_INITIALISED, 0.0, 0.0)
        return
    ekf.q = IDENTITY
    estimate.q = IDENTITY
    estimate.status_flags = status.UNINITIALIZED
    estimate.rates = ekf.good_gyro


@law
def smooth(ap: Autopilot) -> None:
    """Low-pass what controllers see of rates and acceleration."""
    e, params = ap.estimate, ap.params.INS
    e.rates = smoothed_rates(ap.inertial_filter, e.rates, params)
    e.acc_ned = smoothed_acc(ap.inertial_filter, e.acc_ned, params)


@inline_unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """One tick: ``sensors`` to ``autopilot.estimate``."""
    v = fleet[i]
    ap, sensors = v.autopilot, v.sensors
    ekf, shown = ap.ekf, ap.calibrated
    read_sensors(shown, sensors, ap.params)
    if ekf.use_external:
        smooth(ap)
        return
    ekf.now_us = v.time_us
    strapdown.read_imu(ekf, shown.gyro, shown.acc)
    barometer.read(ekf, sensors)
    gps.read(ekf, sensors)
    if ekf.phase == CALIBRATE:
        if ap.params.EK3.ENABLE != 0:
            _boot(ekf, ap.estimate, ap.events)
        return
    strapdown.advance(ekf, DT)
    magnetometer.read(ekf, sensors.mag_count, shown.mag)
    if ekf.step_ticks >= STEP_TICKS:
        step(fleet, i)
    status.publish(ekf, ap.estimate, DT, ap.params.EK3.TAU_OUTPUT)
    smooth(ap)
