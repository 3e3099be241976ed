# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of what every vehicle has: arming, battery, log, links, missions."""

from __future__ import annotations

from typing import Any

from .parameter import BITS32, INT8, INT16, INT32, ParameterGroup, group, param
from .simulation import Axes, hard_iron


class Arming(ParameterGroup):
    """ARMING_: which checks, and arming by stick."""

    RUDDER: float = param(2, 0, 2, "", "Yaw stick: 0 nothing, 1 arms, 2 arms and disarms", INT8)
    CHECK: float = param(
        1,
        *BITS32,
        "",
        "Checks before arming: 1 all, else 2 barometer, 4 compass, 8 GPS, 16 IMU, 64 RC, 256 battery",
        INT32,
    )


class Battery(ParameterGroup):
    """BATT_: battery monitor and failsafe."""

    MONITOR: float = param(
        0, -128, 127, "", "0 none, 3 voltage, 4 voltage and current, others do not exist; counts from power-on", INT8
    )
    VOLT_PIN: float = param(13, -128, 127, "", "Pin of the voltage; below 0: none, the monitor fails", INT8)
    CAPACITY: float = param(3300, 0, 2000000, "mAh", "Charge of the full battery", INT32)
    LOW_TIMER: float = param(10, 0, 120, "s", "Voltage is low only when low for so long", INT8)
    LOW_VOLT: float = param(10.5, 0.0, 120.0, "V", "Low; 0 off")
    LOW_MAH: float = param(0.0, 0.0, 2000000.0, "mAh", "Low when less is left; 0 off")
    CRT_VOLT: float = param(0.0, 0.0, 120.0, "V", "Critical; 0 off")
    CRT_MAH: float = param(0.0, 0.0, 2000000.0, "mAh", "Critical when less is left; 0 off")
    ARM_VOLT: float = param(0.0, 0.0, 120.0, "V", "Least voltage for arming; 0 off")
    ARM_MAH: float = param(0, 0, 2000000, "mAh", "Least charge left for arming; 0 off", INT32)


class Ahrs(ParameterGroup):
    """AHRS_: how the autopilot is mounted."""

    TRIM: Axes = group("How far it leans in a vehicle that is level [rad]")


class Inertial(ParameterGroup):
    """INS_: calibration and filters of accelerometers and gyros."""

    GYROFFS: Axes = group("Taken off what the gyro shows [rad/s]")
    ACCOFFS: Axes = group("Taken off what the accelerometer shows [m/s/s]")
    ACCSCAL: Axes = group("Factor of what the accelerometer then shows", X=1.0, Y=1.0, Z=1.0)
    GYRO_FILTER: float = param(20, 0, 256, "Hz", "Cut-off of the low-pass of rates before controllers; 0: none", INT16)
    ACCEL_FILTER: float = param(20, 0, 256, "Hz", "The same of the acceleration", INT16)


class Compass(ParameterGroup):
    """COMPASS_: calibration of the compasses; arming checks compare the second and third with the first."""

    OFS: Axes = hard_iron("Added to what the first compass shows")
    DIA: Axes = group("First compass: diagonal of the matrix for soft iron", X=1.0, Y=1.0, Z=1.0)
    ODI: Axes = group("First compass: elements xy, xz and yz of that matrix")
    OFS2: Axes = hard_iron("Added to what the second compass shows")
    DIA2: Axes = group("Second compass: diagonal of the matrix for soft iron", X=1.0, Y=1.0, Z=1.0)
    ODI2: Axes = group("Second compass: elements xy, xz and yz of that matrix")
    OFS3: Axes = hard_iron("Added to what the third compass shows")
    DIA3: Axes = group("Third compass: diagonal of the matrix for soft iron", X=1.0, Y=1.0, Z=1.0)
    ODI3: Axes = group("Third compass: elements xy, xz and yz of that matrix")
    CAL_FIT: float = param(16, 0, 100, "mGauss", "Greatest mean error of a calibration that counts")
    OFFS_MAX: float = param(1800, 0, 3000, "mGauss", "Greatest offset of a calibration that counts", INT16)
    USE: float = param(1, 0, 1, "", "1 the first compass counts", INT8)
    USE2: float = param(1, 0, 1, "", "1 the second compass counts", INT8)
    USE3: float = param(1, 0, 1, "", "1 the third compass counts", INT8)


