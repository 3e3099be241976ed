# SPDX-License-Identifier: BSD-3-Clause
"""GPS: quality checks, fusion of delayed fixes, loss and return.

A fix is as old as the receiver's delay when it arrives. It is compared with the state kept from that time
(a ring of past states that every correction moves along); the measurement row refers the error of that time
to the present: dp(t - d) = dp(t) - d dv(t). Delays and alternatives: Khosravian, Trumpf, Mahony and Hamel,
"Recursive attitude estimation in the presence of multi-rate and multi-delay vector measurements", ACC 2015;
PX4's user guide, "Using the ECL EKF", describes the delayed horizon with output predictor that is not
needed here.
"""

from __future__ import annotations

import math

from ...core.geodesy import offset_ne
from ...core.kernels import law
from . import noise
from .aiding import reset_to_fix, start_using, stop_using
from .fusion import NIS_GPS_POSITION, NIS_GPS_VELOCITY, clear_row, correct, gate_ratio, innovate
from .history import slot_at
from .magnetometer import learn_field
from .origin import place_origin
from .state import BG, POS, VEL

DEFAULT_DELAY_US = 120_000
"""Age of a fix from a u-blox M8 or later [us]."""
CHECKS_HOLD_US = 10_000_000
"""The quality checks must hold this long before the first use."""
RETURN_FIXES = 5
"""Good fixes in a row before GPS is used again after a loss."""
MIN_SATELLITES = 6
MAX_HDOP = 250.0  # times 100
LEARNED_VARIANCE = 3.6e-7
"""Variance of the yaw gyro's bias below which it is known: (0.034 deg/s)^2 [(rad/s)^2]."""
LEARNED_HOLD_US = 23_300_000
"""It must have been known this long before GPS is used; with default noise that is 41.6 s after boot."""
LEARNED_US = 90_000_000
"""After this long the bias is taken as known: near the magnetic poles the variance stays higher."""
POSITION_TIMEOUT_US = 7_000_000
"""After this long without a fused position it is no longer trusted."""
STOP_TIMEOUT_US = 15_000_000
"""After this long the filter holds its position instead of dead reckoning."""
GLITCH_TIMEOUT_US = 10_000_000
"""After this long of fixes beyond the gates the filter follows them."""
SILENCE_US = 2_000_000
"""Fixes further apart than this are not in a row."""


@law
def read(ekf, sensors, now_us):
    """Note when a message arrived."""
    if int(sensors.gps_count) != ekf.gps_seen:
        ekf.gps_seen = int(sensors.gps_count)
        ekf.gps_arrival_us = now_us
        ekf.gps_new = 1


@law
def sane(sensors):
    """Whether the message is a 3D fix with figures that make sense."""
    if int(sensors.gps_fix) < 3:
        return False
    lat, lon, alt = int(sensors.gps_lat), int(sensors.gps_lon), int(sensors.gps_alt)
    if abs(lat) > 900000000 or abs(lon) > 1800000000 or (lat == 0 and lon == 0):
        return False
    if alt < -1000000 or alt > 50000000:
        return False
    limit = 30000  # [cm/s]
    return (
        abs(int(sensors.gps_vel[0])) < limit
        and abs(int(sensors.gps_vel[1])) < limit
        and abs(int(sensors.gps_vel[2])) < limit
    )


@law
def quality(params, sensors):
    """Whether a sane fix passes the checks that EK3_GPS_CHECK asks for."""
    mask, scale = int(params.EK3.GPS_CHECK), 0.01 * params.EK3.CHECK_SCALE
    if mask & 1 and int(sensors.gps_satellites) < MIN_SATELLITES:
        return False
    return not (mask & 2 and (int(sensors.gps_eph) <= 0 or int(sensors.gps_eph) > MAX_HDOP * scale))


@law
def _fuse_velocity(ap, sensors, a, b, share, now_us):
    """Fuse the fix's velocity against the past velocity; returns 1 when it passed the gate."""
    ekf, params = ap.ekf, ap.params
    ne, d = noise.GPS_VELOCITY_NE * params.EK3.VELNE_M_NSE, noise.GPS_VELOCITY_D * params.EK3.VELD_M_NSE
    # the first pass looks, the second fuses
    squares, variances = 0.0, 0.0
    for go in range(2):
        for k in range(3):
            past = ekf.ring_vel[a, k] + share * (ekf.ring_vel[b, k] - ekf.ring_vel[a, k])
            clear_row(ekf)
            ekf.h[VEL + k] = 1.0
            variance = d * d if k == 2 else ne * ne
            innovation, s = innovate(ekf, 0.01 * int(sensors.gps_vel[k]) - past, variance)
            if go == 1:
                correct(ekf, innovation, s, NIS_GPS_VELOCITY)
            else:
                squares += innovation * innovation
                variances += s
        if go == 0:
            n, v = params.EK3.VELNE_M_NSE, params.EK3.VELD_M_NSE
            nominal = math.sqrt(2.0 * n * n + v * v)
            ratio = gate_ratio(squares, variances, nominal, params.EK3.VEL_I_GATE)
            ap.estimate.variance_vel = math.sqrt(ratio)
            if ratio >= 1.0:
                return 0
    ekf.gps_vel_fused_us = now_us
    return 1


