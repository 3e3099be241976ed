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

from ...core.algebra import horizontal
from ...core.kernels import law
from ...core.vectors import Vec2, Vec3
from ..events import Events
from ..gps_receivers import Fix, fix_of
from ..params.estimator import Ekf3
from ..params.firmware_parameters import Parameters
from ..params.without_gps import Sources
from ..state import Estimate, Sensors
from . import doubt, height, noise, sources
from .aiding import Origin, fix_ne, reset_to_fix, start_using, stop_using, write_origin
from .fusion import NIS_GPS_POSITION, NIS_GPS_VELOCITY, correct, gate_ratio, innovate_position, innovate_state
from .height import Height
from .history import past_at
from .magnetometer import learn_field
from .state import BG, VEL, Ekf
from .strapdown import within

DEFAULT_DELAY_US = 120_000
"""Age of a fix from a u-blox M8 or later [us]."""
CHECKS_HOLD_US = 10_000_000
"""The quality checks must hold this long before the first use."""
RETURN_FIXES = 5
"""Good fixes in a row before GPS is used again after a loss."""
HEIGHT_NOISE = 1.5
"""Noise of a fix's height by EK3_POSNE_M_NSE, as with ArduPilot where the receiver does not say it."""
MIN_SATELLITES = 6
MAX_HDOP = 250.0  # times 100
MAX_SPEED = 29_999.0
"""Velocities above this are nonsense [cm/s]."""
LEARNED_VARIANCE = 3.6e-7
"""Variance of the yaw gyro's bias below which it is known: (0.034 deg/s)^2 [(rad/s)^2]."""
LEARNED_HOLD_US = 23_300_000
"""It must have been known this long before GPS is used; with default noise that is 41.6 s after boot."""
LEARNED_US = 37_000_000
"""After this long the bias is taken as known: where the horizontal field is weak the variance stays higher, and
ArduPilot uses GPS 41.5 s after boot at every latitude."""
POSITION_TIMEOUT_US = 7_000_000
"""After this long without a fused position and velocity the position is no longer trusted."""
STOP_TIMEOUT_US = 15_000_000
"""After this long the filter holds its position instead of dead reckoning."""
GLITCH_TIMEOUT_US = 10_000_000
"""After this long of fixes beyond the gates the filter follows them."""
GLITCH_BEGINS_US, GLITCH_ENDS_US = 1_000_000, 10_000_000
"""So long fixes must be beyond the gates, and within them again."""
SILENCE_US = 2_000_000
"""Fixes further apart than this are not in a row."""


@law
def read(ekf: Ekf, count: int) -> None:
    """Note when message ``count`` of the receiver in use arrived."""
    if count != ekf.gps_seen:
        ekf.gps_seen = count
        ekf.gps_arrival_us = ekf.now_us
        ekf.gps_new = True


@law
def is_sane(fix: Fix) -> bool:
    """Whether the message is a 3D fix with values that make sense."""
    lat, lon, alt = fix.gps_lat, fix.gps_lon, fix.gps_alt
    if fix.gps_fix < 3 or abs(lat) > 900000000 or abs(lon) > 1800000000 or (lat == 0 and lon == 0):
        return False
    return -1000000 <= alt <= 50000000 and within(fix.gps_vel, MAX_SPEED)


@law
def has_quality(fix: Fix, params: Ekf3) -> bool:
    """Whether a sane fix passes the checks that EK3_GPS_CHECK asks for."""
    mask = int(params.GPS_CHECK)
    if mask & 1 and fix.gps_satellites < MIN_SATELLITES:
        return False
    return not (mask & 2 and (fix.gps_eph <= 0 or fix.gps_eph > MAX_HDOP * (0.01 * params.CHECK_SCALE)))


