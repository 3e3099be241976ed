# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry that the copter has in its own way: HEARTBEAT, EXTENDED_SYS_STATE, VFR_HUD, where it is going."""

from __future__ import annotations

import math

from ...autopilot.copter.modes.auto import AUTO
from ...autopilot.copter.modes.guided import GUIDED
from ...autopilot.copter.modes.table import MODES, NEED_POSITION
from ...core.geodesy import add_offset
from ..dialect import message
from ..telemetry import motion
from ..telemetry.builder import DEG, Build, Builder, Context, int16, int32, uint16
from ..telemetry.status import ALTITUDE, ATTITUDE, MOTORS, POSITION, RATE, YAW

A, M, C, E = "autopilot.arming.", "autopilot.modes.", "autopilot.control.", "autopilot.estimate."
QUADROTOR, ARDUPILOTMEGA = 2, 3
CUSTOM_MODE, IS_GUIDED, STABILIZED, MANUAL_INPUT, ARMED = 1, 8, 16, 64, 128
STANDBY, ACTIVE, CRITICAL = 3, 4, 5
GUIDED_MODES = frozenset(NEED_POSITION)
"""Modes that hold or change the position by themselves: HEARTBEAT's MAV_MODE_FLAG_GUIDED_ENABLED."""


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
        base |= (IS_GUIDED if mode in GUIDED_MODES else 0) | (ARMED if armed else 0)
        failsafe = gcs or radio or battery or ekf
        state = CRITICAL if failsafe else STANDBY if landed else ACTIVE
        return pack(mode & 0xFFFFFFFF, QUADROTOR, ARDUPILOTMEGA, base, state, 3)

    return build


POSITION_MODES = frozenset(mode.number for mode in MODES if mode.needs_position or mode.uses_position)
ALTITUDE_MODES = frozenset(mode.number for mode in MODES if not mode.manual_throttle)
CONTROLLERS = RATE | ATTITUDE | YAW | ALTITUDE | POSITION | MOTORS
"""Bits of SYS_STATUS"""


def controllers_at_work(mode: int, armed: bool) -> int:
    """Bits of the controllers that a mode uses."""
    bits = RATE | ATTITUDE | YAW | (POSITION if mode in POSITION_MODES else 0)
    return bits | (ALTITUDE if mode in ALTITUDE_MODES else 0) | (MOTORS if armed else 0)


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
            climbs = (mode == GUIDED and guided_submode == 0) or (mode == AUTO and kind == 1)
            state = TAKING_OFF if user_takeoff or (climbs and not takeoff_complete) else IN_AIR
        return pack(0, state)

    return build


def vfr_hud(context: Context) -> Build:
    """VFR_HUD: ground speed in both speeds [m/s], heading [deg], throttle [%], altitude above sea level [m]."""
    return motion.vfr_hud(context, C + "motors.throttle_out")


STEERED_MODES = frozenset((3, 4, 6))


def nav_controller_output(context: Context) -> Build:
    """NAV_CONTROLLER_OUTPUT: lean targets, bearings [deg], distance to the target, altitude error [m]."""
    read = context.fields(
        C + "attitude.target_euler", E + "pos", E + "euler", M + "number", M + "nav.target", M + "guided.pos",
        C + "pos_d.pos_error", "autopilot.home.pos",
    )  # fmt: skip
    pack = message("NAV_CONTROLLER_OUTPUT").pack

    def build() -> bytes:
        roll, pitch, target_yaw, n, e, _, _, _, _, mode, *targets, altitude_error, home_n, home_e, _ = read()
        distance, bearing = 0.0, 0.0
        if mode in STEERED_MODES:
            nav, guided = targets[:2], targets[3:5]
            to_n, to_e = nav if mode == AUTO else guided if mode == GUIDED else (home_n, home_e)
            distance = math.hypot(to_n - n, to_e - e)
            bearing = math.atan2(to_e - e, to_n - n) * DEG
        heading = int16(target_yaw * DEG)
        lean = (roll * DEG, pitch * DEG)
        return pack(*lean, -altitude_error, 0.0, 0.0, heading, int16(bearing), uint16(distance))

    return build


