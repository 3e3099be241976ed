# SPDX-License-Identifier: BSD-3-Clause
"""HIGH_LATENCY2: the state in 42 bytes, made of what other messages report, as ArduPilot's is."""

from __future__ import annotations

from ...core.mavlink import MavAutopilot, MavSysStatus
from ..autopilot_api import Vehicle
from ..dialect import message
from ..mavlink_firmware import MavlinkFirmware
from .motion import global_position
from .plain import built
from .units import boot_ms, heading_cdeg, int16, percent, uint8, uint16

FAILURES = {
    MavSysStatus.SENSOR_GPS: 0x1, MavSysStatus.SENSOR_DIFFERENTIAL_PRESSURE: 0x2,
    MavSysStatus.SENSOR_ABSOLUTE_PRESSURE: 0x4, MavSysStatus.SENSOR_3D_ACCEL: 0x8, MavSysStatus.SENSOR_3D_GYRO: 0x10,
    MavSysStatus.SENSOR_3D_MAG: 0x20, MavSysStatus.TERRAIN: 0x40, MavSysStatus.SENSOR_BATTERY: 0x80,
    MavSysStatus.SENSOR_RC_RECEIVER: 0x100, MavSysStatus.GEOFENCE: 0x800, MavSysStatus.AHRS: 0x1000,
}  # fmt: skip
"""Bit of SYS_STATUS' health -> HL_FAILURE_FLAG, set while that is not healthy. No vehicle has an airspeed sensor."""
NO_TEMPERATURE = -128
UNIT = 5.0
"""Of speeds [1/(m/s)]."""


def high_latency(vehicle: Vehicle, profile: MavlinkFirmware) -> bytes:
    """HIGH_LATENCY2: position, target, speeds in 0.2 m/s, headings in 2 degrees, distance to the target in 10 m,
    failures; ``custom0`` is HEARTBEAT's base_mode. The air's temperature is an airspeed sensor's (ARSPD_ENABLE,
    ARSPD_TYPE)."""
    v = vehicle.v
    ap = v.autopilot
    names = ("HEARTBEAT", "VFR_HUD", "SYS_STATUS", "NAV_CONTROLLER_OUTPUT")
    beat, hud, status, navigation = (built(profile, v, name) for name in names)
    here, targets = global_position(v), profile.targets(v)
    bearing, distance = (navigation.target_bearing, navigation.wp_dist) if navigation is not None else (0, 0)
    return message("HIGH_LATENCY2").payload(
        timestamp=boot_ms(int(v.time_us)),
        type=profile.mav_type,
        autopilot=MavAutopilot.ARDUPILOTMEGA,
        custom_mode=int(beat.custom_mode) & 0xFFFF,
        latitude=int(here.lat),
        longitude=int(here.lon),
        altitude=int16(here.alt),
        target_altitude=int16(targets.altitude),
        heading=heading_cdeg(ap.estimate.yaw) // 100 // 2,
        target_heading=int(bearing) % 360 // 2,
        target_distance=int(distance) // 10,
        throttle=int(hud.throttle),
        airspeed=uint8(UNIT * hud.airspeed),
        airspeed_sp=uint8(UNIT * targets.speed),
        groundspeed=uint8(UNIT * hud.groundspeed),
        wind_heading=targets.wind_heading,
        temperature_air=_air_temperature(vehicle),
        battery=percent(ap.battery.remaining_pct),
        wp_num=uint16(float(ap.modes.nav.mission_current)),
        failure_flags=failures(int(status.onboard_control_sensors_health)),
        custom0=_signed(int(beat.base_mode)),
    )


def _air_temperature(vehicle: Vehicle) -> int:
    """[degC]"""
    values = vehicle.parameters
    if values["ARSPD_ENABLE"] == 0.0 or values["ARSPD_TYPE"] <= 0.0:
        return NO_TEMPERATURE
    return int(vehicle.v.sensors.temperature)


def failures(health: int) -> int:
    """HL_FAILURE_FLAG bits of SYS_STATUS' health."""
    return sum(flag for sensor, flag in FAILURES.items() if not health & sensor)


def _signed(byte: int) -> int:
    return byte - 256 if byte > 127 else byte
