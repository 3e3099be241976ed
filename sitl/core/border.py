# SPDX-License-Identifier: BSD-3-Clause
"""The border between physics and autopilot: what each lets the other know, and nothing else.

It carries what MAVLink's HIL_SENSOR, HIL_GPS and HIL_ACTUATOR_CONTROLS carry, at that precision
(https://mavlink.io/en/messages/common.html#HIL_SENSOR).
"""

from __future__ import annotations

from typing import Annotated

from .records import Float32, Floats, Int32, Ints, Record, Stored, array
from .vectors import Vec2, Vec3

LIDAR_SAMPLES = 360
"""Readings of a scan that there is space for."""

ESCS = 8
"""Motors with a speed controller that there is space for."""

RC_INPUTS = 16
"""Channels of a receiver."""

IMUS_DIFFER, GYRO_SILENT, ACC_SILENT = 1, 2, 8
"""``Sensors.imu_state``: the second IMU shows something of its own; a gyro or accelerometer of the first IMU sends
nothing, and, twice the bit, of the second."""

NarrowVec3 = Annotated[Vec3, Stored("f4")]
"""A vector at float32 precision, as HIL_SENSOR carries it."""
NarrowVec2 = Annotated[Vec2, Stored("f4")]


ONE_BARO, BAROS_DIFFER = 1, 2
"""``Sensors.baro_state``: there is no second barometer; the second one shows something of its own."""


class GpsReading(Record):
    """What a GPS receiver says: HIL_GPS."""

    gps_count: int
    gps_time_us: int  # when the reader got it; the fix is older by the receiver's delay
    gps_fix: int  # GPS_FIX_TYPE: 0 no GPS, 1 none, 3 3D, 6 RTK fixed
    gps_lat: Int32  # [degE7]
    gps_lon: Int32  # [degE7]
    gps_alt: Int32  # above mean sea level [mm]
    gps_eph: Int32  # HDOP * 100
    gps_epv: Int32  # VDOP * 100
    gps_vel: Annotated[Vec3, Stored("i4")]  # NED, whole [cm/s]
    gps_satellites: Int32


class Sensors(GpsReading):
    """What the autopilot gets from its sensors; as a GpsReading, what the first receiver says."""

    # HIL_SENSOR, one a tick
    time_us: int
    acc: NarrowVec3  # specific force, body [m/s^2]; at rest and level (0, 0, -9.81)
    gyro: NarrowVec3  # body rates [rad/s]
    mag: NarrowVec3  # field, body [gauss]
    abs_pressure: Float32  # [hPa]
    temperature: Float32  # [degC]
    mag_count: int  # samples so far; a change tells the reader that the sample is new
    baro_count: int
    gps2: GpsReading  # what a second receiver says; zeros where there is none
    # BATTERY_STATUS
    battery_voltage: Float32  # [V]
    battery_current: Float32  # [A]
    # two more compasses; zero where there are none
    mag2: NarrowVec3  # field, body [gauss]
    mag3: NarrowVec3
    mag_us: Ints = array(3, stored="i8")  # when each compass was last received; 0: never, or its reader does not know
    # a second barometer
    baro_state: int  # 0: it shows what the first does; else bits ONE_BARO, BAROS_DIFFER
    baro2_count: int  # samples, while they differ
    abs_pressure2: Float32  # [hPa]
    # a second IMU
    imu_state: int  # 0: it shows what the first does; else bits IMUS_DIFFER, GYRO_SILENT, ACC_SILENT
    acc2: NarrowVec3  # specific force, body [m/s^2]
    gyro2: NarrowVec3  # body rates [rad/s]
    # ESC_TELEMETRY, of a vehicle whose speed controllers report how fast motors turn
    esc_count: int  # samples so far
    esc_time_us: int  # of the last one
    esc_motors: int
    esc_rpm: Floats = array(ESCS, stored="f4")
    # WHEEL_DISTANCE, of a vehicle with encoders
    wheel_count: int  # samples so far
    wheel_distance: Vec2  # rolled by the left and right driven wheel since power-on, forward positive [m]
    # OBSTACLE_DISTANCE, DISTANCE_SENSOR: of a vehicle in a world (written by sitl.physics.native.ranging)
    lidar_count: int  # scans so far
    lidar_time_us: int  # of the last one
    rangefinder_count: int  # readings so far
    lidar_samples: int  # of a scan
    lidar_fov: float  # symmetric about straight ahead [rad]
    lidar_min: float  # range [m]
    lidar_max: float
    # counter-clockwise from right to left [m]; inf: nothing in range
    lidar_ranges: Floats = array(LIDAR_SAMPLES, stored="f4")
    rangefinder_range: Floats = array(1, stored="f4")  # looking down [m]; inf: nothing in range
    # HIL_OPTICAL_FLOW, of a vehicle with such a sensor, which looks down
    flow_count: int  # samples so far
    flow_rate: NarrowVec2  # of the ground about the sensor's x and y axes, body rates included [rad/s]
    flow_body: NarrowVec2  # body rates of the same time [rad/s]
    flow_quality: Int32  # 0 the ground was not seen .. 255
    # HIL_RC_INPUTS_RAW: frames of a receiver that the physics side has; without any there is a simulated transmitter
    rc_count: int  # frames so far
    rc_time_us: int  # of the last one; in the future: it is repeated until then
    rc_channels: Ints = array(RC_INPUTS, stored="i8")  # pulses [us]; 0 unknown


class Actuators(Record):
    """What the autopilot gives to motors and servos."""

    controls: Floats = array(16, stored="f4")  # 0 .. 1 a rotor (zero when disarmed), -1 .. 1 a servo or a wheel's motor
    pwm: Ints = array(16, stored="i8")  # the same as pulses [us], whole microseconds
    armed: bool