@law
def _fuse_position(ap, sensors, a, b, share, age, now_us):
    """Fuse the fix's horizontal position against the past position; returns 1 when it passed the gate."""
    ekf, params, estimate = ap.ekf, ap.params, ap.estimate
    sigma = noise.GPS_POSITION * params.EK3.POSNE_M_NSE
    n, e = offset_ne(estimate.origin_lat, estimate.origin_lon, int(sensors.gps_lat), int(sensors.gps_lon))
    squares, variances = 0.0, 0.0
    for go in range(2):
        for k in range(2):
            past = ekf.ring_pos[a, k] + share * (ekf.ring_pos[b, k] - ekf.ring_pos[a, k])
            clear_row(ekf)
            ekf.h[POS + k] = 1.0
            ekf.h[VEL + k] = -age
            innovation, s = innovate(ekf, (n if k == 0 else e) - past, sigma * sigma)
            if go == 1:
                correct(ekf, innovation, s, NIS_GPS_POSITION)
            else:
                squares += innovation * innovation
                variances += s
        if go == 0:
            nominal = math.sqrt(2.0) * params.EK3.POSNE_M_NSE
            ratio = gate_ratio(squares, variances, nominal, params.EK3.POS_I_GATE)
            estimate.variance_pos = math.sqrt(ratio)
            if ratio >= 1.0:
                return 0
    ekf.gps_pos_fused_us = now_us
    return 1


@law
def fuse(ap, sensors, now_us):
    """Look at the GPS message; returns 1 when something was fused."""
    ekf, params, estimate = ap.ekf, ap.params, ap.estimate
    if ekf.gps_in_use != 0 and now_us - max(ekf.gps_pos_fused_us, ekf.gps_vel_fused_us) > STOP_TIMEOUT_US:
        stop_using(ap, now_us)
    if ekf.gps_new == 0:
        return 0
    ekf.gps_new = 0
    if not sane(sensors):
        ekf.gps_good_us = 0
        ekf.gps_fixes = 0
        return 0
    if now_us - ekf.gps_us > SILENCE_US:
        ekf.gps_good_us = 0
        ekf.gps_fixes = 0
    ekf.gps_us = now_us
    ekf.gps_fixes += 1
    alt = 0.001 * int(sensors.gps_alt)
    if ekf.gps_fixes == 1 or ekf.gps_alt_filter != ekf.gps_alt_filter:  # the first, or after a filter step gone bad
        ekf.gps_alt_filter = alt + ekf.pos[2]
    ekf.gps_alt_filter += 0.1 * (alt + ekf.pos[2] - ekf.gps_alt_filter)
    if not quality(params, sensors):
        ekf.gps_good_us = 0
    elif ekf.gps_good_us == 0:
        ekf.gps_good_us = now_us
    if ekf.field_known == 0 and ekf.yaw_aligned != 0:
        learn_field(ap, int(sensors.gps_lat), int(sensors.gps_lon))
    held = ekf.gps_good_us != 0 and now_us - ekf.gps_good_us >= CHECKS_HOLD_US
    if held and estimate.origin_set == 0 and ekf.yaw_aligned != 0:
        place_origin(ap, int(sensors.gps_lat), int(sensors.gps_lon), ekf.gps_alt_filter, now_us)

    delay_us = DEFAULT_DELAY_US if params.GPS1_DELAY_MS == 0 else int(1000 * params.GPS1_DELAY_MS)
    when_us = ekf.gps_arrival_us - delay_us
    age = 1e-6 * (now_us - when_us)
    if ekf.bias_learned == 0 and ekf.yaw_aligned != 0:
        if not ekf.P[BG + 2, BG + 2] < LEARNED_VARIANCE:
            ekf.bias_unknown_us = now_us
        known_us = now_us - ekf.bias_unknown_us
        ekf.bias_learned = 1 if known_us > LEARNED_HOLD_US or now_us - ekf.init_us > LEARNED_US else 0
    if ekf.gps_in_use == 0:
        # the first time the checks must have held for long; after a loss a few good fixes are enough
        again = ekf.gps_used_before != 0 and ekf.gps_good_us != 0 and ekf.gps_fixes >= RETURN_FIXES
        if (held or again) and estimate.origin_set != 0 and ekf.bias_learned != 0 and ekf.yaw_aligned != 0:
            start_using(ap, sensors, age, now_us)
        return 0
    a, b, share = slot_at(ekf, when_us)
    velocity = _fuse_velocity(ap, sensors, a, b, share, now_us)
    position = _fuse_position(ap, sensors, a, b, share, age, now_us)
    ekf.gps_glitch = 1 - position
    if now_us - ekf.gps_pos_fused_us > GLITCH_TIMEOUT_US and ekf.gps_good_us != 0:
        reset_to_fix(ap, sensors, age)
        ekf.gps_pos_fused_us = now_us
        ekf.gps_glitch = 0
    return 1 if velocity + position > 0 else 0
