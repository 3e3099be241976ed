# SPDX-License-Identifier: BSD-3-Clause
"""Where the rover is going: NAV_CONTROLLER_OUTPUT, POSITION_TARGET_GLOBAL_INT."""

from __future__ import annotations

import math
from collections.abc import Callable

from ...autopilot.rover.modes.auto import AUTO, CIRCLING, GUIDED_IN_MISSION, LOITERING, ON_PATH, RETURNING
from ...autopilot.rover.modes.guided import GUIDED, HEADING_AND_SPEED, POSITION
from ...autopilot.rover.modes.table import AUTONOMOUS, MODES
from ...core.geodesy import add_offset
from ..dialect import message
from ..telemetry.builder import DEG, Build, Builder, Context, int16, int32, uint16

M, NAV, C, E = "autopilot.modes.", "autopilot.modes.nav.", "autopilot.control.position.", "autopilot.estimate."
NOT_FOR_PLACES = 0xFDF8
"""type_mask of a place alone, as ArduRover sends it."""

_OF_MODES = {mode.number: mode.destination for mode in MODES if mode.destination}
"""Fields of ``modes`` with a destination; GUIDED's is one only when its set-point is a position."""
PATH, LOITER, CIRCLE = "nav.target", "loiter.place", "circle.target"
_OF_AUTO = {ON_PATH: PATH, RETURNING: PATH, CIRCLING: CIRCLE, LOITERING: LOITER, GUIDED_IN_MISSION: PATH}


def destination(context: Context) -> Callable[[], tuple[str, float, float]]:
    """(what it is, north, east [m]) of where the present mode drives to; "" when it drives to no place."""
    read_mode = context.fields(M + "number", M + "auto.submode", M + "guided.submode")
    read = {what: context.fields(M + what) for what in {*_OF_MODES.values(), *_OF_AUTO.values()}}

    def where() -> tuple[str, float, float]:
        mode, in_auto, in_guided = read_mode()
        what = _OF_AUTO.get(in_auto, "") if mode == AUTO else _OF_MODES.get(mode, "")
        guided = mode == GUIDED or (mode == AUTO and in_auto == GUIDED_IN_MISSION)
        if what == "" or (guided and in_guided != POSITION):
            return "", 0.0, 0.0
        n, e, *_ = read[what]()
        return what, n, e

    return where


def nav_controller_output(context: Context) -> Build:
    """NAV_CONTROLLER_OUTPUT: bearings [deg], distance and cross-track error [m]; nothing in the pilot's modes."""
    where = destination(context)
    read = context.fields(
        M + "number", E + "pos", C + "pos_target", M + "guided.submode", M + "guided.heading", M + "guided.has_target",
        NAV + "drive.crosstrack",
    )  # fmt: skip
    pack = message("NAV_CONTROLLER_OUTPUT").pack

    def build() -> bytes:
        mode, n, e, _, tn, te, submode, heading, is_fresh, beside = read()
        if mode not in AUTONOMOUS:
            return b""
        what, to_n, to_e = where()
        distance = bearing = now = 0.0
        if what:
            distance = math.hypot(to_n - n, to_e - e)
            bearing = now = math.atan2(to_e - e, to_n - n) * DEG
            if what != LOITER:
                now = math.atan2(te - e, tn - n) * DEG
        elif mode == GUIDED and submode == HEADING_AND_SPEED and is_fresh:
            now = heading * DEG
        error = beside if what == PATH else 0.0
        return pack(0.0, 0.0, 0.0, 0.0, error, int16(now), int16(bearing), uint16(distance))

    return build


def position_target_global(context: Context) -> Build:
    """POSITION_TARGET_GLOBAL_INT: where it drives to (degE7, m above sea level); nothing when it drives to no place."""
    where = destination(context)
    read = context.fields("time_us", *(E + "origin_" + x for x in ("set", "lat", "lon", "alt")))
    pack = message("POSITION_TARGET_GLOBAL_INT").pack

    def build() -> bytes:
        t, is_set, lat0, lon0, alt0 = read()
        what, n, e = where()
        if not what or not is_set:
            return b""
        lat, lon = add_offset(lat0, lon0, n, e)
        return pack(t // 1000 & 0xFFFFFFFF, int32(lat), int32(lon), alt0, *(0.0,) * 8, NOT_FOR_PLACES, 0)

    return build


BUILDERS: dict[str, Builder] = {
    "NAV_CONTROLLER_OUTPUT": nav_controller_output,
    "POSITION_TARGET_GLOBAL_INT": position_target_global,
}
