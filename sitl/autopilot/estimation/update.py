# SPDX-License-Identifier: BSD-3-Clause
"""The estimator's units: strapdown navigation every tick, a step of the Kalman filter every fifth."""

from __future__ import annotations

from ...core.algebra import IDENTITY
from ...core.border import BAROS_DIFFER, IMUS_DIFFER
from ...core.constants import TICK_S
from ...core.kernels import inline_unit, inlined, law, unit
from ...core.records import Records
from .. import barometers, gps_receivers, optical_flow
from ..events import Events, emit
from ..inertial_filter import smoothed_acc, smoothed_rates
from ..sensor_calibration import field_of, read_sensors
from ..state import Autopilot, Estimate, Vehicle
from ..vibration import compare_clips
from . import (
    alignment,
    barometer,
    compass,
    covariance,
    doubt,
    external,
    flow,
    fusion,
    gps,
    heading,
    history,
    lanes,
    magnetometer,
    noise,
    sources,
    status,
    strapdown,
    yaw_bank,
    yaw_reset,
)
from .alignment import CALIBRATE, RUN, TILT, YAW
from .estimator_events import EKF_INITIALISED, EKF_STOPPED_GPS, EKF_USES
from .state import POS, VEL, Ekf

DT = TICK_S
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
def watch_alignment(ekf: Ekf, log: Events, armed: bool) -> None:
    """From phase to phase of the alignment; a filter that lost its health begins anew."""
    if ekf.phase == TILT:
        alignment.check_tilt(ekf, log)
    elif ekf.phase == YAW and ekf.yaw_aligned:
        ekf.phase = RUN
    if not armed:
        ekf.ground_d = ekf.pos.z
        ekf.yaw_in_flight = False
    if not alignment.is_healthy(ekf):
        if ekf.absolute:
            emit(log, ekf.now_us, EKF_STOPPED_GPS, float(ekf.imu), 0.0)
        alignment.restart(ekf)


@law
def fuse_others(v: Vehicle, ekf: Ekf, estimate: Estimate) -> bool:
    """Sources other than GPS and compass. Whether something was fused."""
    ap = v.autopilot
    source = ap.params.EK3.SRC[ekf.source_set]
    flow.read_range(ekf, v.sensors)
    fused = False
    if source.VELXY == sources.FLOW:
        fused = flow.fuse(ekf, estimate, ap.events, ap.flow, ap.params.EK3)
    if ap.odometry.kind != 0:
        fused |= external.fuse(ekf, estimate, ap.events, ap.odometry, source, ap.params.EK3, ap.params.VISO)
    if ekf.absolute and source.POSXY != sources.GPS and source.POSXY != sources.EXTERNAL:
        ekf.absolute = False
        ekf.relative, ekf.relative_us = True, ekf.now_us
        if source.VELXY == sources.FLOW:
            emit(ap.events, ekf.now_us, EKF_USES, float(ekf.imu), flow.BY_FLOW)
    flow.watch(ekf, estimate, ap.events, sources.aid(source))
    return fused


@unit
def step_bank(fleet: Records[Vehicle], i: int, has_fix: int) -> None:
    """A filter step of the bank of yaw filters, where it runs or should."""
    v = fleet[i]
    yaw_reset.step(v.autopilot, v.sensors, has_fix != 0)


@inline_unit
def step(fleet: Records[Vehicle], i: int, lane: int) -> None:
    """Prediction of the covariance over the last ticks, then fusion of what the sensors brought; ``lane``: 0, or 1 for
    the second filter.
    """
    v = fleet[i]
    ap = v.autopilot
    ekf, estimate = (ap.second_lane.ekf, ap.second_lane.estimate) if lane else (ap.ekf, ap.estimate)
    params, armed = ap.params.EK3, ap.arming.armed
    source = params.SRC[ekf.source_set]
    usual = sources.are_usual(source)
    covariance.predict(ekf, params)
    ekf.blames_imu = ap.second_lane.runs != 0
    if ekf.doubt_us != 0:
        doubt.watch(ekf)
    alignment.begin_step(ekf)
    history.keep(ekf)
    fused = False
    if gps.gives_height(ekf, estimate, source):
        barometer.follow(ekf)
    elif usual or not (source.POSZ == sources.EXTERNAL and ekf.absolute):
        fused |= barometer.fuse(ekf, estimate, params)
    else:
        barometer.follow(ekf)
        ekf.baro_fused_us = ekf.now_us
    otherwise = not usual and (source.YAW == sources.EXTERNAL or source.YAW == sources.NONE)
    ekf.without_compass = ekf.compass_lies or otherwise
    if not ekf.without_compass:
        compass.watch(ekf, ap.events, v.sensors, ap.params, armed, ap.second_lane.runs == 0)
        ekf.heading_only = params.MAG_CAL != heading.ALWAYS
        if ekf.heading_only:
            fused |= heading.fuse(ekf, estimate, ap.events, params, armed)
        else:
            fused |= magnetometer.fuse(ekf, estimate, ap.events, params, armed)
    else:
        magnetometer.clear_samples(ekf)
    has_fix = 1 if ekf.gps_new else 0
    fused |= gps.fuse(ekf, estimate, ap.events, ap.params, v.sensors, source, ap.gps.primary)
    if not usual or ekf.relative:
        fused |= fuse_others(v, ekf, estimate)
    if not (ekf.absolute or (ekf.relative and armed)):
        fused |= hold(ekf, armed, params.NOAID_M_NSE)
    if fused:
        fusion.inject(ekf, params.ACC_BIAS_LIM)
        covariance.bound(ekf.P)
    watch_alignment(ekf, ap.events, armed)
    if lane == 0 and (ap.yaw_bank.runs or ekf.doubt_us != 0 or ekf.compass_lies):
        step_bank(fleet, i, has_fix)
    status.publish_status(ekf, estimate)