@law
def count_fix(ekf: Ekf, fix: Fix, params: Ekf3, source: Sources) -> bool:
    """Count the fixes in a row and how long they have been good; whether this one makes sense.

    The mean altitude is that of the height zero: of the barometer; of the ground, where the height is that of fixes.
    """
    sane = is_sane(fix)
    if not sane or ekf.now_us - ekf.gps_us > SILENCE_US:
        ekf.gps_good_us = 0
        ekf.gps_fixes = 0
    if not sane:
        return False
    ekf.gps_us = ekf.now_us
    ekf.gps_fixes += 1
    alt, down = 0.001 * fix.gps_alt, ekf.pos.z - (ekf.ground_d if source.POSZ == sources.GPS else 0.0)
    if ekf.gps_fixes == 1 or ekf.gps_alt_filter != ekf.gps_alt_filter:  # the first, or after a filter step gone bad
        ekf.gps_alt_filter = alt + down
    ekf.gps_alt_filter += 0.1 * (alt + down - ekf.gps_alt_filter)
    if not has_quality(fix, params):
        ekf.gps_good_us = 0
    elif ekf.gps_good_us == 0:
        ekf.gps_good_us = ekf.now_us
    return True


@law
def learn_bias(ekf: Ekf) -> None:
    """Note when the yaw gyro's bias has been known for long enough."""
    if ekf.bias_learned or not ekf.yaw_aligned:
        return
    if not ekf.P[BG + 2, BG + 2] < LEARNED_VARIANCE:
        ekf.bias_unknown_us = ekf.now_us
    ekf.bias_learned = ekf.now_us - ekf.bias_unknown_us > LEARNED_HOLD_US or ekf.now_us - ekf.init_us > LEARNED_US


@law
def has_held(ekf: Ekf) -> bool:
    """Whether fixes have been good for long enough for the first use."""
    return ekf.gps_good_us != 0 and ekf.now_us - ekf.gps_good_us >= CHECKS_HOLD_US


@law
def may_start(ekf: Ekf) -> bool:
    """Whether GPS may be used: the first time after long checks, after a loss with a few good fixes."""
    again = ekf.gps_used_before and ekf.gps_good_us != 0 and ekf.gps_fixes >= RETURN_FIXES
    return (has_held(ekf) or again) and ekf.bias_learned and ekf.yaw_aligned


@law
def fuse_velocity(ekf: Ekf, residual: Vec3, params: Ekf3, vertical: bool) -> float:
    """Fuse measured minus past velocity [m/s], with its ``vertical`` part or without.

    Returns the ratio to the gate: it is not fused from 1 on.
    """
    n, v = params.VELNE_M_NSE, params.VELD_M_NSE
    sigma_ne, sigma_d = noise.GPS_VELOCITY_NE * n, noise.GPS_VELOCITY_D * v
    ne, d, nominal = sigma_ne * sigma_ne, sigma_d * sigma_d, math.sqrt(2.0 * n * n + (v * v if vertical else 0.0))
    north = innovate_state(ekf, VEL, residual.x, ne)
    east = innovate_state(ekf, VEL + 1, residual.y, ne)
    down = innovate_state(ekf, VEL + 2, residual.z, d)
    if doubt.is_odd(ekf, north, ne) or doubt.is_odd(ekf, east, ne) or (vertical and doubt.is_odd(ekf, down, d)):
        doubt.begin(ekf)
    if doubt.is_doubting(ekf):
        n = max(n, noise.DOUBTED_SPEED)
        ne, d, nominal = n * n, v * v, 0.0
        north = innovate_state(ekf, VEL, residual.x, ne)
        east = innovate_state(ekf, VEL + 1, residual.y, ne)
        down = innovate_state(ekf, VEL + 2, residual.z, d)
    squares = north.value * north.value + east.value * east.value
    variances = north.variance + east.variance
    if vertical:
        squares += down.value * down.value
        variances += down.variance
    ekf.innovation_vel = Vec3(north.value, east.value, down.value if vertical else 0.0)
    ratio = gate_ratio(squares, variances, nominal, params.VEL_I_GATE)
    if not ratio >= 1.0:
        correct(ekf, innovate_state(ekf, VEL, residual.x, ne), NIS_GPS_VELOCITY)
        correct(ekf, innovate_state(ekf, VEL + 1, residual.y, ne), NIS_GPS_VELOCITY)
        if vertical:
            correct(ekf, innovate_state(ekf, VEL + 2, residual.z, d), NIS_GPS_VELOCITY)
        ekf.vel_fused_us = ekf.now_us
    return ratio


