# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot's record. SI units, NED world frame, FRD body frame, angles in radians unless a line says otherwise.

``SENSORS`` and ``ACTUATORS`` are the border to physics and carry what MAVLink's HIL_SENSOR, HIL_GPS and
HIL_ACTUATOR_CONTROLS carry, at that precision (https://mavlink.io/en/messages/common.html#HIL_SENSOR).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.records import record
from .arming_state import ARMING_DTYPE
from .estimation.state import EKF_DTYPE
from .events import EVENT_RING
from .inertial_ring import INERTIAL_RING_DTYPE

LIDAR_SAMPLES = 360
"""Readings of a scan that there is room for."""

RC_INPUTS = 12
"""Channels of HIL_RC_INPUTS_RAW."""

SENSORS_DTYPE = record(
    # HIL_SENSOR, one a tick
    ("time_us", "i8"),
    ("acc", "f4", 3),  # specific force, body [m/s^2]; at rest and level (0, 0, -9.81)
    ("gyro", "f4", 3),  # body rates [rad/s]
    ("mag", "f4", 3),  # field, body [gauss]
    ("abs_pressure", "f4"),  # [hPa]
    ("temperature", "f4"),  # [degC]
    ("mag_count", "i8"),  # samples so far; a change tells the reader that the sample is new
    ("baro_count", "i8"),
    # HIL_GPS
    ("gps_count", "i8"),
    ("gps_time_us", "i8"),  # when the reader got it; the fix is older by the receiver's delay
    ("gps_fix", "i8"),  # GPS_FIX_TYPE: 0 no GPS, 1 none, 3 3D
    ("gps_lat", "i4"),  # [degE7]
    ("gps_lon", "i4"),  # [degE7]
    ("gps_alt", "i4"),  # above mean sea level [mm]
    ("gps_eph", "i4"),  # HDOP * 100
    ("gps_epv", "i4"),  # VDOP * 100
    ("gps_vel", "i4", 3),  # NED [cm/s]
    ("gps_satellites", "i4"),
    # BATTERY_STATUS
    ("battery_voltage", "f4"),  # [V]
    ("battery_current", "f4"),  # [A]
    # WHEEL_DISTANCE, of a vehicle with encoders
    ("wheel_count", "i8"),  # samples so far
    ("wheel_distance", "f8", 2),  # rolled by the left and right driven wheel since power-on, forward positive [m]
    # OBSTACLE_DISTANCE, DISTANCE_SENSOR: of a vehicle in a world (written by sitl.plants.lidar)
    ("lidar_count", "i8"),  # scans so far
    ("lidar_time_us", "i8"),  # of the last one
    ("rangefinder_count", "i8"),  # readings so far
    ("lidar_ranges", "f4", LIDAR_SAMPLES),  # counter-clockwise from right to left [m]; inf: nothing in range
    ("rangefinder_range", "f4", 1),  # looking down [m]; inf: nothing in range
    # HIL_RC_INPUTS_RAW: frames of a receiver that the physics side has; without any there is a simulated transmitter
    ("rc_count", "i8"),  # frames so far
    ("rc_time_us", "i8"),  # of the last one
    ("rc_channels", "i8", RC_INPUTS),  # pulses [us]; 0 unknown
)

ACTUATORS_DTYPE = record(
    ("controls", "f4", 16),  # 0 .. 1 a rotor (zero when disarmed), -1 .. 1 a servo or a wheel's motor
    ("pwm", "i8", 16),  # the same as pulses [us], whole microseconds
    ("armed", "i8"),
)

ESTIMATE_DTYPE = record(
    ("q", "f8", 4),  # body to NED
    ("euler", "f8", 3),  # roll, pitch, yaw
    ("rates", "f8", 3),  # body rates without bias [rad/s], every tick
    ("acc_ned", "f8", 3),  # acceleration NED, gravity removed [m/s^2], every tick
    ("vel", "f8", 3),  # NED [m/s]
    ("pos", "f8", 3),  # NED from the origin [m]; pos[2] negative up
    ("gyro_bias", "f8", 3),
    ("acc_bias", "f8", 3),
    ("origin_set", "i8"),
    ("origin_lat", "i8"),  # [degE7]
    ("origin_lon", "i8"),
    ("origin_alt", "f8"),  # above mean sea level [m]
    ("status_flags", "i8"),  # EKF_STATUS_FLAGS
    ("variance_vel", "f8"),  # normalised test ratios as in EKF_STATUS_REPORT
    ("variance_pos", "f8"),
    ("variance_hgt", "f8"),
    ("variance_mag", "f8"),
    ("attitude_ok", "i8"),  # aligned in tilt and yaw
    ("position_ok", "i8"),  # GPS in use: modes that need a position may be armed
    ("reset_ne_count", "i8"),  # counts jumps of horizontal position/velocity, so that controllers can follow
    ("reset_d_count", "i8"),
    ("reset_yaw_count", "i8"),
    ("reset_pos", "f8", 3),  # last jump of pos [m]
    ("reset_vel", "f8", 3),  # last jump of vel [m/s]
    ("reset_yaw", "f8"),  # last jump of yaw [rad]
)

RC_DTYPE = record(
    ("channels", "i8", 18),  # pulses in use [us]; 0 unknown
    ("override", "i8", 18),  # 0 none
    ("override_us", "i8", 18),  # when the override was last given
    ("has_receiver", "i8"),  # a receiver is fitted
    ("receiver_us", "i8"),  # last good frame
    ("receiver_ok", "i8"),
)

HOME_DTYPE = record(
    ("is_set", "i8"),
    ("locked", "i8"),  # set by the user: arming does not move it
    ("lat", "i8"),  # [degE7]
    ("lon", "i8"),
    ("alt", "f8"),  # above mean sea level [m]
    ("pos", "f8", 3),  # NED from the origin [m]
)

BATTERY_DTYPE = record(
    ("voltage", "f8"),  # filtered [V]
    ("current", "f8"),  # [A]
    ("consumed_mah", "f8"),
    ("consumed_wh", "f8"),
    ("remaining_pct", "f8"),
)

EVENTS_DTYPE = record(
    ("count", "i8"),  # events so far; event k is at k % EVENT_RING
    ("attention", "i8"),  # not 0: the core returns to the shell at the end of this tick
    ("time_us", "i8", EVENT_RING),
    ("code", "i8", EVENT_RING),  # sitl.autopilot.events
    ("a", "f8", EVENT_RING),
    ("b", "f8", EVENT_RING),
)


def autopilot_dtype(params: np.dtype[Any], modes: np.dtype[Any], control: np.dtype[Any]) -> np.dtype[Any]:
    """The record of a firmware: what all firmwares share, and its own parameters, modes and controllers."""
    return record(
        ("params", params),
        ("estimate", ESTIMATE_DTYPE),
        ("ekf", EKF_DTYPE),
        ("rc", RC_DTYPE),
        ("home", HOME_DTYPE),
        ("battery", BATTERY_DTYPE),
        ("arming", ARMING_DTYPE),
        ("modes", modes),
        ("control", control),
        ("events", EVENTS_DTYPE),
        ("inertial", INERTIAL_RING_DTYPE),
    )
