# SPDX-License-Identifier: BSD-3-Clause
"""Where it is going: NAV_CONTROLLER_OUTPUT, MISSION_CURRENT, the position and attitude targets."""

from __future__ import annotations

import math

from ...core.geodesy import add_offset
from ..dialect import message
from .builder import Build, Builder, Context
from .units import DEG, int16, int32, uint16

M, C, E = "autopilot.modes.", "autopilot.control.", "autopilot.estimate."
AUTO, GUIDED = 3, 4
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


NO_MISSION, NOT_STARTED, ACTIVE, PAUSED, COMPLETE = 1, 2, 3, 4, 5


def mission_current(context: Context) -> Build:
    """MISSION_CURRENT: number of the item, number of items without home, state."""
    read = context.fields(
        M + "number", M + "nav.mission_state", M + "nav.mission_current",
        "autopilot.params.MIS_TOTAL",
    )  # fmt: skip
    pack = message("MISSION_CURRENT").pack

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
        return pack(uint16(seq), uint16(total - 1.0), shown, 1 if mode == AUTO else 0)

    return build


POSITION, POS_VEL_ACCEL, VELOCITY_ACCEL, ACCEL, ANGLE = 1, 2, 3, 4, 5
IGNORE_POS, IGNORE_VEL, IGNORE_ACC, IGNORE_YAW, IGNORE_YAW_RATE = 0x007, 0x038, 0x1C0, 0x400, 0x800
TARGET_MASKS = {
    0: IGNORE_VEL | IGNORE_ACC | IGNORE_YAW | IGNORE_YAW_RATE,
    POSITION: IGNORE_VEL | IGNORE_ACC | IGNORE_YAW | IGNORE_YAW_RATE,
    POS_VEL_ACCEL: IGNORE_YAW | IGNORE_YAW_RATE,
    VELOCITY_ACCEL: IGNORE_POS | IGNORE_YAW | IGNORE_YAW_RATE,
    ACCEL: IGNORE_POS | IGNORE_VEL | IGNORE_YAW | IGNORE_YAW_RATE,
}
"""GUIDED submode -> what of the target does not count."""


def position_target_local(context: Context) -> Build:
    """POSITION_TARGET_LOCAL_NED: the target of GUIDED; nothing in other modes."""
    guided = M + "guided."
    read = context.fields(
        "time_us", M + "number", guided + "submode", guided + "pos", guided + "vel", guided + "acc"
    )
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
    read = context.fields(
        "time_us", attitude + "target_q", attitude + "rate_target", C + "motors.throttle_in"
    )
    pack = message("ATTITUDE_TARGET").pack

    def build() -> bytes:
        t, *numbers = read()
        return pack(t // 1000 & 0xFFFFFFFF, *numbers, 0)

    return build


BUILDERS: dict[str, Builder] = {
    "NAV_CONTROLLER_OUTPUT": nav_controller_output,
    "MISSION_CURRENT": mission_current,
    "POSITION_TARGET_LOCAL_NED": position_target_local,
    "POSITION_TARGET_GLOBAL_INT": position_target_global,
    "ATTITUDE_TARGET": attitude_target,
}