@law
def fuse_position(ekf: Ekf, residual: Vec2, age: float, params: Ekf3) -> float:
    """Fuse measured minus past position [m] of ``age`` [s]; the ratio to the gate: it is not fused from 1 on."""
    sigma = noise.GPS_POSITION * params.POSNE_M_NSE
    variance, nominal = sigma * sigma, math.sqrt(2.0) * params.POSNE_M_NSE
    north = innovate_position(ekf, 0, age, residual.x, variance)
    east = innovate_position(ekf, 1, age, residual.y, variance)
    if doubt.is_odd(ekf, north, variance) or doubt.is_odd(ekf, east, variance):
        doubt.begin(ekf)
    if doubt.is_doubting(ekf):
        variance, nominal = params.POSNE_M_NSE * params.POSNE_M_NSE, 0.0
        north = innovate_position(ekf, 0, age, residual.x, variance)
        east = innovate_position(ekf, 1, age, residual.y, variance)
    squares = north.value * north.value + east.value * east.value
    ekf.innovation_pos = Vec3(north.value, east.value, ekf.innovation_pos.z)
    ratio = gate_ratio(squares, north.variance + east.variance, nominal, params.POS_I_GATE)
    if not ratio >= 1.0:
        correct(ekf, innovate_position(ekf, 0, age, residual.x, variance), NIS_GPS_POSITION)
        correct(ekf, innovate_position(ekf, 1, age, residual.y, variance), NIS_GPS_POSITION)
        ekf.pos_fused_us = ekf.now_us
    return ratio


@law
def watch_gates(ekf: Ekf, passed: bool) -> None:
    """Note a fix that ``passed`` the gates or not: a glitch begins after a second of those that do not."""
    if passed:
        ekf.gps_passed_us = ekf.now_us
    else:
        ekf.gps_failed_us = ekf.now_us
    if ekf.now_us - ekf.gps_passed_us > GLITCH_BEGINS_US:
        ekf.gps_glitch = True
    elif ekf.now_us - ekf.gps_failed_us > GLITCH_ENDS_US:
        ekf.gps_glitch = False


@law
def is_position_fresh(ekf: Ekf) -> bool:
    """Whether the position is known: also for a time without fixes, and for longer while their velocities are fused."""
    by_velocity = ekf.now_us - ekf.vel_fused_us < SILENCE_US
    limit = GLITCH_TIMEOUT_US + SILENCE_US if by_velocity else POSITION_TIMEOUT_US
    return ekf.now_us - ekf.pos_fused_us < limit


@law
def fuse_fix(ekf: Ekf, estimate: Estimate, fix: Fix, params: Ekf3, when_us: int, source: Sources) -> bool:
    """Fuse the velocity, as far as it is a source, and position of a fix taken at ``when_us``.

    Whether one passed its gate. As with ArduPilot the vertical velocity counts only where the horizontal one does.
    """
    takes_velocity = source.VELXY == sources.GPS
    age = 1e-6 * (ekf.now_us - when_us)
    past = past_at(ekf, when_us)
    residual = 0.01 * fix.gps_vel - past.vel
    estimate.innovation_vel_d = -residual.z
    velocity = fuse_velocity(ekf, residual, params, source.VELZ == sources.GPS) if takes_velocity else 0.0
    estimate.variance_vel = math.sqrt(velocity)
    position = fuse_position(ekf, fix_ne(estimate, fix) - horizontal(past.pos), age, params)
    estimate.variance_pos = math.sqrt(position)
    watch_gates(ekf, velocity < 1.0 and position < 1.0)
    if ekf.now_us - ekf.pos_fused_us > GLITCH_TIMEOUT_US and ekf.gps_good_us != 0:
        reset_to_fix(ekf, estimate, fix, age)
        ekf.pos_fused_us = ekf.now_us
    return not ((velocity >= 1.0 or not takes_velocity) and position >= 1.0)


