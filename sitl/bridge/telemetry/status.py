# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle's state: system, battery, mission, channels, and who it is."""

from __future__ import annotations

import struct
from collections.abc import Callable

from ..dialect import message
from .builder import Build, Builder, Context, boot_ms, int16, int32, percent, uint16

E = "autopilot.estimate."
A = "autopilot.arming."
M = "autopilot.modes."
B = "autopilot.battery."

GYRO, ACCEL, MAG, BARO, GPS = 0x1, 0x2, 0x4, 0x8, 0x20
RATE, ATTITUDE, YAW, ALTITUDE, POSITION, MOTORS = 0x400, 0x800, 0x1000, 0x2000, 0x4000, 0x8000
RECEIVER, GEOFENCE, AHRS, BATTERY, PREARM = 0x10000, 0x100000, 0x200000, 0x2000000, 0x10000000
PRESENT = GYRO | ACCEL | MAG | BARO | GPS | AHRS | PREARM
"""In every firmware, besides its controllers."""
SAMPLE_US = 500_000
"""A sensor is healthy while the filter's last sane sample of it is no older."""
GPS_US = 4_000_000
"""So for the GPS receiver's messages."""
VOLTAGE_MONITOR, CURRENT_MONITOR = 3, 4
"""BATT_MONITOR: what is measured from this number on; the rest is unknown."""


def sensor_health(context: Context) -> Callable[[], int]:
    """Health bits of IMU, compass, barometer, GPS and attitude, as the firmware knows them.

    Samples must have come; once the filter is aligned, sane ones must keep coming.
    """
    ekf, s = "autopilot.ekf.", "sensors."
    read = context.fields(
        "time_us", s + "time_us", s + "mag_count", s + "baro_count", s + "gps_fix", s + "gps_time_us",
        ekf + "use_external", ekf + "yaw_aligned", ekf + "bad_imu", ekf + "mag_us", ekf + "baro_us",
        E + "attitude_ok",
    )  # fmt: skip

    def build() -> int:
        t, imu_us, mags, baros, fix, gps_us, external, aligned, bad_imu, mag_us, baro_us, attitude_ok = read()
        watched = aligned and not external
        health = GYRO | ACCEL if imu_us > 0 and (external or bad_imu == 0) else 0
        health |= MAG if mags > 0 and not (watched and t - mag_us > SAMPLE_US) else 0
        health |= BARO if baros > 0 and not (watched and t - baro_us > SAMPLE_US) else 0
        health |= GPS if fix >= 3 and t - gps_us <= GPS_US else 0
        return health | (AHRS if attitude_ok else 0)

    return build


def sys_status(context: Context) -> Build:
    """SYS_STATUS: sensor bits (the pre-arm checks are bit 0x10000000), mV, cA, %; load and error counts are 0."""
    read = context.fields(
        B + "voltage", B + "current", B + "remaining_pct", M + "number", A + "armed", A + "prearm_ok",
        "autopilot.rc.receiver_ok", M + "failsafe.battery", "autopilot.params.BATT.MONITOR",
    )  # fmt: skip
    sensors = sensor_health(context)
    controllers, at_work, healthy_at_rest = context.profile.controllers
    pack = message("SYS_STATUS").pack

    def build() -> bytes:
        voltage, current, remaining, mode, armed, prearm, receiver, battery_low, monitor = read()
        common = PRESENT | (RECEIVER if receiver else 0) | (BATTERY if monitor >= VOLTAGE_MONITOR else 0)
        enabled = at_work(mode, armed)
        health = (controllers if healthy_at_rest else enabled) | (common & RECEIVER)  # cannot fail
        health |= GEOFENCE | sensors()  # no fence is not a breached one
        present, enabled = common | controllers, common | enabled
        health |= 0 if battery_low else present & BATTERY
        health |= PREARM if prearm or armed else 0
        millivolts = uint16(voltage * 1e3) if monitor >= VOLTAGE_MONITOR else 65535
        centiamperes = int16(current * 100.0) if monitor >= CURRENT_MONITOR else -1
        # the extension fields (three more words of sensor bits) stay zero
        power = (0, millivolts, centiamperes, 0, 0, 0, 0, 0, 0, percent(remaining))
        return pack(present, enabled, health, *power, 0, 0, 0)

    return build


def ekf_status_report(context: Context) -> Build:
    """EKF_STATUS_REPORT: flags and normalised innovation test ratios."""
    read = context.fields(*(E + "variance_" + x for x in ("vel", "pos", "hgt", "mag")), E + "status_flags")
    pack = message("EKF_STATUS_REPORT").pack

    def build() -> bytes:
        velocity, position, height, compass, flags = read()
        return pack(velocity, position, height, compass, 0.0, flags & 0xFFFF, 0.0)

    return build


def battery_status(context: Context) -> Build:
    """BATTERY_STATUS: mV, cA, mAh, hJ, %; what BATT_MONITOR does not measure is 65535 (cells, too) or -1."""
    names = ("voltage", "current", "consumed_mah", "consumed_wh", "remaining_pct")
    read = context.fields(*(B + name for name in names), "autopilot.params.BATT.MONITOR")
    pack = message("BATTERY_STATUS").pack

    def build() -> bytes:
        voltage, current, mah, wh, remaining, monitor = read()
        millivolts = uint16(voltage * 1e3) if monitor >= VOLTAGE_MONITOR else 65535
        used, centiamperes = (-1, -1), -1
        if monitor >= CURRENT_MONITOR:
            used, centiamperes = (int32(mah), int32(wh * 36.0)), int16(current * 100.0)
        rest = (centiamperes, 0, 0, 0, percent(remaining), 0, 1, 0, 0, 0, 0, 0, 0)
        return pack(*used, 32767, millivolts, *(65535,) * 9, *rest)

    return build


