# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry that the copter has in its own way: HEARTBEAT, SYS_STATUS, EXTENDED_SYS_STATE, VFR_HUD, RC_CHANNELS."""

from __future__ import annotations

from ...autopilot.avoidance.proximity import has_data
from ...autopilot.control.pid import pid_gains
from ...autopilot.copter.control.altitude import altitude_gains
from ...autopilot.copter.control.altitude_start import is_active_d
from ...autopilot.copter.control.position_start import is_active_ne
from ...autopilot.copter.control.state import Control
from ...autopilot.copter.modes.auto import AUTO
from ...autopilot.copter.modes.guided import GUIDED
from ...autopilot.copter.modes.mode_list import NEED_POSITION
from ...autopilot.navigation.state import TAKEOFF
from ...core.kernels import law
from ...core.mavlink import MavLandedState, MavModeFlag, MavState, MavSysStatus, MavType
from ...core.records import Ints
from ...vehicle.copter import Copter
from ..telemetry import channels, motion, status
from ..telemetry.channels import RcChannels
from ..telemetry.heartbeat import Heartbeat, fill_heartbeat
from ..telemetry.motion import VfrHud
from ..telemetry.own import ExtendedSysState, Wind
from ..telemetry.status import MissionCurrent, SysStatus
from ..telemetry.tuning import PITCH, ROLL, VERTICAL, YAW_LOOP, PidTuning, fill_tuning, next_loop
from ..telemetry.units import uint8, uint16
from ..wire.message import Message
from ..wire.port import Port
from . import targets, terrain_report


@law
def mav_type(motors: int) -> int:
    """MAV_TYPE of a multicopter by its number of motors."""
    if motors == 6:
        return MavType.HEXAROTOR
    return MavType.OCTOROTOR if motors == 8 else MavType.QUADROTOR


@law
def heartbeat(m: Heartbeat, v: Copter) -> bool:
    """HEARTBEAT: kind of multicopter, ArduPilot, mode number, armed bit."""
    arming, modes, failsafe = v.autopilot.arming, v.autopilot.modes, v.autopilot.modes.failsafe
    base = MavModeFlag.CUSTOM_MODE_ENABLED | MavModeFlag.STABILIZE_ENABLED | MavModeFlag.MANUAL_INPUT_ENABLED
    if modes.number in NEED_POSITION:  # holds or changes the position by itself
        base |= MavModeFlag.GUIDED_ENABLED
    if arming.armed:
        base |= MavModeFlag.SAFETY_ARMED
    state = MavState.STANDBY if arming.landed else MavState.ACTIVE
    if failsafe.gcs or failsafe.radio or failsafe.battery != 0 or failsafe.ekf != 0:
        state = MavState.CRITICAL
    return fill_heartbeat(m, v, mav_type(v.autopilot.control.motors.count), base, state)


CONTROLLERS = (
    MavSysStatus.SENSOR_ANGULAR_RATE_CONTROL
    | MavSysStatus.SENSOR_ATTITUDE_STABILIZATION
    | MavSysStatus.SENSOR_YAW_POSITION
    | MavSysStatus.SENSOR_Z_ALTITUDE_CONTROL
    | MavSysStatus.SENSOR_XY_POSITION_CONTROL
    | MavSysStatus.SENSOR_PROPULSION
)
"""Bits of SYS_STATUS"""


@law
def controllers_at_work(control: Control) -> int:
    """Bits of the controllers that run."""
    bits = (
        MavSysStatus.SENSOR_ANGULAR_RATE_CONTROL
        | MavSysStatus.SENSOR_ATTITUDE_STABILIZATION
        | MavSysStatus.SENSOR_YAW_POSITION
        | MavSysStatus.SENSOR_PROPULSION
    )
    if is_active_ne(control):
        bits |= MavSysStatus.SENSOR_XY_POSITION_CONTROL
    if is_active_d(control):
        bits |= MavSysStatus.SENSOR_Z_ALTITUDE_CONTROL
    return bits


@law
def sys_status(m: SysStatus, v: Copter) -> bool:
    """SYS_STATUS: sensor bits (the pre-arm checks are bit 0x10000000), mV, cA, %; load and error counts are 0."""
    ap = v.autopilot
    at_work = controllers_at_work(ap.control)
    healthy = at_work & ~MavSysStatus.SENSOR_PROPULSION if ap.control.motors.boosting else at_work
    looks = MavSysStatus.SENSOR_PROXIMITY if ap.proximity.kind != 0 else 0
    sees = MavSysStatus.SENSOR_PROXIMITY if looks == 0 or has_data(ap.proximity, v.time_us) else 0
    if ap.params.PLND.ENABLED != 0.0:
        looks |= MavSysStatus.SENSOR_VISION_POSITION
        sees |= MavSysStatus.SENSOR_VISION_POSITION if ap.landing_target.sees else 0
    if ap.params.TERRAIN.ENABLE != 0.0:
        looks |= MavSysStatus.TERRAIN
        sees |= MavSysStatus.TERRAIN
    return status.sys_status(m, v, CONTROLLERS | looks, at_work | looks, healthy | sees)


@law
def mission_current(m: MissionCurrent, v: Copter) -> bool:
    """MISSION_CURRENT: number of the item, number of items without home, state."""
    return status.mission_current(m, v, AUTO, v.autopilot.modes.nav.paused)


@law
def rc_channels(m: RcChannels, v: Copter) -> bool:
    """RC_CHANNELS: pulses in use [us], 0 where there is none; no channels are counted without receiver or override."""
    return channels.rc_channels(m, v, v.autopilot.params.RC_FS_TIMEOUT)


