# SPDX-License-Identifier: BSD-3-Clause
"""From power-on to a running filter: gyro calibration at rest, tilt, yaw.

CALIBRATE  the vehicle must keep still while gyros are averaged; the mean specific force gives tilt
TILT       the filter runs with zero velocity as its measurement until its tilt variance is small
YAW        the next mean of the magnetometer gives yaw
RUN        all sensors; a restart in flight (lost health) begins again at TILT without calibration
"""

from __future__ import annotations

from ...core.algebra import ZERO, horizontal, normalise, quat_from_euler, quat_norm_squared, with_down
from ...core.kernels import law
from ...core.vectors import Vec2, Vec3
from ..events import Events, emit
from . import covariance, height
from .estimator_events import EKF_TILT_ALIGNED
from .magnetometer import clear_samples
from .state import RING, THETA, Ekf, N
from .strapdown import tilt_from_acc, within

CALIBRATE, TILT, YAW, RUN = 0, 1, 2, 3

WARM_UP_US = 440_000
"""Samples right after power-on are left out."""
WINDOW_TICKS = 1600
"""Ticks that the vehicle must keep still: 4 s."""
STILL_SPREAD = 0.05
"""Largest spread of a low-passed gyro axis in the window [rad/s]."""
MAX_STILL_RATE = 0.2
"""No gyro has a larger bias [rad/s]: the vehicle turns."""
GIVE_UP_US = 30_000_000
"""After this long the window need not be still: the biases start from zero with what the filter learns."""
TILT_VARIANCE = 3.05e-4
"""Tilt is aligned when the variances about north and east together are below this [rad^2]: 1 degree."""
_SMOOTH = 0.05  # gain of a 3.4 Hz low-pass at 400 Hz
_FAR = 1e7  # [m]: no position held


@law
def _restart_window(ekf: Ekf) -> None:
    ekf.still_ticks = 0
    ekf.gyro_sum = ZERO
    ekf.acc_sum = ZERO
    ekf.gyro_low = ekf.gyro_smooth
    ekf.gyro_high = ekf.gyro_smooth


@law
def _add_sample(ekf: Ekf) -> bool:
    """Add the sensors' last good sample to the window; whether the vehicle has kept still in it."""
    smooth = ekf.gyro_smooth + _SMOOTH * (ekf.good_gyro - ekf.gyro_smooth)
    low, high = ekf.gyro_low, ekf.gyro_high
    ekf.gyro_smooth = smooth
    ekf.gyro_low = Vec3(min(low.x, smooth.x), min(low.y, smooth.y), min(low.z, smooth.z))
    ekf.gyro_high = Vec3(max(high.x, smooth.x), max(high.y, smooth.y), max(high.z, smooth.z))
    ekf.gyro_sum += ekf.good_gyro
    ekf.acc_sum += ekf.good_acc
    ekf.still_ticks += 1
    return within(ekf.gyro_high - ekf.gyro_low, STILL_SPREAD) and within(smooth, MAX_STILL_RATE)


@law
def calibrate(ekf: Ekf) -> bool:
    """One tick of the window; whether calibration is complete."""
    if not ekf.started:
        ekf.started = True
        ekf.start_us = ekf.now_us
    if ekf.bad_imu > 0:
        return False
    if ekf.now_us - ekf.start_us < WARM_UP_US:
        ekf.gyro_smooth = ekf.good_gyro
        _restart_window(ekf)
        return False
    still = _add_sample(ekf)
    if not still and ekf.now_us - ekf.start_us < GIVE_UP_US:
        _restart_window(ekf)
        return False
    if ekf.still_ticks < WINDOW_TICKS or ekf.baro_n == 0:
        return False
    ekf.gyro_bias = ekf.gyro_sum / ekf.still_ticks if still else ZERO
    ekf.good_acc = ekf.acc_sum / ekf.still_ticks
    return True


@law
def initialise(ekf: Ekf) -> None:
    """Start the filter at rest at the position held, tilt from the specific force in ``good_acc``."""
    ekf.q = normalise(quat_from_euler(tilt_from_acc(ekf.good_acc)))
    ekf.pos = with_down(ekf.hold_pos, ekf.pos.z)
    ekf.vel = ZERO
    ekf.acc_bias = ZERO
    ekf.mag_bias = ZERO
    ekf.lag_vel = ZERO
    ekf.lag_pos = ZERO
    ekf.last_gyro = ZERO
    for i in range(N):
        ekf.dx[i] = 0.0
    covariance.start(ekf.P)
    begin_step(ekf)
    clear_samples(ekf)
    ekf.ring_count = 0
    for n in range(RING):
        ekf.ring_us[n] = ekf.now_us
    ekf.phase = TILT
    ekf.init_us = ekf.now_us
    ekf.tilt_aligned = False
    ekf.yaw_aligned = False
    ekf.absolute = False
    ekf.relative = False
    ekf.baro_fused_us = ekf.now_us
    ekf.mag_fused_us = ekf.now_us


@law
def begin_step(ekf: Ekf) -> None:
    """Begin the sums over the ticks of a filter step."""
    ekf.step_ticks = 0
    ekf.step_dt = 0.0
    ekf.step_dv = ZERO


@law
def check_tilt(ekf: Ekf, log: Events) -> None:
    """TILT to YAW when the tilt variance has fallen."""
    if ekf.P[THETA, THETA] + ekf.P[THETA + 1, THETA + 1] < TILT_VARIANCE:
        ekf.tilt_aligned = True
        ekf.phase = YAW
        clear_samples(ekf)
        emit(log, ekf.now_us, EKF_TILT_ALIGNED, float(ekf.imu), 0.0)


@law
def _size(vector: Vec3) -> float:
    return abs(vector.x) + abs(vector.y) + abs(vector.z)


@law
def is_healthy(ekf: Ekf) -> bool:
    """Whether the nominal state and the variances are finite.

    A variance below zero is none of that: ``covariance.bound`` lifts it with the next fusion. As in ArduPilot's filter,
    a vehicle under way does not lose its position for it.
    """
    total = quat_norm_squared(ekf.q) + _size(ekf.vel) + _size(ekf.pos)
    total += _size(ekf.gyro_bias) + _size(ekf.acc_bias) + _size(ekf.mag_bias)
    for k in range(N):
        total += abs(ekf.P[k, k])
    return total < 1e12


@law
def restart(ekf: Ekf) -> None:
    """Begin anew after lost health, without calibration: the vehicle may be flying."""
    ekf.resets += 1
    ekf.gyro_bias = ZERO
    held = ekf.hold_pos
    ekf.hold_pos = Vec2(held.x if abs(held.x) < _FAR else 0.0, held.y if abs(held.y) < _FAR else 0.0)
    ekf.pos = with_down(horizontal(ekf.pos), 0.0)
    initialise(ekf)
    ekf.baro_fused_us = ekf.now_us - height.UNKNOWN_US  # the next one is taken as it is