@law
def gives_height(ekf: Ekf, estimate: Estimate, source: Sources) -> bool:
    """Whether the height is that of fixes now (EK3_SRCn_POSZ 3); else, or while there are none, the barometer's."""
    return source.POSZ == sources.GPS and estimate.origin_set and ekf.now_us - ekf.gps_us <= SILENCE_US


@law
def fuse_height(ekf: Ekf, estimate: Estimate, fix: Fix, params: Ekf3, when_us: int) -> bool:
    """Fuse the height of a fix taken at ``when_us``; whether something was fused.

    The first one after heights of the barometer is taken over where it is beyond the gate. (ArduPilot takes each such.)
    """
    if not ekf.height_of_gps:
        ekf.height_of_gps = True
        ekf.baro_fused_us = ekf.now_us - height.UNKNOWN_US
    down = estimate.origin_alt - 0.001 * fix.gps_alt
    nominal = HEIGHT_NOISE * params.POSNE_M_NSE
    sigma = noise.GPS_HEIGHT * nominal
    age = 1e-6 * (ekf.now_us - when_us)
    now = down + 0.01 * age * fix.gps_vel.z
    residual = down - past_at(ekf, when_us).pos.z
    return height.fuse(ekf, estimate, Height(now, age, residual, sigma * sigma, nominal), params)


@law
def delay_of(receiver: int, params: Parameters) -> int:
    """Age of a fix of a receiver when it arrives [us]."""
    return delay_us(params.GPS2_DELAY_MS if receiver == 1 else params.GPS1_DELAY_MS)


@law
def follow(ekf: Ekf, estimate: Estimate, fix: Fix, age: float, receiver: int) -> None:
    """Another receiver is used from this fix on, ``age`` [s] old: jump to it, as ArduPilot does."""
    ekf.gps_receiver = receiver
    reset_to_fix(ekf, estimate, fix, age)
    ekf.pos_fused_us = ekf.now_us


@law
def delay_us(delay_ms: float) -> int:
    """Age of a fix when it arrives [us], of GPS1_DELAY_MS."""
    return DEFAULT_DELAY_US if delay_ms == 0 else int(1000 * delay_ms)


@law
def fuse(
    ekf: Ekf,
    estimate: Estimate,
    log: Events,
    params: Parameters,
    sensors: Sensors,
    source: Sources,
    receiver: int,
) -> bool:
    """Look at the message of the GPS receiver in use; whether something was fused. Where GPS is no source of the
    position it gives no more than the origin."""
    is_source = source.POSXY == sources.GPS
    if ekf.absolute and ekf.now_us - max(ekf.pos_fused_us, ekf.vel_fused_us) > STOP_TIMEOUT_US:
        stop_using(ekf, estimate, log)
    if not ekf.gps_new:
        return False
    ekf.gps_new = False
    fix = fix_of(receiver, sensors)
    if not count_fix(ekf, fix, params.EK3, source):
        return False
    if not ekf.field_known and ekf.yaw_aligned and (ekf.gps_fixes > 1 or not ekf.heading_only):
        learn_field(ekf, estimate, fix.gps_lat, fix.gps_lon)
    if has_held(ekf) and not estimate.origin_set and ekf.yaw_aligned:
        write_origin(ekf, estimate, log, Origin(fix.gps_lat, fix.gps_lon, ekf.gps_alt_filter))
        if is_source:
            ekf.absolute = False  # until now: positions of another system, from where that began to count
    learn_bias(ekf)
    when_us = ekf.gps_arrival_us - delay_of(receiver, params)
    fused = False
    if gives_height(ekf, estimate, source):
        fused = fuse_height(ekf, estimate, fix, params.EK3, when_us)
    if not is_source or not estimate.origin_set:
        return fused
    if ekf.absolute:
        if receiver != ekf.gps_receiver:
            follow(ekf, estimate, fix, 1e-6 * (ekf.now_us - when_us), receiver)
        return fuse_fix(ekf, estimate, fix, params.EK3, when_us, source) or fused
    if may_start(ekf):
        ekf.gps_receiver = receiver
        start_using(ekf, estimate, log, fix, 1e-6 * (ekf.now_us - when_us))
    return fused