@law
def vfr_hud(m: VfrHud, v: Copter) -> bool:
    """VFR_HUD: ground speed in both speeds [m/s], heading [deg], throttle [%], altitude above sea level [m]."""
    return motion.vfr_hud(m, v, v.autopilot.control.motors.throttle_out)


MULTICOPTER = 3
"""MAV_VTOL_STATE_MC"""


@law
def extended_sys_state(m: ExtendedSysState, v: Copter) -> bool:
    """EXTENDED_SYS_STATE: on the ground, taking off, in the air, landing."""
    modes = v.autopilot.modes
    m.vtol_state = MULTICOPTER
    climbs = modes.number == GUIDED and modes.guided.submode == 0
    if modes.number == AUTO and modes.nav.command_kind == TAKEOFF:
        climbs = True
    if v.autopilot.arming.landed:
        m.landed_state = MavLandedState.ON_GROUND
    elif modes.landing.landing:
        m.landed_state = MavLandedState.LANDING
    elif modes.takeoff.user_active or (climbs and not modes.takeoff.complete):
        m.landed_state = MavLandedState.TAKEOFF
    else:
        m.landed_state = MavLandedState.IN_AIR
    return True


class EscTelemetry1To4(Message, name="ESC_TELEMETRY_1_TO_4"):
    temperature: Ints
    voltage: Ints
    current: Ints
    totalcurrent: Ints
    rpm: Ints
    count: Ints


class EscTelemetry5To8(EscTelemetry1To4, name="ESC_TELEMETRY_5_TO_8"):
    pass


@law
def fill_esc_telemetry(m: EscTelemetry1To4, v: Copter, first: int) -> bool:
    """Four speed controllers from ``first``: each has the battery's voltage, and an even part of its current."""
    sensors, battery, motors = v.sensors, v.autopilot.battery, v.sensors.esc_motors
    for k in range(min(4, motors - first)):
        m.temperature[k] = uint8(sensors.temperature)
        m.voltage[k] = uint16(sensors.battery_voltage * 1e2)
        m.current[k] = uint16(sensors.battery_current * 1e2 / motors)
        m.totalcurrent[k] = uint16(battery.consumed_mah / motors)
        m.rpm[k] = uint16(sensors.esc_rpm[first + k])
        m.count[k] = sensors.esc_count & 0xFFFF
    return motors > first


@law
def esc_telemetry_1_to_4(m: EscTelemetry1To4, v: Copter) -> bool:
    """ESC_TELEMETRY_1_TO_4: air temperature [degC], cV, cA, mAh, RPM, samples of motors 1 to 4; see SIM_ESC_TELEM."""
    return fill_esc_telemetry(m, v, 0)


@law
def esc_telemetry_5_to_8(m: EscTelemetry5To8, v: Copter) -> bool:
    """ESC_TELEMETRY_5_TO_8: the same of motors 5 to 8."""
    return fill_esc_telemetry(m, v, 4)


class Rpm(Message, name="RPM"):
    rpm1: float
    rpm2: float


FROM_ESCS = 5
"""RPM1_TYPE"""


@law
def rpm(m: Rpm, v: Copter) -> bool:
    """RPM: mean speed of the motors as their controllers report it; only with RPM1_TYPE 5."""
    motors = v.sensors.esc_motors
    total = 0.0
    for k in range(motors):
        total += v.sensors.esc_rpm[k]
    m.rpm1 = total / max(motors, 1)
    m.rpm2 = -1.0
    return v.autopilot.params.RPM1_TYPE == FROM_ESCS and motors > 0


@law
def wind(m: Wind, v: Copter) -> bool:
    """WIND: from -180 deg with 0 m/s: the estimator knows no wind, as ArduCopter's without a model of the drag."""
    m.direction = -180.0
    return True


THROTTLE_UNIT = 1000.0
"""The vertical loop's output is throttle; it is sent in thousandths."""


@law
def pid_tuning(m: PidTuning, v: Copter, port: Port) -> bool:
    """PID_TUNING: one each for the loops of roll, pitch, yaw rate [rad/s] and vertical acceleration (down, [m/s^2], its
    parts in thousandths of throttle) with bits 1, 2, 4, 8 of GCS_PID_MASK
    """
    params, control = v.autopilot.params, v.autopilot.control
    loop = next_loop(port, 4, params.GCS_PID_MASK)
    rates, rate, atc = v.autopilot.estimate.rates, control.rate, params.ATC
    if loop == 0:
        fill_tuning(m, ROLL, rate.roll, rates.x, pid_gains(atc.RAT_RLL), 1.0)
    elif loop == 1:
        fill_tuning(m, PITCH, rate.pitch, rates.y, pid_gains(atc.RAT_PIT), 1.0)
    elif loop == 2:
        fill_tuning(m, YAW_LOOP, rate.yaw, rates.z, pid_gains(atc.RAT_YAW), 1.0)
    elif loop == 3:
        gains = altitude_gains(params.PSC, 0.0).acc
        fill_tuning(m, VERTICAL, control.pos_d.accel, v.autopilot.estimate.acc_ned.z, gains, THROTTLE_UNIT)
    return loop >= 0


MESSAGES = (
    heartbeat, sys_status, mission_current, rc_channels, vfr_hud, extended_sys_state, esc_telemetry_1_to_4,
    esc_telemetry_5_to_8, rpm, wind, pid_tuning, *targets.MESSAGES, *terrain_report.MESSAGES,
)  # fmt: skip
