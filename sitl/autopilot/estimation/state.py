# SPDX-License-Identifier: BSD-3-Clause
"""What the extended Kalman filter keeps between ticks. NED metres from the origin, FRD body frame, SI units,
radians.

The error state has 18 entries: attitude (a small rotation of the NED frame) 0-2, velocity 3-5, position 6-8,
gyro bias 9-11, accelerometer bias 12-14, magnetometer bias 15-17 (bias: what the sensor shows too much, body
frame).
"""

from __future__ import annotations

from ...core.records import record

N = 18
THETA, VEL, POS, BG, BA, BM = 0, 3, 6, 9, 12, 15
RING = 32
"""Past states kept for delayed measurements; one each filter step (12.5 ms), 0.4 s in all."""

EKF_DTYPE = record(
    ("use_external", "i8"),  # not 0: somebody else writes the estimate; the filter stands still
    ("phase", "i8"),  # alignment.py: CALIBRATE, TILT, YAW, RUN
    ("resets", "i8"),  # times the filter lost its health and began anew
    # nominal state
    ("q", "f8", 4),  # body to NED
    ("vel", "f8", 3),  # [m/s]
    ("pos", "f8", 3),  # [m]
    ("gyro_bias", "f8", 3),  # [rad/s]
    ("acc_bias", "f8", 3),  # [m/s^2]
    ("mag_bias", "f8", 3),  # [gauss]
    ("P", "f8", (N, N)),  # covariance of the error state
    ("dx", "f8", N),  # error found by the fusions of this step, not yet put into the nominal state
    ("h", "f8", N),  # measurement row, scratch of one fusion
    ("ph", "f8", N),  # P times the transposed measurement row, scratch of one fusion
    # output: corrections reach the estimate with a time constant, so that controllers see no steps
    ("lag_vel", "f8", 3),  # [m/s]
    ("lag_pos", "f8", 3),  # [m]
    # inertial sensors
    ("good_gyro", "f8", 3),  # last sample that made sense [rad/s]
    ("good_acc", "f8", 3),  # [m/s^2]
    ("bad_imu", "i8"),  # bad samples in a row
    ("last_gyro", "f8", 3),  # bias-free rates of the tick before [rad/s], for coning
    ("last_acc_ned", "f8", 3),  # acceleration of the tick before [m/s^2]
    ("step_ticks", "i8"),  # ticks since the last filter step
    ("step_dt", "f8"),  # time since the last filter step [s]
    ("step_dv", "f8", 3),  # specific force summed since the last filter step, NED [m/s]
    # alignment
    ("now_us", "i8"),  # time of the present tick
    ("started", "i8"),
    ("start_us", "i8"),  # when calibration began
    ("init_us", "i8"),  # when the filter was initialised
    ("still_ticks", "i8"),  # samples in the sums below
    ("gyro_sum", "f8", 3),
    ("gyro_smooth", "f8", 3),  # low-passed [rad/s]
    ("gyro_low", "f8", 3),  # its extremes in the window
    ("gyro_high", "f8", 3),
    ("acc_sum", "f8", 3),
    ("tilt_aligned", "i8"),
    ("yaw_aligned", "i8"),
    ("yaw_in_flight", "i8"),  # yaw checked again after take-off
    ("bias_unknown_us", "i8"),  # last time that the variance of the yaw gyro's bias was large
    ("bias_learned", "i8"),  # gyro bias known well enough to trust yaw over minutes
    ("ground_d", "f8"),  # pos[2] when last on the ground, disarmed [m]
    # history for delayed measurements
    ("ring_count", "i8"),
    ("ring_us", "i8", RING),
    ("ring_pos", "f8", (RING, 3)),
    ("ring_vel", "f8", (RING, 3)),
    # barometer
    ("baro_seen", "i8"),  # last baro_count
    ("baro_n", "i8"),  # samples in the sum
    ("baro_us_sum", "i8"),  # of their times
    ("baro_sum", "f8"),  # altitude in the standard atmosphere [m]
    ("baro_ground", "f8"),  # altitude in the standard atmosphere of pos[2] = 0 [m]
    ("baro_us", "i8"),  # last good sample
    ("baro_fused_us", "i8"),
    # magnetometer
    ("mag_seen", "i8"),
    ("mag_n", "i8"),
    ("mag_sum", "f8", 3),  # field turned to NED [gauss]
    ("mag_us", "i8"),
    ("mag_fused_us", "i8"),
    ("earth_field", "f8", 3),  # NED [gauss]
    ("declination", "f8"),  # [rad], east positive
    ("field_known", "i8"),  # from the model of the earth's field, at the first GPS fix
    # GPS
    ("gps_seen", "i8"),
    ("gps_new", "i8"),  # a message waits for the next filter step
    ("gps_arrival_us", "i8"),
    ("gps_us", "i8"),  # last sane 3D fix arrived
    ("gps_good_us", "i8"),  # since when the quality checks hold, 0: they do not
    ("gps_fixes", "i8"),  # sane fixes in a row
    ("gps_alt_filter", "f8"),  # mean altitude while on the ground [m]
    ("gps_in_use", "i8"),
    ("gps_used_before", "i8"),
    ("gps_glitch", "i8"),  # last fix was beyond the gates
    ("gps_pos_fused_us", "i8"),
    ("gps_vel_fused_us", "i8"),
    ("hold_us", "i8"),  # last zero-velocity or held-position fusion
    ("hold_pos", "f8", 2),  # NE position held [m]
    # consistency: normalised innovation squared, sums and counts since the filter started
    ("nis_sum", "f8", 4),  # GPS position, GPS velocity, barometer, magnetometer
    ("nis_count", "i8", 4),
)
