# SPDX-License-Identifier: BSD-3-Clause
"""Where the target is from the vehicle, and how it moves: measurements as they are, or a Kalman filter an axis.

The estimate is as of PLND_LAG ago, when the last measurement was taken; from there it is carried to now.
"""

from __future__ import annotations

from ...core.algebra import horizontal, norm, norm2, row_vector, set_row_vector, turned
from ...core.constants import TICK_S as DT
from ...core.kernels import law
from ...core.records import Floats
from ...core.vectors import Vec2, Vec3
from ..events import Events, emit
from ..params.precision_landing import PrecisionLanding
from ..state import Estimate, Vehicle
from .measurement import height_over_ground, measure
from .state import (
    FOUND,
    LANDING_TARGET_DID,
    LOST,
    NEVER_SEEN,
    OUT_OF_RANGE,
    SAID_FAILED,
    SAID_FOUND,
    SAID_LOST,
    SAID_READY,
    LandingTarget,
)

SETTLE_US = 2_000_000
"""The Kalman filter is good after so long."""
GAP_US = 500_000
"""Longest silence until then."""
SILENCE_US = 2_000_000
"""And afterwards."""
MEMORY_US = 180_000_000
"""A target that was lost is remembered for so long,"""
MEMORY_RANGE = 30.0
"""as long as the vehicle is no further from where it last saw it [m]."""
SPEED_ERROR = 2.0
"""Standard deviation of the velocity at the start [m/s]."""
OUTLIER, OUTLIERS = 3.0, 3
"""A measurement is left out whose squared error is so many times its variance, but no more than so many in a row."""


@law
def variance(position: Vec3, rates: Vec3) -> float:
    """Of a measurement [m^2]: it grows with the height and while the vehicle turns."""
    deviation = abs(position.z) * (0.01 + 0.01 * norm(rates)) + 0.02
    return deviation * deviation


@law
def predict(t: LandingTarget, change: Vec2, accel_noise: float) -> None:
    """One tick, in which the target's velocity, seen from the vehicle, changes by ``change`` [m/s]."""
    t.pos += DT * t.vel + 0.5 * DT * change
    t.vel += change
    noise = accel_noise * DT
    for k in range(2):
        c = row_vector(t.covariance, k)
        both = c.y + DT * c.z
        set_row_vector(t.covariance, k, Vec3(c.x + DT * (c.y + both), both, c.z + noise * noise))


@law
def start(t: LandingTarget, est: Estimate) -> None:
    """Begin with a measurement of a target that stands."""
    t.pos, t.vel = horizontal(t.measured_pos), -1.0 * horizontal(est.vel)
    spread = Vec3(variance(t.measured_pos, est.rates), 0.0, SPEED_ERROR * SPEED_ERROR)
    set_row_vector(t.covariance, 0, spread)
    set_row_vector(t.covariance, 1, spread)


@law
def gains(covariance: Floats, k: int, spread: float) -> Vec2:
    """Of position and velocity of an axis, for a measurement of variance ``spread`` [m^2]; the covariance follows."""
    c = row_vector(covariance, k)
    total = c.x + spread
    gain = Vec2(c.x / total, c.y / total)
    set_row_vector(covariance, k, Vec3((1.0 - gain.x) * c.x, (1.0 - gain.x) * c.y, c.z - gain.y * c.y))
    return gain


@law
def fuse(t: LandingTarget, est: Estimate) -> bool:
    """Take in a measurement; False: it is an outlier."""
    error, spread = horizontal(t.measured_pos) - t.pos, variance(t.measured_pos, est.rates)
    north = error.x * error.x / (row_vector(t.covariance, 0).x + spread)
    east = error.y * error.y / (row_vector(t.covariance, 1).x + spread)
    if max(north, east) >= OUTLIER and t.outliers < OUTLIERS:
        t.outliers += 1
        return False
    t.outliers = 0
    x, y = gains(t.covariance, 0, spread), gains(t.covariance, 1, spread)
    t.pos += Vec2(x.x * error.x, y.x * error.y)
    t.vel += Vec2(x.y * error.x, y.y * error.y)
    return True


