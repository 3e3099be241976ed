# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry that the copter has in its own way: HEARTBEAT, SYS_STATUS, EXTENDED_SYS_STATE, VFR_HUD, RC_CHANNELS."""

from __future__ import annotations

from ...autopilot.copter.modes.auto import AUTO
from ...autopilot.copter.modes.guided import GUIDED
from ...autopilot.copter.modes.table import MODES, NEED_POSITION
from ...autopilot.navigation.state import TAKEOFF
from ...core.kernels import law
from ...vehicle.copter import HEXAROTOR, OCTOROTOR, QUADROTOR, Copter
from ..telemetry import channels, motion, status
from ..telemetry.channels import RcChannels
from ..telemetry.heartbeat import (
    ACTIVE,
    ARMED,
    CRITICAL,
    CUSTOM_MODE,
    IS_GUIDED,
    MANUAL_INPUT,
    STABILIZED,
    STANDBY,
    Heartbeat,
    fill_heartbeat,
)
from ..telemetry.motion import VfrHud
from ..telemetry.status import ALTITUDE, ATTITUDE, MOTORS, POSITION, RATE, YAW, MissionCurrent, SysStatus
from ..wire.message import Message
from . import targets


@law
def mav_type(motors: int) -> int:
    """MAV_TYPE of a multicopter by its number of motors."""
    if motors == 6:
        return HEXAROTOR
    return OCTOROTOR if motors == 8 else QUADROTOR


@law
def heartbeat(m: Heartbeat, v: Copter) -> bool:
    """HEARTBEAT: kind of multicopter, ArduPilot, mode number, armed bit."""
    arming, modes, failsafe = v.autopilot.arming, v.autopilot.modes, v.autopilot.modes.failsafe
    base = CUSTOM_MODE | STABILIZED | MANUAL_INPUT
    if modes.number in NEED_POSITION:  # holds or changes the position by itself
        base |= IS_GUIDED
    if arming.armed:
        base |= ARMED
    state = STANDBY if arming.landed else ACTIVE
    if failsafe.gcs or failsafe.radio or failsafe.battery != 0 or failsafe.ekf != 0:
        state = CRITICAL
    return fill_heartbeat(m, v, mav_type(v.autopilot.control.motors.count), base, state)


POSITION_MODES = tuple(mode.number for mode in MODES if mode.needs_position or mode.uses_position)
ALTITUDE_MODES = tuple(mode.number for mode in MODES if not mode.manual_throttle)
CONTROLLERS = RATE | ATTITUDE | YAW | ALTITUDE | POSITION | MOTORS
"""Bits of SYS_STATUS"""


@law
def controllers_at_work(mode: int, armed: bool) -> int:
    """Bits of the controllers that a mode uses."""
    bits = RATE | ATTITUDE | YAW
    if mode in POSITION_MODES:
        bits |= POSITION
    if mode in ALTITUDE_MODES:
        bits |= ALTITUDE
    if armed:
        bits |= MOTORS
    return bits


@law
def sys_status(m: SysStatus, v: Copter) -> bool:
    """SYS_STATUS: sensor bits (the pre-arm checks are bit 0x10000000), mV, cA, %; load and error counts are 0."""
    at_work = controllers_at_work(v.autopilot.modes.number, v.autopilot.arming.armed)
    return status.sys_status(m, v, CONTROLLERS, at_work, CONTROLLERS)


@law
def mission_current(m: MissionCurrent, v: Copter) -> bool:
    """MISSION_CURRENT: number of the item, number of items without home, state."""
    return status.mission_current(m, v, AUTO)


@law
def rc_channels(m: RcChannels, v: Copter) -> bool:
    """RC_CHANNELS: pulses in use [us], 0 where there is none; no channels are counted without receiver or override."""
    return channels.rc_channels(m, v, v.autopilot.params.RC_FS_TIMEOUT)


@law
def vfr_hud(m: VfrHud, v: Copter) -> bool:
    """VFR_HUD: ground speed in both speeds [m/s], heading [deg], throttle [%], altitude above sea level [m]."""
    return motion.vfr_hud(m, v, v.autopilot.control.motors.throttle_out)


class ExtendedSysState(Message, name="EXTENDED_SYS_STATE"):
    landed_state: int
    vtol_state: int


ON_GROUND, IN_AIR, TAKING_OFF, LANDING = 1, 2, 3, 4
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
        m.landed_state = ON_GROUND
    elif modes.landing.landing:
        m.landed_state = LANDING
    elif modes.takeoff.user_active or (climbs and not modes.takeoff.complete):
        m.landed_state = TAKING_OFF
    else:
        m.landed_state = IN_AIR
    return True


MESSAGES = (
    heartbeat, sys_status, mission_current, rc_channels, vfr_hud, extended_sys_state, *targets.MESSAGES
)  # fmt: skip
