# SPDX-License-Identifier: BSD-3-Clause
"""Attitude, position, home and origin."""

from __future__ import annotations

import math
from collections.abc import Callable

from ...core.geodesy import METRES_PER_DEGE7, longitude_scale
from ..dialect import message
from .builder import DEG, Build, Builder, Context, heading_cdeg, int16, int32, uint16

E = "autopilot.estimate."
H = "autopilot.home."
S = "sensors."


def global_position(context: Context) -> Callable[[], tuple[int, int, float]]:
    """(lat [degE7], lon [degE7], alt above mean sea level [m]).

    The GPS fix until the origin is known, then the estimate.
    """
    read = context.fields(E + "pos", E + "origin_set", E + "origin_lat", E + "origin_lon", E + "origin_alt")
    read_gps = context.fields(S + "gps_fix", S + "gps_lat", S + "gps_lon", S + "gps_alt")
    scaled_at = 1 << 62  # nowhere
    scale = 1.0

    def where() -> tuple[int, int, float]:
        nonlocal scaled_at, scale
        n, e, d, is_set, lat0, lon0, alt0 = read()
        if not is_set:
            fix, lat, lon, alt_mm = read_gps()
            return (lat, lon, alt_mm * 1e-3) if fix >= 3 else (0, 0, 0.0)
        north = n / METRES_PER_DEGE7
        middle = int32(lat0 + 0.5 * north) >> 12  # the cosine is worked out anew every 0.4 mdeg of latitude
        if middle != scaled_at:
            scaled_at, scale = middle, longitude_scale(float(middle << 12)) * METRES_PER_DEGE7
        return int32(lat0 + north), int32(lon0 + e / scale), alt0 - d

    return where