def power_status(context: Context) -> Build:
    """POWER_STATUS: the board's 5 V rail [mV]."""
    payload = message("POWER_STATUS").payload(Vcc=5000)
    return lambda: payload


def meminfo(context: Context) -> Build:
    """MEMINFO: a process has memory enough; the figure of ArduPilot's SITL."""
    payload = message("MEMINFO").payload(freemem=65535, freemem32=131072)
    return lambda: payload


def system_time(context: Context) -> Build:
    """SYSTEM_TIME: Unix time in simulated microseconds, milliseconds since boot."""
    read = context.fields("time_us")
    pack = message("SYSTEM_TIME").pack

    def build() -> bytes:
        t = read()[0]
        return pack(context.epoch_us + t, boot_ms(t))

    return build


NO_MISSION, NOT_STARTED, ACTIVE, PAUSED, COMPLETE = 1, 2, 3, 4, 5


def mission_current(context: Context) -> Build:
    """MISSION_CURRENT: number of the item, number of items without home, state."""
    read = context.fields(
        M + "number", M + "nav.mission_state", M + "nav.mission_current",
        "autopilot.params.MIS.TOTAL",
    )  # fmt: skip
    pack, auto = message("MISSION_CURRENT").pack, context.profile.auto

    def build() -> bytes:
        mode, state, seq, total = read()
        if total <= 1.0:
            shown = NO_MISSION
        elif state == 2:
            shown = COMPLETE
        elif state == 1:
            shown = ACTIVE
        else:
            shown = PAUSED if seq > 0 else NOT_STARTED
        return pack(uint16(seq), uint16(total - 1.0), shown, 1 if mode == auto else 0)

    return build


MISSION_FLOAT, PARAM_FLOAT, MISSION_INT, COMMAND_INT, FTP = 0x1, 0x2, 0x4, 0x8, 0x20
SET_ATTITUDE, SET_LOCAL_POSITION, SET_GLOBAL_POSITION, TERMINATION, MAVLINK2 = (
    0x40,
    0x80,
    0x100,
    0x800,
    0x2000,
)
CAPABILITIES = MISSION_FLOAT | PARAM_FLOAT | MISSION_INT | COMMAND_INT | FTP
CAPABILITIES |= SET_ATTITUDE | SET_LOCAL_POSITION | SET_GLOBAL_POSITION | MAVLINK2
"""What every firmware can; ArduPilot's 0xF1EF without what does not exist here (compass calibration, fence, rally)."""

FLIGHT_VERSION = (4, 7, 0, 0)
"""Major, minor, patch, type (0: development).

The ArduPilot whose behaviour and parameter names this firmware follows.
"""


def autopilot_version(context: Context) -> Build:
    """AUTOPILOT_VERSION: capabilities and version."""
    major, minor, patch, kind = FLIGHT_VERSION
    version = major << 24 | minor << 16 | patch << 8 | kind
    payload = message("AUTOPILOT_VERSION").payload(
        capabilities=context.profile.capabilities,
        flight_sw_version=version,
        flight_custom_version=tuple(b"gym-sitl"),
        uid=1,
    )
    return lambda: payload


def timesync(context: Context) -> Build:
    """TIMESYNC: our request; ts1 is simulated time [ns]."""
    read, kind = context.fields("time_us"), message("TIMESYNC")
    rest = (0,) * (len(kind.fields) - 2)
    return lambda: kind.pack(0, read()[0] * 1000 + 1, *rest)


CHANNELS = 16
"""chancount of a receiver, as ArduPilot tells it."""


def rc_channels(context: Context) -> Build:
    """RC_CHANNELS: pulses in use [us], 0 where there is none; no channels are counted without receiver or override."""
    read = context.fields("time_us", "autopilot.rc.channels")
    read_heard = context.fields("autopilot.rc.receiver_us")
    timeout = context.profile.receiver_timeout
    read_timeout = context.fields(f"autopilot.params.{timeout}") if isinstance(timeout, str) else lambda: (timeout,)
    pack = message("RC_CHANNELS").pack

    def build() -> bytes:
        t, *pulses = read()
        count = CHANNELS if any(pulses) and t - read_heard()[0] < read_timeout()[0] * 1e6 else 0
        try:
            return pack(t // 1000 & 0xFFFFFFFF, *pulses, count, 255)
        except struct.error:  # not a pulse: rare, so that the usual case need not look at each
            return pack(t // 1000 & 0xFFFFFFFF, *map(uint16, pulses), count, 255)

    return build


def servo_output_raw(context: Context) -> Build:
    """SERVO_OUTPUT_RAW: pulses to motors and servos [us]."""
    read = context.fields("time_us", "actuators.pwm")
    pack = message("SERVO_OUTPUT_RAW").pack

    def build() -> bytes:
        t, *pulses = read()
        try:
            return pack(t & 0xFFFFFFFF, *pulses[:8], 0, *pulses[8:])
        except struct.error:
            pulses = [uint16(p) for p in pulses]
            return pack(t & 0xFFFFFFFF, *pulses[:8], 0, *pulses[8:])

    return build


BUILDERS: dict[str, Builder] = {
    "SYS_STATUS": sys_status,
    "EKF_STATUS_REPORT": ekf_status_report,
    "BATTERY_STATUS": battery_status,
    "POWER_STATUS": power_status,
    "MEMINFO": meminfo,
    "SYSTEM_TIME": system_time,
    "MISSION_CURRENT": mission_current,
    "AUTOPILOT_VERSION": autopilot_version,
    "TIMESYNC": timesync,
    "RC_CHANNELS": rc_channels,
    "SERVO_OUTPUT_RAW": servo_output_raw,
}
