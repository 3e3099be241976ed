# SPDX-License-Identifier: BSD-3-Clause
"""Attitude, position, home and origin."""

from __future__ import annotations

import math
from typing import NamedTuple

from ...autopilot.estimation.status import POS_HORIZ_REL
from ...autopilot.state import Estimate
from ...core.border import GpsReading
from ...core.elementary import atan2, hypot
from ...core.geodesy import METRES_PER_DEGE7, longitude_scale, wrap_longitude
from ...core.kernels import law
from ...core.records import Floats
from ...core.vectors import Euler, Quat, Vec3
from ...vehicle.record import Vehicle
from ..wire.message import Message, consecutive
from .units import DEG, boot_ms, heading_cdeg, int16s, int32, uint16

UNKNOWN = 65535
USUAL_HDOP, USUAL_VDOP = 121, 200
ACCURACY_OF_HDOP, ACCURACY_OF_VDOP = 300.0 / USUAL_HDOP, 300.0 / USUAL_VDOP
"""Accuracy of a fix by a hundredth of its dilution [mm]: 0.3 m of ArduPilot's simulated receiver (1.21, 2.00)."""
SPEED_ACCURACY = 0.8
"""Of the speed, by a hundredth of what the dilution has beyond the usual [mm/s]: up to 48 m/s while it is jammed."""


class GlobalPosition(NamedTuple):
    """A position on the globe."""

    lat: int  # [degE7]
    lon: int  # [degE7]
    alt: float  # above mean sea level [m]


@law
def global_position(v: Vehicle) -> GlobalPosition:
    """Where the vehicle is: the GPS fix until the origin is known, then the estimate."""
    estimate, gps = v.autopilot.estimate, v.sensors
    if estimate.origin_set:
        north = estimate.pos.x / METRES_PER_DEGE7
        middle = int32(estimate.origin_lat + 0.5 * north) >> 12 << 12  # the same cosine for 0.4 mdeg of latitude
        scale = longitude_scale(float(middle)) * METRES_PER_DEGE7
        lat, lon = estimate.origin_lat + north, wrap_longitude(estimate.origin_lon + estimate.pos.y / scale)
        return GlobalPosition(int32(lat), int32(lon), estimate.origin_alt - estimate.pos.z)
    if gps.gps_fix >= 3:
        return GlobalPosition(gps.gps_lat, gps.gps_lon, gps.gps_alt * 1e-3)
    return GlobalPosition(0, 0, 0.0)


@law
def is_relative(estimate: Estimate) -> bool:
    """Whether positions count from where the estimate began, somewhere on the globe."""
    return not estimate.origin_set and estimate.status_flags & POS_HORIZ_REL != 0


class GlobalPositionInt(Message, name="GLOBAL_POSITION_INT"):
    time_boot_ms: int
    lat: int
    lon: int
    alt: int
    relative_alt: int
    vel: Vec3 = consecutive("vx", "vy", "vz")
    hdg: int


@law
def global_position_int(m: GlobalPositionInt, v: Vehicle) -> bool:
    """GLOBAL_POSITION_INT: degE7, mm above sea level and above home, cm/s, heading in centidegrees; without an origin
    the relative height is that above the beginning.
    """
    estimate, home = v.autopilot.estimate, v.autopilot.home
    here = global_position(v)
    m.time_boot_ms = boot_ms(v.time_us)
    m.lat = here.lat
    m.lon = here.lon
    m.alt = int32(here.alt * 1e3)
    if home.is_set:
        m.relative_alt = int32((here.alt - home.alt) * 1e3)
    elif is_relative(estimate):
        m.relative_alt = int32(-estimate.pos.z * 1e3)
    m.vel = int16s(estimate.vel * 100.0)
    m.hdg = heading_cdeg(estimate.yaw)
    return True


class LocalPositionNed(Message, name="LOCAL_POSITION_NED"):
    time_boot_ms: int
    pos: Vec3 = consecutive("x", "y", "z")
    vel: Vec3 = consecutive("vx", "vy", "vz")


@law
def local_position_ned(m: LocalPositionNed, v: Vehicle) -> bool:
    """LOCAL_POSITION_NED: metres from the EKF origin, m/s; nothing until that is set, or positions are relative."""
    estimate = v.autopilot.estimate
    m.time_boot_ms = boot_ms(v.time_us)
    m.pos = estimate.pos
    m.vel = estimate.vel
    return estimate.origin_set or is_relative(estimate)


class VfrHud(Message, name="VFR_HUD"):
    airspeed: float
    groundspeed: float
    alt: float
    climb: float
    heading: int
    throttle: int


@law
def vfr_hud(m: VfrHud, v: Vehicle, throttle: float) -> bool:
    """VFR_HUD of a firmware whose throttle is -1 .. 1."""
    estimate = v.autopilot.estimate
    m.airspeed = m.groundspeed = hypot(estimate.vel.x, estimate.vel.y)
    m.alt = global_position(v).alt
    m.climb = -estimate.vel.z
    m.heading = heading_cdeg(estimate.yaw) // 100
    m.throttle = uint16(abs(throttle) * 100.0 + 0.5)
    return True


class HomePosition(Message, name="HOME_POSITION"):
    latitude: int
    longitude: int
    altitude: int
    pos: Vec3 = consecutive("x", "y", "z")
    q: Floats
    time_usec: int