TO_POSITION, POS_VEL_ACCEL, VELOCITY_ACCEL, ACCEL, ANGLE = 1, 2, 3, 4, 5
IGNORE_POS, IGNORE_VEL, IGNORE_ACC, IGNORE_YAW, IGNORE_YAW_RATE = 0x007, 0x038, 0x1C0, 0x400, 0x800
TARGET_MASKS = {
    0: IGNORE_VEL | IGNORE_ACC | IGNORE_YAW | IGNORE_YAW_RATE,
    TO_POSITION: IGNORE_VEL | IGNORE_ACC | IGNORE_YAW | IGNORE_YAW_RATE,
    POS_VEL_ACCEL: IGNORE_YAW | IGNORE_YAW_RATE,
    VELOCITY_ACCEL: IGNORE_POS | IGNORE_YAW | IGNORE_YAW_RATE,
    ACCEL: IGNORE_POS | IGNORE_VEL | IGNORE_YAW | IGNORE_YAW_RATE,
}
"""GUIDED submode -> what of the target does not count."""


def position_target_local(context: Context) -> Build:
    """POSITION_TARGET_LOCAL_NED: the target of GUIDED; nothing in other modes."""
    guided = M + "guided."
    read = context.fields("time_us", M + "number", guided + "submode", guided + "pos", guided + "vel", guided + "acc")
    pack = message("POSITION_TARGET_LOCAL_NED").pack

    def build() -> bytes:
        t, mode, submode, *numbers = read()
        if mode != GUIDED or submode not in TARGET_MASKS:
            return b""
        return pack(t // 1000 & 0xFFFFFFFF, *numbers, 0.0, 0.0, TARGET_MASKS[submode], 1)

    return build


def position_target_global(context: Context) -> Build:
    """POSITION_TARGET_GLOBAL_INT: where GUIDED and AUTO fly to (degE7, m above sea level); nothing in other modes."""
    origin = [E + "origin_" + x for x in ("set", "lat", "lon", "alt")]
    read = context.fields("time_us", M + "number", M + "guided.pos", M + "nav.target", *origin)
    pack = message("POSITION_TARGET_GLOBAL_INT").pack
    mask = IGNORE_VEL | IGNORE_ACC | IGNORE_YAW | IGNORE_YAW_RATE

    def build() -> bytes:
        t, mode, gn, ge, gd, an, ae, ad, is_set, lat0, lon0, alt0 = read()
        if mode not in (AUTO, GUIDED) or not is_set:
            return b""
        n, e, d = (gn, ge, gd) if mode == GUIDED else (an, ae, ad)
        lat, lon = add_offset(lat0, lon0, n, e)
        return pack(t // 1000 & 0xFFFFFFFF, int32(lat), int32(lon), alt0 - d, *(0.0,) * 8, mask, 0)

    return build


def attitude_target(context: Context) -> Build:
    """ATTITUDE_TARGET: quaternion, body rates [rad/s], throttle 0..1 that the controllers follow."""
    attitude = C + "attitude."
    read = context.fields("time_us", attitude + "target_q", attitude + "rate_target", C + "motors.throttle_in")
    pack = message("ATTITUDE_TARGET").pack

    def build() -> bytes:
        t, *numbers = read()
        return pack(t // 1000 & 0xFFFFFFFF, *numbers, 0)

    return build


BUILDERS: dict[str, Builder] = {
    "HEARTBEAT": heartbeat,
    "EXTENDED_SYS_STATE": extended_sys_state,
    "VFR_HUD": vfr_hud,
    "NAV_CONTROLLER_OUTPUT": nav_controller_output,
    "POSITION_TARGET_LOCAL_NED": position_target_local,
    "POSITION_TARGET_GLOBAL_INT": position_target_global,
    "ATTITUDE_TARGET": attitude_target,
}