def global_position_int(context: Context) -> Build:
    """GLOBAL_POSITION_INT: degE7, mm above sea level and above home, cm/s, heading in centidegrees."""
    where = global_position(context)
    read = context.fields("time_us", E + "euler", E + "vel")
    read_home = context.fields(H + "is_set", H + "alt")
    pack = message("GLOBAL_POSITION_INT").pack

    def build() -> bytes:
        t, _, _, yaw, vn, ve, vd = read()
        lat, lon, alt = where()
        home_set, home_alt = read_home()
        relative = int32((alt - home_alt) * 1e3) if home_set else 0
        v = (int16(vn * 100.0), int16(ve * 100.0), int16(vd * 100.0))
        return pack(t // 1000 & 0xFFFFFFFF, lat, lon, int32(alt * 1e3), relative, *v, heading_cdeg(yaw))

    return build


def local_position_ned(context: Context) -> Build:
    """LOCAL_POSITION_NED: metres from the EKF origin, m/s; nothing until the origin is set."""
    read = context.fields("time_us", E + "vel", E + "pos", E + "origin_set")
    pack = message("LOCAL_POSITION_NED").pack

    def build() -> bytes:
        t, vn, ve, vd, n, e, d, is_set = read()
        return pack(t // 1000 & 0xFFFFFFFF, n, e, d, vn, ve, vd) if is_set else b""

    return build


def vfr_hud(context: Context, throttle: str) -> Build:
    """VFR_HUD of a firmware whose throttle -1 .. 1 is the field ``throttle``."""
    where = global_position(context)
    read = context.fields(E + "euler", E + "vel", throttle)
    pack = message("VFR_HUD").pack

    def build() -> bytes:
        _, _, yaw, vn, ve, vd, share = read()
        speed = math.hypot(vn, ve)
        alt = where()[2]
        return pack(speed, speed, alt, -vd, heading_cdeg(yaw) // 100, uint16(abs(share) * 100.0 + 0.5))

    return build


def home_position(context: Context) -> Build:
    """HOME_POSITION: degE7, mm, and NED metres from the origin; nothing until home is set."""
    read = context.fields("time_us", H + "is_set", H + "lat", H + "lon", H + "alt", H + "pos")
    pack = message("HOME_POSITION").pack

    def build() -> bytes:
        t, is_set, lat, lon, alt, n, e, d = read()
        if not is_set:
            return b""
        return pack(lat, lon, int32(alt * 1e3), n, e, d, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, t)

    return build


def gps_global_origin(context: Context) -> Build:
    """GPS_GLOBAL_ORIGIN: degE7, mm; nothing until the origin is set."""
    read = context.fields("time_us", E + "origin_set", E + "origin_lat", E + "origin_lon", E + "origin_alt")
    pack = message("GPS_GLOBAL_ORIGIN").pack

    def build() -> bytes:
        t, is_set, lat, lon, alt = read()
        return pack(lat, lon, int32(alt * 1e3), t) if is_set else b""

    return build


def gps_raw_int(context: Context) -> Build:
    """GPS_RAW_INT: the receiver's fix, course [cdeg], speed [cm/s]; h_acc and v_acc [mm] are 0.3 m x HDOP
    and 0.5 m x VDOP, other accuracies are not known (0).
    """
    names = ("fix", "lat", "lon", "alt", "eph", "epv", "vel", "satellites")
    read = context.fields(S + "gps_time_us", *(S + "gps_" + name for name in names))
    pack = message("GPS_RAW_INT").pack

    def build() -> bytes:
        t, fix, lat, lon, alt, eph, epv, vn, ve, _, satellites = read()
        speed = uint16(math.hypot(vn, ve))
        course = uint16(math.atan2(ve, vn) * DEG * 100.0 % 36000.0)
        has_fix = fix >= 2
        eph, epv = (uint16(eph), uint16(epv)) if has_fix else (65535, 65535)
        accuracies = (alt, eph * 3, epv * 5, 0, 0, 0) if has_fix else (alt, 0, 0, 0, 0, 0)
        return pack(t, lat, lon, alt, eph, epv, speed, course, fix & 0xFF, min(max(satellites, 0), 255), *accuracies)

    return build


def attitude(context: Context) -> Build:
    """ATTITUDE: Euler angles [rad], body rates [rad/s]."""
    read = context.fields("time_us", E + "euler", E + "rates")
    pack = message("ATTITUDE").pack

    def build() -> bytes:
        t, roll, pitch, yaw, p, q, r = read()
        return pack(t // 1000 & 0xFFFFFFFF, roll, pitch, yaw, p, q, r)

    return build


def attitude_quaternion(context: Context) -> Build:
    """ATTITUDE_QUATERNION: body to NED as (w, x, y, z)."""
    read = context.fields("time_us", E + "q", E + "rates")
    pack = message("ATTITUDE_QUATERNION").pack

    def build() -> bytes:
        t, *rest = read()
        return pack(t // 1000 & 0xFFFFFFFF, *rest, 0.0, 0.0, 0.0, 0.0)

    return build


def ahrs(context: Context) -> Build:
    """AHRS: gyro drift [rad/s]; the DCM figures of the message have no counterpart here and are zero."""
    read = context.fields(E + "gyro_bias")
    pack = message("AHRS").pack

    def build() -> bytes:
        x, y, z = read()
        return pack(-x, -y, -z, 0.0, 0.0, 0.0, 0.0)

    return build


def ahrs2(context: Context) -> Build:
    """AHRS2: the second attitude source; this firmware has one estimator and reports it again."""
    read = context.fields(E + "euler")
    where = global_position(context)
    pack = message("AHRS2").pack

    def build() -> bytes:
        roll, pitch, yaw = read()
        lat, lon, alt = where()
        return pack(roll, pitch, yaw, alt, lat, lon)

    return build


BUILDERS: dict[str, Builder] = {
    "GLOBAL_POSITION_INT": global_position_int,
    "LOCAL_POSITION_NED": local_position_ned,
    "HOME_POSITION": home_position,
    "GPS_GLOBAL_ORIGIN": gps_global_origin,
    "GPS_RAW_INT": gps_raw_int,
    "ATTITUDE": attitude,
    "ATTITUDE_QUATERNION": attitude_quaternion,
    "AHRS": ahrs,
    "AHRS2": ahrs2,
}
