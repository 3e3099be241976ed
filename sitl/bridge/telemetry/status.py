# SPDX-License-Identifier: BSD-3-Clause
"""The vehicle's state: system, battery, mission, time."""

from __future__ import annotations

from ...autopilot import visual_odometry
from ...autopilot.fence.checks import kinds
from ...autopilot.gps_receivers import fix_of, has_fix, time_of
from ...autopilot.optical_flow import is_healthy
from ...autopilot.sensor_calibration import is_received
from ...core.border import ACC_SILENT, GYRO_SILENT
from ...core.kernels import law
from ...core.mavlink import MavSysStatus
from ...core.records import Ints
from ...vehicle.record import Vehicle
from ..wire.message import Message
from ..wire.port import Port
from .fence_status import is_at_work
from .units import boot_ms, int16, int32, percent, uint16

PRESENT = (
    MavSysStatus.SENSOR_3D_GYRO
    | MavSysStatus.SENSOR_3D_ACCEL
    | MavSysStatus.SENSOR_3D_MAG
    | MavSysStatus.SENSOR_ABSOLUTE_PRESSURE
    | MavSysStatus.AHRS
    | MavSysStatus.PREARM_CHECK
)
"""In every firmware, besides its controllers; a GPS receiver once it has said something, until it is silent."""
SAMPLE_US = 500_000
"""A sensor is healthy while the filter's last sane sample of it is no older."""
GPS_US = 4_000_000
"""So for the GPS receiver's messages."""
VOLTAGE_MONITOR, CURRENT_MONITOR = 3, 4
"""BATT_MONITOR: what is measured from this number on; the rest is unknown."""
UNKNOWN = 65535


@law
def sensor_health(v: Vehicle) -> int:
    """Health bits of IMU, compass, barometer, GPS and attitude, as the firmware knows them.

    Samples must have come; once the filter is aligned, sane ones must keep coming.
    """
    t, s, ekf = v.time_us, v.sensors, v.autopilot.ekf
    watched = ekf.yaw_aligned and not ekf.use_external
    health = MavSysStatus.GEOFENCE if v.autopilot.fence.breached == 0 else 0
    if s.time_us > 0 and (ekf.use_external or ekf.bad_imu == 0):
        health |= MavSysStatus.SENSOR_3D_GYRO if s.imu_state & 3 * GYRO_SILENT == 0 else 0
        health |= MavSysStatus.SENSOR_3D_ACCEL if s.imu_state & 3 * ACC_SILENT == 0 else 0
    if s.mag_count > 0 and is_received(0, s, t) and not (watched and t - ekf.mag_us > SAMPLE_US):
        health |= MavSysStatus.SENSOR_3D_MAG
    if s.baro_count > 0 and not (watched and t - ekf.baro_us > SAMPLE_US):
        health |= MavSysStatus.SENSOR_ABSOLUTE_PRESSURE
    receiver = v.autopilot.gps.primary
    if has_fix(receiver, s) and t - time_of(receiver, s) <= GPS_US:
        health |= MavSysStatus.SENSOR_GPS
    if v.autopilot.estimate.attitude_ok:
        health |= MavSysStatus.AHRS
    return health


class SysStatus(Message, name="SYS_STATUS"):
    onboard_control_sensors_present: int
    onboard_control_sensors_enabled: int
    onboard_control_sensors_health: int
    voltage_battery: int
    current_battery: int
    battery_remaining: int


@law
def sys_status(m: SysStatus, v: Vehicle, controllers: int, at_work: int, healthy: int) -> bool:
    """SYS_STATUS of a firmware with these controllers and sensors, of which some are at work and healthy (bits)."""
    ap, battery, monitor = v.autopilot, v.autopilot.battery, v.autopilot.params.BATT.MONITOR
    common = PRESENT | MavSysStatus.SENSOR_MOTOR_OUTPUTS
    health = healthy | sensor_health(v) | MavSysStatus.SENSOR_MOTOR_OUTPUTS
    if fix_of(ap.gps.primary, v.sensors).gps_fix > 0:
        common |= MavSysStatus.SENSOR_GPS
    if ap.rc.receiver_us > 0:
        common |= MavSysStatus.SENSOR_RC_RECEIVER
        health |= MavSysStatus.SENSOR_RC_RECEIVER if ap.rc.receiver_ok else 0
    if monitor >= VOLTAGE_MONITOR:
        common |= MavSysStatus.SENSOR_BATTERY
        if ap.modes.failsafe.battery == 0 and battery.healthy:
            health |= MavSysStatus.SENSOR_BATTERY
    if ap.arming.prearm_ok or ap.arming.armed:
        health |= MavSysStatus.PREARM_CHECK
    logs = MavSysStatus.LOGGING if ap.params.LOG.BACKEND_TYPE != 0.0 else 0
    logs_now = logs if ap.arming.armed_us > 0 or ap.params.LOG.DISARMED != 0.0 else 0
    health |= logs
    if ap.flow.kind != 0:
        common |= MavSysStatus.SENSOR_OPTICAL_FLOW
        health |= MavSysStatus.SENSOR_OPTICAL_FLOW if is_healthy(ap.flow, v.time_us) else 0
    if ap.odometry.kind != 0:
        common |= MavSysStatus.SENSOR_VISION_POSITION
        health |= MavSysStatus.SENSOR_VISION_POSITION if visual_odometry.is_healthy(ap.odometry, v.time_us) else 0
    fence = MavSysStatus.GEOFENCE if kinds(ap.fence, ap.params.FENCE) != 0 else 0
    m.onboard_control_sensors_present = common | controllers | fence | logs
    m.onboard_control_sensors_enabled = common | at_work | (fence if is_at_work(v) else 0) | logs_now
    m.onboard_control_sensors_health = health
    m.voltage_battery = uint16(battery.voltage * 1e3) if monitor >= VOLTAGE_MONITOR else UNKNOWN
    m.current_battery = int16(battery.current * 100.0) if monitor >= CURRENT_MONITOR else -1
    m.battery_remaining = percent(battery.remaining_pct)
    return True


