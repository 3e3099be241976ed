# SPDX-License-Identifier: BSD-3-Clause
"""How the vehicle is: HEARTBEAT, SYS_STATUS, EXTENDED_SYS_STATE, EKF_STATUS_REPORT, power, memory, time."""

from __future__ import annotations

from ..dialect import message
from .builder import Build, Builder, Context
from .units import boot_ms, int16, int32, uint16

E = "autopilot.estimate."
A = "autopilot.arming."
M = "autopilot.modes."
B = "autopilot.battery."

QUADROTOR, ARDUPILOTMEGA = 2, 3
CUSTOM_MODE, GUIDED, STABILIZED, MANUAL_INPUT, ARMED = 1, 8, 16, 64, 128
STANDBY, ACTIVE, CRITICAL = 3, 4, 5
GUIDED_MODES = frozenset((3, 4, 5, 6, 7, 16, 17, 21, 23))
"""Copter modes that steer by themselves (AUTO, GUIDED, LOITER, RTL, CIRCLE, POSHOLD, BRAKE, SMART_RTL.

FOLLOW).
"""


def heartbeat(context: Context) -> Build:
    """HEARTBEAT: quadrotor, ArduPilot, mode number, armed bit."""
    read = context.fields(
        A + "armed", A + "landed", M + "number", M + "failsafe.gcs", M + "failsafe.radio",
        M + "failsafe.battery", M + "failsafe.ekf",
    )  # fmt: skip
    pack = message("HEARTBEAT").pack

    def build() -> bytes:
        armed, landed, mode, gcs, radio, battery, ekf = read()
        base = CUSTOM_MODE | STABILIZED | MANUAL_INPUT
        base |= (GUIDED if mode in GUIDED_MODES else 0) | (ARMED if armed else 0)
        failsafe = gcs or radio or battery or ekf
        state = CRITICAL if failsafe else STANDBY if landed else ACTIVE
        return pack(mode & 0xFFFFFFFF, QUADROTOR, ARDUPILOTMEGA, base, state, 3)

    return build


GYRO, ACCEL, MAG, BARO, GPS = 0x1, 0x2, 0x4, 0x8, 0x20
RATE, ATTITUDE, YAW, ALTITUDE, POSITION, MOTORS = 0x400, 0x800, 0x1000, 0x2000, 0x4000, 0x8000
RECEIVER, GEOFENCE, AHRS, LOGGING, BATTERY, PREARM = 0x10000, 0x100000, 0x200000, 0x1000000, 0x2000000, 0x10000000
PRESENT = (
    GYRO
    | ACCEL
    | MAG
    | BARO
    | GPS
    | RATE
    | ATTITUDE
    | YAW
    | ALTITUDE
    | POSITION
    | MOTORS
    | AHRS
    | BATTERY
    | PREARM
)
POSITION_MODES = frozenset((3, 4, 5, 6, 7, 9, 16, 17))
ALTITUDE_MODES = POSITION_MODES | {2}


def sys_status(context: Context) -> Build:
    """SYS_STATUS: sensor bits (the pre-arm checks are bit 0x10000000), mV, cA, %."""
    read = context.fields(
        B + "voltage", B + "current", B + "remaining_pct", M + "number", A + "armed", A + "prearm_ok",
        E + "attitude_ok", "sensors.gps_fix", "autopilot.rc.receiver_ok",
    )  # fmt: skip
    pack = message("SYS_STATUS").pack

    def build() -> bytes:
        voltage, current, remaining, mode, armed, prearm, attitude_ok, fix, receiver = read()
        present = PRESENT | (RECEIVER if receiver else 0)
        enabled = present & ~(POSITION | ALTITUDE | MOTORS)
        enabled |= POSITION if mode in POSITION_MODES else 0
        enabled |= ALTITUDE if mode in ALTITUDE_MODES else 0
        enabled |= MOTORS if armed else 0
        health = present & ~(AHRS | GPS | PREARM) | GEOFENCE  # no fence is not a breached one
        health |= (AHRS if attitude_ok else 0) | (GPS if fix >= 3 else 0) | (PREARM if prearm or armed else 0)
        percent = min(max(int(remaining), 0), 100) if remaining == remaining else -1
        # the extension fields (three more words of sensor bits) stay zero
        power = (0, uint16(voltage * 1e3), int16(current * 100.0), 0, 0, 0, 0, 0, 0, percent)
        return pack(present, enabled, health, *power, 0, 0, 0)

    return build


ON_GROUND, IN_AIR, TAKING_OFF, LANDING = 1, 2, 3, 4


def extended_sys_state(context: Context) -> Build:
    """EXTENDED_SYS_STATE: on the ground, taking off, in the air, landing."""
    read = context.fields(
        A + "landed", M + "number", M + "guided.submode", M + "takeoff.user_active", M + "landing.landing",
        M + "nav.command_kind", M + "takeoff.complete",
    )  # fmt: skip
    pack = message("EXTENDED_SYS_STATE").pack

    def build() -> bytes:
        landed, mode, guided_submode, user_takeoff, landing, kind, takeoff_complete = read()
        if landed:
            state = ON_GROUND
        elif landing:
            state = LANDING
        else:
            climbs = (mode == 4 and guided_submode == 0) or (mode == 3 and kind == 1)
            state = TAKING_OFF if user_takeoff or (climbs and not takeoff_complete) else IN_AIR
        return pack(0, state)

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
    """BATTERY_STATUS: mV, cA, mAh, hJ, %; cell voltages are not measured (65535)."""
    read = context.fields(
        *(B + x for x in ("voltage", "current", "consumed_mah", "consumed_wh", "remaining_pct"))
    )
    pack = message("BATTERY_STATUS").pack

    def build() -> bytes:
        voltage, current, mah, wh, remaining = read()
        percent = min(max(int(remaining), 0), 100) if remaining == remaining else -1
        cells = (uint16(voltage * 1e3), *(65535,) * 9)
        rest = (int16(current * 100.0), 0, 0, 0, percent, 0, 1, 0, 0, 0, 0, 0, 0)
        return pack(int32(mah), int32(wh * 36.0), 32767, *cells, *rest)

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


BUILDERS: dict[str, Builder] = {
    "HEARTBEAT": heartbeat,
    "SYS_STATUS": sys_status,
    "EXTENDED_SYS_STATE": extended_sys_state,
    "EKF_STATUS_REPORT": ekf_status_report,
    "BATTERY_STATUS": battery_status,
    "POWER_STATUS": power_status,
    "MEMINFO": meminfo,
    "SYSTEM_TIME": system_time,
}
