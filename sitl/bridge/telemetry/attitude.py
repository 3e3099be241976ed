# SPDX-License-Identifier: BSD-3-Clause
"""Attitude as estimated: ATTITUDE, ATTITUDE_QUATERNION, AHRS, AHRS2."""

from __future__ import annotations

from ..dialect import message
from .builder import Build, Builder, Context
from .position import global_position

E = "autopilot.estimate."


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
    "ATTITUDE": attitude,
    "ATTITUDE_QUATERNION": attitude_quaternion,
    "AHRS": ahrs,
    "AHRS2": ahrs2,
}
