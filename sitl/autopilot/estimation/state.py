# SPDX-License-Identifier: BSD-3-Clause
"""What the extended Kalman filter keeps between ticks. NED metres from the origin, FRD body frame, SI units,
radians.

The error state has 18 entries: attitude (a small rotation of the NED frame) 0-2, velocity 3-5, position 6-8,
gyro bias 9-11, accelerometer bias 12-14, magnetometer bias 15-17 (bias: what the sensor shows too much, body
frame).
"""

from __future__ import annotations

from ...core.records import Floats, Ints, Record, array
from ...core.vectors import Quat, Vec2, Vec3

N = 18
THETA, VEL, POS, BG, BA, BM = 0, 3, 6, 9, 12, 15
RING = 32
"""Past states kept for delayed measurements; one each filter step (12.5 ms), 0.4 s in all."""


class Ekf(Record):
    """The extended Kalman filter."""

    imu: int  # which IMU it works on: 0 the first, 1 the second
    compass: int  # which compass: 0, 1 or 2
    use_external: bool  # somebody else writes the estimate; the filter stands still
    phase: int  # alignment.py: CALIBRATE, TILT, YAW, RUN
    resets: int  # times the filter lost its health and began anew
    # nominal state
    q: Quat  # body to NED
    vel: Vec3  # [m/s]
    pos: Vec3  # [m]
    gyro_bias: Vec3  # [rad/s]
    acc_bias: Vec3  # [m/s^2]
    mag_bias: Vec3  # [gauss]
    P: Floats = array(N, N)  # covariance of the error state
    blames_imu: bool  # two IMUs differ: measurements that cannot be are not the sensors' fault
    doubt_us: int  # last measurement that cannot be (doubt.py); 0: none lately
    biases_mirrored: bool  # P's rows and columns of the biases are the same numbers, to the last bit
    dx: Floats = array(N)  # error found by the fusions of this step, not yet put into the nominal state
    h: Floats = array(N)  # measurement row, scratch of one fusion
    ph: Floats = array(N)  # P times the transposed measurement row, scratch of one fusion
    # output: corrections reach the estimate with a time constant, so that controllers see no steps
    lag_vel: Vec3  # [m/s]
    lag_pos: Vec3  # [m]
    # inertial sensors
    good_gyro: Vec3  # last sample that made sense [rad/s]
    good_acc: Vec3  # [m/s^2]
    bad_imu: int  # bad samples in a row
    last_gyro: Vec3  # bias-free rates of the tick before [rad/s], for coning
    last_acc_ned: Vec3  # acceleration of the tick before [m/s^2]
    step_ticks: int  # ticks since the last filter step
    step_dt: float  # time since the last filter step [s]
    step_dv: Vec3  # specific force summed since the last filter step, NED [m/s]
    # alignment
    now_us: int  # time of the present tick
    started: bool
    start_us: int  # when calibration began
    init_us: int  # when the filter was initialised
    still_ticks: int  # samples in the sums below
    gyro_sum: Vec3  # [rad/s]
    gyro_smooth: Vec3  # low-passed [rad/s]
    gyro_low: Vec3  # its extremes in the window
    gyro_high: Vec3  # [rad/s]
    acc_sum: Vec3  # [m/s^2]
    tilt_aligned: bool
    yaw_aligned: bool
    yaw_in_flight: bool  # yaw checked again after take-off
    bias_unknown_us: int  # last time that the variance of the yaw gyro's bias was large
    bias_learned: bool  # gyro bias known well enough to trust yaw over minutes
    ground_d: float  # position down when last on the ground, disarmed [m]
    # history for delayed measurements
    ring_count: int
    ring_us: Ints = array(RING, stored="i8")
    ring_pos: Floats = array(RING, 3)
    ring_vel: Floats = array(RING, 3)
    # barometer
    baro_seen: int  # last baro_count
    baro_n: int  # samples in the sum
    baro_us_sum: int  # of their times
    baro_sum: float  # altitude in the standard atmosphere [m]
    baro_ground: float  # altitude in the standard atmosphere of the height zero [m]
    baro_offset: float  # position down that it shows too little of, learnt while the height comes from elsewhere [m]
    baro_us: int  # last good sample
    baro_fused_us: int  # a height last was fused, of the barometer or in its place
    height_of_gps: bool  # the last measured height was a fix's
    # magnetometer
    mag_seen: int
    mag_changed_us: int  # when it took to another compass
    mag_n: int
    mag_sum: Vec3  # field turned to NED [gauss]
    mag_us: int
    mag_fused_us: int
    earth_field: Vec3  # NED [gauss]
    declination: float  # [rad], east positive
    field_known: bool  # from the model of the earth's field, at the first GPS fix
    heading_only: bool  # the heading is fused as ArduPilot does it (heading.py), EK3_MAG_CAL is not 4
    # GPS
    gps_seen: int
    gps_new: bool  # a message waits for the next filter step
    gps_arrival_us: int
    gps_us: int  # last sane 3D fix arrived
    gps_good_us: int  # since when the quality checks hold, 0: they do not
    gps_fixes: int  # sane fixes in a row
    gps_receiver: int  # whose fixes are fused: 0 the first's, 1 the second's
    gps_alt_filter: float  # mean altitude of the height zero [m]
    gps_used_before: bool
    gps_glitch: bool  # fixes have been beyond the gates for a second, and within for less than ten since
    gps_passed_us: int  # last fix within the gates
    gps_failed_us: int  # last fix beyond them
    # aiding
    absolute: bool  # positions are fused: of GPS, or of another system in its place (external.py)
    pos_fused_us: int  # a position last was
    vel_fused_us: int  # and a velocity
    hold_us: int  # last zero-velocity or held-position fusion
    hold_pos: Vec2  # NE position held [m]
    # aiding without GPS (sources.py, flow.py)
    source_set: int  # of EK3_SRC1, 2, 3: 0 .. 2
    relative: bool  # velocity comes from optical flow or another system: the position is relative to where that began
    relative_us: int  # when something of theirs was last fused
    compass_lies: bool  # yaw has been taken from the bank (yaw_bank.py) since the vehicle was armed
    without_compass: bool  # the heading comes from another system, or from gyros alone
    pose_seen: int  # last pose and velocity of another system (external.py)
    velocity_seen: int
    pose_resets: int  # its reset counter, as far as the filter has followed
    flow_seen: int  # last sample of optical flow
    range_seen: int  # last reading of the range-finder
    terrain_d: float  # position down of the ground below [m]
    terrain_us: int  # when the range-finder last saw it
    innovation_flow: Vec2  # [rad/s]
    # last innovations (measured minus expected), fused or not, for logs
    innovation_vel: Vec3  # GPS [m/s]
    innovation_pos: Vec3  # GPS north and east; down of what the height is from [m]
    innovation_yaw: float  # magnetometer [rad]
    # consistency: normalised innovation squared, sums and counts since the filter started
    nis_sum: Floats = array(4)  # GPS position, GPS velocity, height, magnetometer
    nis_count: Ints = array(4, stored="i8")
