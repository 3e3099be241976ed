# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry that the rover has in its own way: HEARTBEAT, SYS_STATUS, EXTENDED_SYS_STATE, VFR_HUD, channels, wheels."""

from __future__ import annotations

from ...autopilot.control.pid import pid_gains
from ...autopilot.modes import numbers
from ...autopilot.rover.control.servos import LEFT, OUTPUTS, RIGHT
from ...autopilot.rover.modes.auto import AUTO
from ...autopilot.rover.modes.hold import HOLD
from ...autopilot.rover.modes.initialising import INITIALISING
from ...autopilot.rover.modes.mode_list import MODES, is_autonomous
from ...core.kernels import law
from ...core.mavlink import MavModeFlag, MavState, MavSysStatus, MavType
from ...core.records import Floats
from ...vehicle.rover import Rover
from ..telemetry import channels, motion, status
from ..telemetry.channels import RcChannels
from ..telemetry.heartbeat import Heartbeat, fill_heartbeat
from ..telemetry.motion import VfrHud
from ..telemetry.own import ExtendedSysState
from ..telemetry.status import MissionCurrent, SysStatus
from ..telemetry.tuning import STEERING, VERTICAL, PidTuning, fill_tuning, next_loop
from ..telemetry.units import DEG, boot_ms, int16
from ..wire.message import Message
from ..wire.port import Port
from . import targets

MANUAL_MODES = (*numbers(MODES, "manual_input"), INITIALISING)


@law
def heartbeat(m: Heartbeat, v: Rover) -> bool:
    """HEARTBEAT: ground rover, ArduPilot, mode number, armed bit; STANDBY in HOLD, CRITICAL in a failsafe."""
    ap, mode = v.autopilot, v.autopilot.modes.number
    base: int = MavModeFlag.CUSTOM_MODE_ENABLED
    state = MavState.ACTIVE
    if is_autonomous(mode):
        base |= MavModeFlag.GUIDED_ENABLED
    if mode in MANUAL_MODES or ap.params.STICK_MIXING > 0.0:
        base |= MavModeFlag.MANUAL_INPUT_ENABLED
    if ap.arming.armed and mode != INITIALISING:
        base |= MavModeFlag.SAFETY_ARMED
    if mode == INITIALISING:
        state = MavState.CALIBRATING
    elif mode == HOLD:
        state = MavState.STANDBY
    if ap.modes.links.acted != 0 or ap.modes.failsafe.ekf != 0:
        state = MavState.CRITICAL
    return fill_heartbeat(m, v, MavType.GROUND_ROVER, base, state)


CONTROLLERS = (
    MavSysStatus.SENSOR_ANGULAR_RATE_CONTROL
    | MavSysStatus.SENSOR_ATTITUDE_STABILIZATION
    | MavSysStatus.SENSOR_YAW_POSITION
    | MavSysStatus.SENSOR_XY_POSITION_CONTROL
)
"""Bits of SYS_STATUS"""
CONTROLLED_MODES = numbers(MODES, "controlled")


@law
def controllers_at_work(mode: int) -> int:
    """Bits of the controllers that a mode uses."""
    bits = 0
    if mode in CONTROLLED_MODES:
        bits |= MavSysStatus.SENSOR_ANGULAR_RATE_CONTROL | MavSysStatus.SENSOR_ATTITUDE_STABILIZATION
    if is_autonomous(mode):
        bits |= MavSysStatus.SENSOR_YAW_POSITION | MavSysStatus.SENSOR_XY_POSITION_CONTROL
    return bits


@law
def sys_status(m: SysStatus, v: Rover) -> bool:
    """SYS_STATUS: sensor bits (the pre-arm checks are bit 0x10000000), mV, cA, %; load and error counts are 0."""
    at_work = controllers_at_work(v.autopilot.modes.number)
    return status.sys_status(m, v, CONTROLLERS, at_work, at_work)


@law
def mission_current(m: MissionCurrent, v: Rover) -> bool:
    """MISSION_CURRENT: number of the item, number of items without home, state."""
    return status.mission_current(m, v, AUTO, False)


@law
def rc_channels(m: RcChannels, v: Rover) -> bool:
    """RC_CHANNELS: pulses in use [us], 0 where there is none; no channels are counted without receiver or override."""
    return channels.rc_channels(m, v, v.autopilot.params.RC_FS_TIMEOUT)


@law
def extended_sys_state(m: ExtendedSysState, v: Rover) -> bool:
    """EXTENDED_SYS_STATE: both states undefined, a rover does not fly."""
    return True


@law
def vfr_hud(m: VfrHud, v: Rover) -> bool:
    """VFR_HUD: ground speed in both speeds [m/s], heading [deg], throttle without sign [%], altitude [m]."""
    return motion.vfr_hud(m, v, v.autopilot.control.motors.throttle)


class RcChannelsScaled(Message, name="RC_CHANNELS_SCALED"):
    time_boot_ms: int
    chan1_scaled: int
    chan3_scaled: int
    rssi: int


@law
def is_assigned(v: Rover, function: int) -> bool:
    """Whether an output has this function (SERVOn_FUNCTION)."""
    found = False
    for k in range(OUTPUTS):
        found = found or function == v.autopilot.params.SERVO[k].FUNCTION
    return found


@law
def rc_channels_scaled(m: RcChannelsScaled, v: Rover) -> bool:
    """RC_CHANNELS_SCALED: outputs to steering (1) and throttle (3), skid-steered to left and right, -10000 .. 10000."""
    motors = v.autopilot.control.motors
    first, third = motors.out_steering, motors.out_throttle
    if is_assigned(v, LEFT) and is_assigned(v, RIGHT):
        first, third = motors.out_left, motors.out_right
    m.time_boot_ms = boot_ms(v.time_us)
    m.chan1_scaled = int16(first * 1e4)
    m.chan3_scaled = int16(third * 1e4)
    m.rssi = 255
    return True


class WheelDistance(Message, name="WHEEL_DISTANCE"):
    time_usec: int
    distance: Floats
    count: int


@law
def wheel_distance(m: WheelDistance, v: Rover) -> bool:
    """WHEEL_DISTANCE: rolled by the left and right driven wheel [m], see WENC_TYPE; nothing without encoders."""
    m.time_usec = v.time_us
    m.distance[0] = v.sensors.wheel_distance.x
    m.count = 1
    p = v.autopilot.params
    if p.WENC.TYPE == 0.0 or p.WENC2.TYPE != 0.0:
        m.distance[1] = v.sensors.wheel_distance.y
        m.count = 2
    return v.sensors.wheel_count > 0


@law
def pid_tuning(m: PidTuning, v: Rover, port: Port) -> bool:
    """PID_TUNING: one each for the loops of turn rate [deg/s] and speed [m/s] with bits 1 and 2 of GCS_PID_MASK"""
    params, control = v.autopilot.params, v.autopilot.control
    loop = next_loop(port, 2, params.GCS_PID_MASK)
    if loop == 0:
        gains = pid_gains(params.ATC.STR_RAT)
        fill_tuning(m, STEERING, control.steering.rate, v.autopilot.estimate.rates.z, gains, 1.0)
        m.desired *= DEG
        m.achieved *= DEG
    elif loop == 1:
        fill_tuning(m, VERTICAL, control.speed.loop, control.speed.forward, pid_gains(params.ATC.SPEED), 1.0)
    return loop >= 0


MESSAGES = (
    heartbeat, sys_status, mission_current, rc_channels, extended_sys_state, vfr_hud, rc_channels_scaled,
    wheel_distance, pid_tuning, *targets.MESSAGES,
)  # fmt: skip