@law
def _boot(ekf: Ekf, estimate: Estimate, log: Events) -> None:
    """A tick of gyro calibration."""
    if alignment.calibrate(ekf):
        barometer.set_ground(ekf)
        alignment.initialise(ekf)
        emit(log, ekf.now_us, EKF_INITIALISED, float(ekf.imu), 0.0)
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


@inlined
def run_lane(fleet: Records[Vehicle], i: int, lane: int) -> None:
    """One tick of a filter: the one that is flown by (0), or the second one."""
    v = fleet[i]
    ap, sensors = v.autopilot, v.sensors
    ekf, estimate = (ap.second_lane.ekf, ap.second_lane.estimate) if lane else (ap.ekf, ap.estimate)
    shown, state = ap.calibrated, sensors.imu_state
    ekf.now_us = v.time_us
    if state == 0:
        strapdown.read_imu(ekf, shown.gyro, shown.acc)
    else:
        strapdown.read_imu(ekf, lanes.gyro_of(ekf.imu, shown, state), lanes.acc_of(ekf.imu, shown, state))
    if barometers.uses_second(ap.baros, sensors):
        barometer.read(ekf, sensors.baro2_count, sensors.abs_pressure2)
    else:
        barometer.read(ekf, sensors.baro_count, sensors.abs_pressure)
    gps.read(ekf, gps_receivers.count_of(ap.gps.primary, sensors))
    if ekf.phase == CALIBRATE:
        if ap.params.EK3.ENABLE != 0:
            _boot(ekf, estimate, ap.events)
        return
    strapdown.advance(ekf, DT)
    if ekf.compass == 0:
        magnetometer.read(ekf, sensors.mag_count, shown.mag)
    else:
        magnetometer.read(ekf, int(sensors.mag_us[ekf.compass]), field_of(ekf.compass, sensors, ap.params))
    if ekf.step_ticks >= STEP_TICKS:
        step(fleet, i, lane)
    status.publish(ekf, estimate, DT, ap.params.EK3.TAU_OUTPUT)


@unit
def choose_sensors(fleet: Records[Vehicle], i: int) -> None:
    """Before the filters, where there are two GPS receivers or two barometers that differ: which of them they get."""
    v = fleet[i]
    ap, sensors = v.autopilot, v.sensors
    if ap.params.GPS2_TYPE != 0.0:
        gps_receivers.choose(ap.gps, sensors, ap.params, v.time_us)
    if sensors.baro_state & BAROS_DIFFER != 0:
        barometers.choose(ap.baros, sensors, ap.params.BARO_PRIMARY, v.time_us)


@unit
def advance_bank(fleet: Records[Vehicle], i: int) -> None:
    """One tick of the bank of yaw filters, while it runs."""
    ap = fleet[i].autopilot
    yaw_bank.advance(ap.yaw_bank, ap.ekf.good_gyro, ap.ekf.good_acc, DT)


@unit
def prepare_lanes(fleet: Records[Vehicle], i: int) -> None:
    """Before the filters, while the IMUs differ or two run: clipped samples, and whether there is a second filter."""
    v = fleet[i]
    ap, sensors = v.autopilot, v.sensors
    lanes.begin_or_end(ap, sensors, v.time_us)
    if sensors.imu_state & IMUS_DIFFER != 0:
        compare_clips(ap.vibration, ap.calibrated.acc, ap.calibrated.acc2)


@unit
def run_second(fleet: Records[Vehicle], i: int) -> None:
    """One tick of the second filter, and which of the two is flown by."""
    run_lane(fleet, i, 1)
    ap = fleet[i].autopilot
    if ap.ekf.step_ticks == 0:
        lanes.compare(ap, ap.params.EK3)


@inline_unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """One tick: ``sensors`` to ``autopilot.estimate``."""
    v = fleet[i]
    ap, sensors = v.autopilot, v.sensors
    read_sensors(ap.calibrated, sensors, ap.params)
    if ap.ekf.use_external:
        smooth(ap)
        return
    boots = ap.ekf.phase == CALIBRATE
    second = ap.second_lane
    if sensors.imu_state | second.runs != 0:
        prepare_lanes(fleet, i)
    if ap.flow.kind != 0:
        optical_flow.read(ap.flow, sensors, v.time_us, ap.params.FLOW)
    if ap.params.GPS2_TYPE != 0.0 or sensors.baro_state & BAROS_DIFFER != 0:
        choose_sensors(fleet, i)
    run_lane(fleet, i, 0)
    if ap.yaw_bank.runs:
        advance_bank(fleet, i)
    if second.runs != 0:
        run_second(fleet, i)
    if not boots:
        smooth(ap)
