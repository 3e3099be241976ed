# SPDX-License-Identifier: BSD-3-Clause
"""Two GPS receivers: which of them is used (GPS_AUTO_SWITCH), and whether they agree.

What a user sees of it is described in https://ardupilot.org/copter/docs/common-gps-blending.html
"""

from __future__ import annotations

from typing import NamedTuple

from ..core.border import GpsReading, Sensors
from ..core.elementary import hypot
from ..core.geodesy import offset_ne
from ..core.kernels import law
from ..core.mavlink import GpsFixType
from ..core.records import Record
from ..core.vectors import Vec3
from .params.firmware_parameters import Parameters

USE_PRIMARY, USE_BEST, BLEND, USE_PRIMARY_IF_3D = 0, 1, 2, 4
"""GPS_AUTO_SWITCH"""
SILENCE_US = 4_000_000
"""A receiver that has not been heard for longer is none."""
ONE_MORE_US, TWO_MORE_US = 20_000_000, 5_000_000
"""So long after the last change one receiver is left for another that sees one satellite more, or two."""
DIFFERENCE = 50.0
"""Greatest distance of two fixes that agree [m]."""


class GpsChoice(Record):
    """Which receiver is used."""

    primary: int  # 0 the first, 1 the second
    changed_us: int  # when it last was another one


class Fix(NamedTuple):
    """What the filter gets of a receiver's message: as GpsReading."""

    gps_fix: int
    gps_lat: int
    gps_lon: int
    gps_alt: int
    gps_eph: int
    gps_vel: Vec3
    gps_satellites: int


@law
def _fix(seen: GpsReading) -> Fix:
    return Fix(
        seen.gps_fix, seen.gps_lat, seen.gps_lon, seen.gps_alt, seen.gps_eph, seen.gps_vel, seen.gps_satellites
    )  # fmt: skip


@law
def fix_of(receiver: int, sensors: Sensors) -> Fix:
    """The last message of a receiver."""
    return _fix(sensors.gps2) if receiver == 1 else _fix(sensors)


@law
def count_of(receiver: int, sensors: Sensors) -> int:
    """Messages of a receiver so far."""
    return sensors.gps2.gps_count if receiver == 1 else sensors.gps_count


@law
def time_of(receiver: int, sensors: Sensors) -> int:
    """When a receiver was last received [us]."""
    return sensors.gps2.gps_time_us if receiver == 1 else sensors.gps_time_us


@law
def status(receiver: int, sensors: Sensors, now_us: int) -> int:
    """GPS_FIX_TYPE of a receiver, 0 of a silent one."""
    silent = now_us - time_of(receiver, sensors) > SILENCE_US
    return 0 if silent else fix_of(receiver, sensors).gps_fix


@law
def is_better(other: int, choice: GpsChoice, sensors: Sensors, now_us: int) -> bool:
    """Whether the other receiver has a better fix, or, for long enough, sees more satellites."""
    theirs, ours = status(other, sensors, now_us), status(choice.primary, sensors, now_us)
    if theirs != ours:
        return theirs > ours
    more = fix_of(other, sensors).gps_satellites - fix_of(choice.primary, sensors).gps_satellites
    since = now_us - choice.changed_us
    return (more >= 1 and since >= ONE_MORE_US) or (more >= 2 and since >= TWO_MORE_US)


@law
def wanted(choice: GpsChoice, sensors: Sensors, params: Parameters, now_us: int) -> int:
    """The receiver that GPS_AUTO_SWITCH asks for now."""
    how, first = int(params.GPS_AUTO_SWITCH), int(params.GPS_PRIMARY)
    if how == USE_PRIMARY or (how == USE_PRIMARY_IF_3D and status(first, sensors, now_us) >= GpsFixType.FIX_3D):
        return first
    other = 1 - choice.primary
    return other if is_better(other, choice, sensors, now_us) else choice.primary


@law
def choose(choice: GpsChoice, sensors: Sensors, params: Parameters, now_us: int) -> None:
    """Each tick of a vehicle with a second receiver."""
    receiver = wanted(choice, sensors, params, now_us)
    if receiver != choice.primary:
        choice.primary = receiver
        choice.changed_us = now_us


@law
def distance(sensors: Sensors) -> float:
    """Between the last fixes of both [m]."""
    one, other = fix_of(0, sensors), fix_of(1, sensors)
    ne = offset_ne(one.gps_lat, one.gps_lon, other.gps_lat, other.gps_lon)
    return hypot(hypot(ne.x, ne.y), 0.001 * (other.gps_alt - one.gps_alt))


@law
def has_fix(receiver: int, sensors: Sensors) -> bool:
    """Whether the last message of a receiver is a 3D fix."""
    return fix_of(receiver, sensors).gps_fix >= GpsFixType.FIX_3D