class EkfStatusReport(Message, name="EKF_STATUS_REPORT"):
    velocity_variance: float
    pos_horiz_variance: float
    pos_vert_variance: float
    compass_variance: float
    flags: int


@law
def ekf_status_report(m: EkfStatusReport, v: Vehicle) -> bool:
    """EKF_STATUS_REPORT: flags and normalised innovation test ratios."""
    estimate = v.autopilot.estimate
    m.velocity_variance = estimate.variance_vel
    m.pos_horiz_variance = estimate.variance_pos
    m.pos_vert_variance = estimate.variance_hgt
    m.compass_variance = estimate.variance_mag
    m.flags = estimate.status_flags & 0xFFFF
    return True


class BatteryStatus(Message, name="BATTERY_STATUS"):
    current_consumed: int
    energy_consumed: int
    temperature: int
    voltages: Ints
    current_battery: int
    battery_remaining: int
    charge_state: int


CHARGE_OK, CHARGE_LOW, CHARGE_CRITICAL, CHARGE_UNHEALTHY = 1, 2, 3, 6
"""MAV_BATTERY_CHARGE_STATE"""
NO_TEMPERATURE = 32767


@law
def charge_state(level: int, healthy: bool) -> int:
    """MAV_BATTERY_CHARGE_STATE of what the failsafe has found: 0 nothing, 1 low, 2 critical."""
    if level == 0:
        return CHARGE_OK if healthy else CHARGE_UNHEALTHY
    return CHARGE_LOW if level == 1 else CHARGE_CRITICAL


@law
def battery_status(m: BatteryStatus, v: Vehicle) -> bool:
    """BATTERY_STATUS: mV, cA, mAh, hJ, %; what BATT_MONITOR does not measure is 65535 (cells, too) or -1."""
    battery, monitor = v.autopilot.battery, v.autopilot.params.BATT.MONITOR
    m.current_consumed = m.energy_consumed = m.current_battery = -1
    m.temperature = NO_TEMPERATURE
    for k in range(len(m.voltages)):
        m.voltages[k] = UNKNOWN
    if monitor >= VOLTAGE_MONITOR:
        m.voltages[0] = uint16(battery.voltage * 1e3)
    if monitor >= CURRENT_MONITOR:
        m.current_consumed = int32(battery.consumed_mah)
        m.energy_consumed = int32(battery.consumed_wh * 36.0)
        m.current_battery = int16(battery.current * 100.0)
    m.battery_remaining = percent(battery.remaining_pct)
    m.charge_state = charge_state(v.autopilot.modes.failsafe.battery, battery.healthy)
    return True


class PowerStatus(Message, name="POWER_STATUS"):
    Vcc: int


@law
def power_status(m: PowerStatus, v: Vehicle) -> bool:
    """POWER_STATUS: the board's 5 V rail [mV]."""
    m.Vcc = 5000
    return True


class MemInfo(Message, name="MEMINFO"):
    freemem: int
    freemem32: int


@law
def meminfo(m: MemInfo, v: Vehicle) -> bool:
    """MEMINFO: a process has memory enough; the value of ArduPilot's SITL."""
    m.freemem = 65535
    m.freemem32 = 524288
    return True


class AvailableModesMonitor(Message, name="AVAILABLE_MODES_MONITOR"):
    seq: int


@law
def available_modes_monitor(m: AvailableModesMonitor, v: Vehicle) -> bool:
    """AVAILABLE_MODES_MONITOR: a number that changes when the list of modes does, which it never does: 0."""
    m.seq = 0
    return True


class SystemTime(Message, name="SYSTEM_TIME"):
    time_unix_usec: int
    time_boot_ms: int


@law
def system_time(m: SystemTime, v: Vehicle, port: Port) -> bool:
    """SYSTEM_TIME: Unix time in simulated microseconds, milliseconds since boot."""
    m.time_unix_usec = port.epoch_us + v.time_us
    m.time_boot_ms = boot_ms(v.time_us)
    return True


class TimeSync(Message, name="TIMESYNC"):
    ts1: int


@law
def timesync(m: TimeSync, v: Vehicle) -> bool:
    """TIMESYNC: our request; ts1 is simulated time [ns]."""
    m.ts1 = v.time_us * 1000 + 1
    return True


class MissionCurrent(Message, name="MISSION_CURRENT"):
    seq: int
    total: int
    mission_state: int
    mission_mode: int


NO_MISSION, NOT_STARTED, ACTIVE, PAUSED, COMPLETE = 1, 2, 3, 4, 5


@law
def mission_current(m: MissionCurrent, v: Vehicle, auto: int, paused: bool) -> bool:
    """MISSION_CURRENT of a firmware in which the mode ``auto`` runs missions; ``paused``: by DO_PAUSE_CONTINUE."""
    modes, total = v.autopilot.modes, v.autopilot.params.MIS.TOTAL
    m.seq = uint16(modes.nav.mission_current)
    m.total = uint16(total - 1.0)
    if total <= 1.0:
        m.mission_state = NO_MISSION
    elif modes.nav.mission_state == 2:
        m.mission_state = COMPLETE
    elif paused:
        m.mission_state = PAUSED
    else:
        m.mission_state = ACTIVE if modes.nav.mission_state == 1 else NOT_STARTED
    m.mission_mode = 1 if modes.number == auto else 0
    return True


MESSAGES = (
    ekf_status_report, battery_status, power_status, meminfo, system_time, timesync, available_modes_monitor,
)  # fmt: skip