@law
def home_position(m: HomePosition, v: Vehicle) -> bool:
    """HOME_POSITION: degE7, mm, and NED metres from the origin, no orientation; nothing until home is set."""
    home = v.autopilot.home
    m.latitude = int32(home.lat)
    m.longitude = int32(home.lon)
    m.altitude = int32(home.alt * 1e3)
    m.pos = home.pos
    for k in range(len(m.q)):
        m.q[k] = math.nan
    m.time_usec = v.time_us
    return home.is_set


class GpsGlobalOrigin(Message, name="GPS_GLOBAL_ORIGIN"):
    latitude: int
    longitude: int
    altitude: int
    time_usec: int


@law
def gps_global_origin(m: GpsGlobalOrigin, v: Vehicle) -> bool:
    """GPS_GLOBAL_ORIGIN: degE7, mm; nothing until the origin is set."""
    estimate = v.autopilot.estimate
    m.latitude = estimate.origin_lat
    m.longitude = estimate.origin_lon
    m.altitude = int32(estimate.origin_alt * 1e3)
    m.time_usec = v.time_us
    return estimate.origin_set


class GpsRawInt(Message, name="GPS_RAW_INT"):
    time_usec: int
    lat: int
    lon: int
    alt: int
    eph: int
    epv: int
    vel: int
    cog: int
    fix_type: int
    satellites_visible: int
    alt_ellipsoid: int
    h_acc: int
    v_acc: int
    vel_acc: int


class Gps2Raw(GpsRawInt, name="GPS2_RAW"):
    pass


@law
def fill_fix(m: GpsRawInt | Gps2Raw, s: GpsReading) -> None:
    """A receiver's fix, course [cdeg], speed [cm/s]; h_acc, v_acc [mm] and vel_acc [mm/s] follow from the dilutions.

    The accuracies of the speed, usually, and of the heading are not known (0), as with ArduPilot's simulated receiver.
    """
    vel = s.gps_vel
    m.time_usec = s.gps_time_us
    m.lat = s.gps_lat
    m.lon = s.gps_lon
    m.alt = m.alt_ellipsoid = s.gps_alt
    m.vel = uint16(hypot(vel.x, vel.y))
    m.cog = uint16(atan2(vel.y, vel.x) * DEG * 100.0 % 36000.0)
    m.fix_type = s.gps_fix & 0xFF
    m.satellites_visible = min(max(s.gps_satellites, 0), 255)
    m.eph = m.epv = UNKNOWN
    if s.gps_fix >= 2:
        m.eph = uint16(s.gps_eph)
        m.epv = uint16(s.gps_epv)
        m.h_acc = int32(ACCURACY_OF_HDOP * m.eph)
        m.v_acc = int32(ACCURACY_OF_VDOP * m.epv)
        m.vel_acc = int32(SPEED_ACCURACY * max(m.eph - USUAL_HDOP, 0))


@law
def gps_raw_int(m: GpsRawInt, v: Vehicle) -> bool:
    """GPS_RAW_INT: the first receiver's fix."""
    fill_fix(m, v.sensors)
    return True


@law
def gps2_raw(m: Gps2Raw, v: Vehicle) -> bool:
    """GPS2_RAW: the second receiver's fix, of a vehicle with GPS2_TYPE."""
    fill_fix(m, v.sensors.gps2)
    return v.autopilot.params.GPS2_TYPE != 0.0


class Attitude(Message, name="ATTITUDE"):
    time_boot_ms: int
    euler: Euler = consecutive("roll", "pitch", "yaw")
    rates: Vec3 = consecutive("rollspeed", "pitchspeed", "yawspeed")


@law
def attitude(m: Attitude, v: Vehicle) -> bool:
    """ATTITUDE: Euler angles [rad], body rates [rad/s]."""
    m.time_boot_ms = boot_ms(v.time_us)
    m.euler = v.autopilot.estimate.euler
    m.rates = v.autopilot.estimate.rates
    return True


class AttitudeQuaternion(Message, name="ATTITUDE_QUATERNION"):
    time_boot_ms: int
    q: Quat = consecutive("q1", "q2", "q3", "q4")
    rates: Vec3 = consecutive("rollspeed", "pitchspeed", "yawspeed")


@law
def attitude_quaternion(m: AttitudeQuaternion, v: Vehicle) -> bool:
    """ATTITUDE_QUATERNION: body to NED as (w, x, y, z)."""
    m.time_boot_ms = boot_ms(v.time_us)
    m.q = v.autopilot.estimate.q
    m.rates = v.autopilot.estimate.rates
    return True


class Ahrs(Message, name="AHRS"):
    drift: Vec3 = consecutive("omegaIx", "omegaIy", "omegaIz")


@law
def ahrs(m: Ahrs, v: Vehicle) -> bool:
    """AHRS: gyro drift [rad/s]; the DCM values of the message have no counterpart here and are zero."""
    m.drift = -v.autopilot.estimate.gyro_bias
    return True


class Ahrs2(Message, name="AHRS2"):
    euler: Euler = consecutive("roll", "pitch", "yaw")
    altitude: float
    lat: int
    lng: int


@law
def ahrs2(m: Ahrs2, v: Vehicle) -> bool:
    """AHRS2: the second attitude source; this firmware has one estimator and reports it again."""
    here = global_position(v)
    m.euler = v.autopilot.estimate.euler
    m.altitude = here.alt
    m.lat = here.lat
    m.lng = here.lon
    return True


MESSAGES = (
    global_position_int, local_position_ned, home_position, gps_global_origin, gps_raw_int, gps2_raw, attitude,
    attitude_quaternion, ahrs, ahrs2,
)  # fmt: skip