class Failsafes(ParameterGroup):
    """FS_: failsafes, as far as all firmwares have them; ranges and meanings are those of the firmware."""

    GCS_ENABLE: float = param(0, 0, 7, "", "Ground station lost: 0 nothing, else what the firmware does", INT8)
    GCS_TIMEOUT: float = param(5.0, 2.0, 120.0, "s", "Silence of the ground station that counts as lost")
    EKF_THRESH: float = param(
        0.8, 0.0, 2.0, "", "Test ratio of the estimator that counts as bad; 0 switches the check off"
    )


class Log(ParameterGroup):
    """LOG_: the on-board log (``sitl.logs.dataflash``); the core does not read these."""

    BACKEND_TYPE: float = param(1, 0, 1, "", "Where the on-board log goes: 0 nowhere, 1 into a file", INT8)
    BITMASK: float = param(180222, *BITS32, "", "What is logged: a bit for each group of messages", INT32)
    DISARMED: float = param(0, 0, 3, "", "0 log while armed, 1 and 2 always, 3 always, but keep only flights", INT8)


class Mavlink(ParameterGroup):
    """MAV_: identity on the links."""

    SYSID: float = param(1.0, 1.0, 255.0, "", "System id of the vehicle", INT16)
    GCS_SYSID: float = param(255.0, 1.0, 255.0, "", "System id whose sticks and heartbeats count as the pilot's", INT16)


def _rate(what: str) -> Any:
    return param(0.0, 0.0, 400.0, "Hz", f"Rate of {what} on every channel until a client asks otherwise", INT16)


class StreamRates(ParameterGroup):
    """MAV1_: rates of telemetry."""

    RAW_SENS: float = _rate("RAW_IMU, SCALED_PRESSURE")
    EXT_STAT: float = _rate("SYS_STATUS, POWER_STATUS, MEMINFO, MISSION_CURRENT, GPS_RAW_INT, NAV_CONTROLLER_OUTPUT")
    RC_CHAN: float = _rate("SERVO_OUTPUT_RAW, RC_CHANNELS")
    RAW_CTRL: float = _rate("RC_CHANNELS_SCALED (rovers only)")
    POSITION: float = _rate("GLOBAL_POSITION_INT, LOCAL_POSITION_NED")
    EXTRA1: float = _rate("ATTITUDE, SIMSTATE, AHRS2")
    EXTRA2: float = _rate("VFR_HUD")
    EXTRA3: float = _rate("AHRS, SYSTEM_TIME, BATTERY_STATUS, EKF_STATUS_REPORT")


class Mission(ParameterGroup):
    """MIS_: missions."""

    TOTAL: float = param(1, 0, 32766, "", "Items in the mission, home included; read only", INT16, read_only=True)
    RESTART: float = param(0, 0, 1, "", "On entering AUTO: 0 resume the mission, 1 start again", INT8)


class SmartRtl(ParameterGroup):
    """SRTL_: SMART_RTL's path."""

    ACCURACY: float = param(2.0, 0.0, 10.0, "m", "Least distance of two points on the path")
    POINTS: float = param(300, 0, 500, "", "Most points on the path; 0: no path is kept", INT16)


class Statistics(ParameterGroup):
    """STAT_: kept by the drop-in executables; the core does not read these."""

    BOOTCNT: float = param(0, 0, 32767, "", "Boots so far", INT16)
    FLTTIME: float = param(0, 0, 2147483647, "s", "Time in flight so far, up to the last half minute", INT32)
    RUNTIME: float = param(0, 0, 2147483647, "s", "Time running so far, up to the last half minute", INT32)
    RESET: float = param(
        1, 0, 2147483647, "s", "When these were set to zero, since 2016-01-01; write 0 to set them to zero", INT32
    )