@law
def watch(t: LandingTarget, events: Events, time_us: int, is_raw: bool) -> None:
    """The target is good for landing, or is lost."""
    silent = time_us - t.update_us
    if t.acquired:
        if silent > SILENCE_US:
            t.running = t.acquired = False
            t.lost_us = time_us
            emit(events, time_us, LANDING_TARGET_DID, float(SAID_LOST), 0.0)
    elif t.running:
        if is_raw:
            t.acquired = True
        elif silent > GAP_US:
            t.running = False
            emit(events, time_us, LANDING_TARGET_DID, float(SAID_FAILED), 0.0)
        elif time_us - t.since_us > SETTLE_US:
            t.acquired = True
            emit(events, time_us, LANDING_TARGET_DID, float(SAID_READY), 0.0)


@law
def carry_to_now(t: LandingTarget, est: Estimate, p: PrecisionLanding) -> None:
    """From the time of the measurement to now: the position to land at."""
    t.closing = t.vel
    offset = turned(Vec2(0.01 * p.LAND_OFS_X, 0.01 * p.LAND_OFS_Y), est.yaw)
    t.away = t.pos + p.LAG * t.vel + offset


@law
def is_in_range(height: float, p: PrecisionLanding) -> bool:
    """Whether the sensor should see a target at a ``height`` over the ground [m], below 0 unknown."""
    if p.ALT_MIN <= 0.0 and p.ALT_MAX <= 0.0:
        return True
    return height >= p.ALT_MIN and (p.ALT_MAX <= 0.0 or height <= p.ALT_MAX)


@law
def status(t: LandingTarget, est: Estimate, height: float, time_us: int, p: PrecisionLanding) -> int:
    """FOUND, or why not."""
    if t.acquired:
        return FOUND
    if not is_in_range(height, p):
        return OUT_OF_RANGE
    if t.lost_us == 0 or time_us - t.lost_us > MEMORY_US or norm(est.pos - t.seen_from) > MEMORY_RANGE:
        return NEVER_SEEN
    return LOST


@law
def estimate(v: Vehicle, orientation: int) -> None:
    """One tick; without PLND_ENABLED no target is known. ``orientation``: where the sensor looks."""
    ap, est = v.autopilot, v.autopilot.estimate
    if ap.params.PLND.ENABLED == 0.0:
        forget(ap.landing_target)
        return
    height = height_over_ground(v.sensors, est.q)
    update(ap.landing_target, est, height, ap.events, v.time_us, ap.params.PLND, orientation)


@law
def update(
    t: LandingTarget, est: Estimate, height: float, events: Events, time_us: int, p: PrecisionLanding, orientation: int
) -> None:
    """One tick. ``height``: over the ground [m], below 0 unknown. ``orientation``: where the sensor looks."""
    is_raw = p.EST_TYPE == 0.0
    if t.running:
        predict(t, -DT * horizontal(est.acc_ned), p.ACC_P_NSE)
        if is_raw:
            t.vel = -1.0 * horizontal(est.vel)
    if t.line_us != t.used_us:
        t.used_us = t.line_us
        if measure(t, est, height, p, orientation):
            t.last_pos, t.seen_from = t.measured_pos + est.pos, est.pos
            if not t.running:
                t.running, t.since_us = True, time_us
                t.update_us, t.outliers = time_us, 0
                emit(events, time_us, LANDING_TARGET_DID, float(SAID_FOUND), 0.0)
                start(t, est)
            elif is_raw:
                t.pos, t.update_us = horizontal(t.measured_pos), time_us
            elif fuse(t, est):
                t.update_us = time_us
    watch(t, events, time_us, is_raw)
    if t.running:
        carry_to_now(t, est, p)
    t.status = status(t, est, height, time_us, p)


@law
def target_position(t: LandingTarget, est: Estimate) -> Vec2:
    """Where to land, from the origin [m]."""
    return horizontal(est.pos) + t.away


@law
def distance(t: LandingTarget) -> float:
    """From the position to land at [m]."""
    return norm2(t.away)


@law
def forget(t: LandingTarget) -> None:
    """Nothing is known of a target: the vehicle is put elsewhere, or looks for none."""
    t.running = t.acquired = False
    t.used_us = t.line_us
    t.lost_us, t.status = 0, NEVER_SEEN
