# SPDX-License-Identifier: BSD-3-Clause
"""From power-on to a running filter: gyro calibration at rest, tilt, yaw.

CALIBRATE  the vehicle must keep still while gyros are averaged; the mean specific force gives tilt
TILT       the filter runs with zero velocity as its measurement until its tilt variance is small
YAW        the next mean of the magnetometer gives yaw
RUN        all sensors; a restart in flight (lost health) begins again at TILT without calibration
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.rotations import quat_from_euler
from .. import events
from . import covariance
from .state import RING, THETA, N
from .strapdown import set_attitude, tilt_from_acc

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


@law
def _restart_window(ekf):
    ekf.still_ticks = 0
    for k in range(3):
        ekf.gyro_sum[k] = 0.0
        ekf.acc_sum[k] = 0.0
        ekf.gyro_low[k] = ekf.gyro_smooth[k]
        ekf.gyro_high[k] = ekf.gyro_smooth[k]


@law
def calibrate(ekf, now_us):
    """One tick of the window; returns 1 when calibration is complete."""
    if ekf.started == 0:
        ekf.started = 1
        ekf.start_us = now_us
    if ekf.bad_imu > 0:
        return 0
    if now_us - ekf.start_us < WARM_UP_US:
        for k in range(3):
            ekf.gyro_smooth[k] = ekf.good_gyro[k]
        _restart_window(ekf)
        return 0
    still = True
    for k in range(3):
        ekf.gyro_smooth[k] += _SMOOTH * (ekf.good_gyro[k] - ekf.gyro_smooth[k])
        ekf.gyro_low[k] = min(ekf.gyro_low[k], ekf.gyro_smooth[k])
        ekf.gyro_high[k] = max(ekf.gyro_high[k], ekf.gyro_smooth[k])
        ekf.gyro_sum[k] += ekf.good_gyro[k]
        ekf.acc_sum[k] += ekf.good_acc[k]
        if ekf.gyro_high[k] - ekf.gyro_low[k] > STILL_SPREAD or abs(ekf.gyro_smooth[k]) > MAX_STILL_RATE:
            still = False
    ekf.still_ticks += 1
    if not still and now_us - ekf.start_us < GIVE_UP_US:
        _restart_window(ekf)
        return 0
    if ekf.still_ticks < WINDOW_TICKS or ekf.baro_n == 0:
        return 0
    for k in range(3):
        ekf.gyro_bias[k] = ekf.gyro_sum[k] / ekf.still_ticks if still else 0.0
        ekf.good_acc[k] = ekf.acc_sum[k] / ekf.still_ticks
    return 1


@law
def initialise(ekf, now_us):
    """Start the filter at rest at the position held, tilt from the specific force in ``good_acc``."""
    roll, pitch = tilt_from_acc(ekf.good_acc[0], ekf.good_acc[1], ekf.good_acc[2])
    w, x, y, z = quat_from_euler(roll, pitch, 0.0)
    set_attitude(ekf, w, x, y, z)
    for k in range(3):
        ekf.vel[k] = 0.0
        ekf.acc_bias[k] = 0.0
        ekf.mag_bias[k] = 0.0
        ekf.lag_vel[k] = 0.0
        ekf.lag_pos[k] = 0.0
        ekf.last_gyro[k] = 0.0
        ekf.step_dv[k] = 0.0
        ekf.mag_sum[k] = 0.0
    ekf.pos[0], ekf.pos[1] = ekf.hold_pos[0], ekf.hold_pos[1]
    for i in range(N):
        ekf.dx[i] = 0.0
    covariance.start(ekf)
    ekf.step_ticks = 0
    ekf.step_dt = 0.0
    ekf.mag_n = 0
    ekf.ring_count = 0
    for n in range(RING):
        ekf.ring_us[n] = now_us
    ekf.phase = TILT
    ekf.init_us = now_us
    ekf.tilt_aligned = 0
    ekf.yaw_aligned = 0
    ekf.gps_in_use = 0
    ekf.baro_fused_us = now_us
    ekf.mag_fused_us = now_us


@law
def check_tilt(ekf, ap_events, now_us):
    """TILT to YAW when the tilt variance has fallen."""
    if ekf.P[THETA, THETA] + ekf.P[THETA + 1, THETA + 1] < TILT_VARIANCE:
        ekf.tilt_aligned = 1
        ekf.phase = YAW
        ekf.mag_n = 0
        for k in range(3):
            ekf.mag_sum[k] = 0.0
        events.emit(ap_events, now_us, events.EKF_TILT_ALIGNED, 0.0, 0.0)


@law
def healthy(ekf):
    """Whether the nominal state and the variances are finite."""
    total = 0.0
    for k in range(4):
        total += abs(ekf.q[k])
    for k in range(3):
        total += abs(ekf.vel[k]) + abs(ekf.pos[k])
        total += abs(ekf.gyro_bias[k]) + abs(ekf.acc_bias[k]) + abs(ekf.mag_bias[k])
    for k in range(N):
        if not ekf.P[k, k] >= 0.0:
            return False
        total += ekf.P[k, k]
    return total < 1e12


@law
def restart(ekf, now_us):
    """Begin anew after lost health, without calibration: the vehicle may be flying."""
    ekf.resets += 1
    for k in range(3):
        ekf.gyro_bias[k] = 0.0
    for k in range(2):
        if not abs(ekf.hold_pos[k]) < 1e7:
            ekf.hold_pos[k] = 0.0
    ekf.pos[2] = 0.0
    initialise(ekf, now_us)
    ekf.baro_fused_us = now_us - 60_000_000  # the height is not known: take the barometer's
