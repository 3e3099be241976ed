# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry of a vehicle that Betaflight flies, from the true state of our physics: it has no estimate of its own."""

from __future__ import annotations

import math
from collections.abc import Callable

from ...bridge.dialect import message
from ...core.algebra import euler_of
from ...core.elementary import hypot
from ...core.geodesy import add_offset
from ...core.mavlink import MavLandedState, MavSysStatus
from ...physics.native.records import GROUND_AIRBORNE
from ...plants.local import LocalPlant
from . import wire
from .receiver import Sticks

_UNKNOWN16, _UNKNOWN8 = 65535, 255
_CELLS = 10
_KNOWN = 0x01 | 0x02 | 0x04 | 0x08 | 0x10 | 0x20
"""Of EKF_STATUS_REPORT: attitude, velocity, position and height are known; this is the true state."""


class Telemetry:
    """Builds messages.

    Args:
        plant: whose vehicle it is.
        sticks: what its receiver sends.
    """

    def __init__(self, plant: LocalPlant, sticks: Sticks) -> None:
        self._v, self._sticks = plant.vehicle.v, sticks
        self.may_arm = False
        """Whether Betaflight would arm now."""
        self._full = float(plant.vehicle.airframe.value("battery_capacity"))
        lat, lon, alt = plant.home[:3]
        self._home = round(1e7 * lat), round(1e7 * lon), alt
        self.builders: dict[int, Callable[[], bytes]] = {
            message(name).id: build
            for name, build in (
                ("ATTITUDE", self._attitude),
                ("ATTITUDE_QUATERNION", self._quaternion),
                ("LOCAL_POSITION_NED", self._local),
                ("GLOBAL_POSITION_INT", self._global),
                ("GPS_RAW_INT", self._gps),
                ("GPS_GLOBAL_ORIGIN", self._origin),
                ("HOME_POSITION", self._home_position),
                ("BATTERY_STATUS", self._battery),
                ("SYS_STATUS", self._status),
                ("SERVO_OUTPUT_RAW", self._servos),
                ("RC_CHANNELS", self._channels),
                ("VFR_HUD", self._hud),
                ("EXTENDED_SYS_STATE", self._landed),
                ("EKF_STATUS_REPORT", lambda: message("EKF_STATUS_REPORT").payload(flags=_KNOWN)),
                ("SYSTEM_TIME", self._time),
                ("SIMSTATE", self._simstate),
                ("AUTOPILOT_VERSION", self._version),
            )
        }
        """Message id -> what gives its payload now."""

    @property
    def _ms(self) -> int:
        return int(self._v.time_us) // 1000

    @property
    def is_on_ground(self) -> bool:
        """Whether it stands or lies on the ground."""
        return int(self._v.physics.ground.state) != GROUND_AIRBORNE

    @property
    def _heading(self) -> int:
        """[cdeg], 0 .. 35999"""
        return round(100.0 * math.degrees(euler_of(self._v.physics.body.q).yaw)) % 36_000

    @property
    def _location(self) -> tuple[int, int, int]:
        """Latitude, longitude [degE7], altitude [mm]."""
        north, east, down = self._v.physics.body.pos
        lat, lon = add_offset(self._home[0], self._home[1], north, east)
        return round(lat), round(lon), round(1e3 * (self._home[2] - down))

    def _attitude(self) -> bytes:
        body = self._v.physics.body
        return message("ATTITUDE").pack(self._ms, *euler_of(body.q), *body.rates)

    def _quaternion(self) -> bytes:
        body = self._v.physics.body
        return message("ATTITUDE_QUATERNION").pack(self._ms, *body.q, *body.rates, *4 * (0.0,))

    def _local(self) -> bytes:
        body = self._v.physics.body
        return message("LOCAL_POSITION_NED").pack(self._ms, *body.pos, *body.vel)

    def _global(self) -> bytes:
        body = self._v.physics.body
        north, east, down = (min(max(round(100.0 * speed), -32768), 32767) for speed in body.vel)
        return message("GLOBAL_POSITION_INT").pack(
            self._ms, *self._location, round(-1e3 * body.pos[2]), north, east, down, self._heading
        )

    def _gps(self) -> bytes:
        """What our receiver says, which Betaflight's simulator has no use for."""
        gps = self._v.sensors
        speed = hypot(float(gps.gps_vel[0]), float(gps.gps_vel[1]))
        return message("GPS_RAW_INT").payload(
            time_usec=int(gps.gps_time_us), fix_type=int(gps.gps_fix), lat=int(gps.gps_lat), lon=int(gps.gps_lon),
            alt=int(gps.gps_alt), eph=min(int(gps.gps_eph), _UNKNOWN16), epv=min(int(gps.gps_epv), _UNKNOWN16),
            vel=min(round(speed), _UNKNOWN16), cog=_UNKNOWN16, satellites_visible=int(gps.gps_satellites),
        )  # fmt: skip

    def _origin(self) -> bytes:
        lat, lon, alt = self._home
        return message("GPS_GLOBAL_ORIGIN").payload(latitude=lat, longitude=lon, altitude=round(1e3 * alt))

    def _home_position(self) -> bytes:
        lat, lon, alt = self._home
        return message("HOME_POSITION").payload(latitude=lat, longitude=lon, altitude=round(1e3 * alt), q=(1, 0, 0, 0))

    def _battery(self) -> bytes:
        charge, sensors = float(self._v.physics.battery.charge), self._v.sensors
        voltage, current = round(1e3 * float(sensors.battery_voltage)), round(100.0 * float(sensors.battery_current))
        return message("BATTERY_STATUS").payload(
            voltages=(voltage, *(_CELLS - 1) * (_UNKNOWN16,)), current_battery=current,
            current_consumed=round(1e3 * self._full * (1.0 - charge)), energy_consumed=-1,
            battery_remaining=round(100.0 * charge), temperature=32767,
        )  # fmt: skip

    def _status(self) -> bytes:
        sensors, charge = self._v.sensors, float(self._v.physics.battery.charge)
        return message("SYS_STATUS").payload(
            onboard_control_sensors_present=MavSysStatus.PREARM_CHECK,
            onboard_control_sensors_enabled=MavSysStatus.PREARM_CHECK,
            onboard_control_sensors_health=MavSysStatus.PREARM_CHECK if self.may_arm else 0,
            voltage_battery=round(1e3 * float(sensors.battery_voltage)),
            current_battery=round(100.0 * float(sensors.battery_current)), battery_remaining=round(100.0 * charge),
        )  # fmt: skip

    def _servos(self) -> bytes:
        pulses = {f"servo{k + 1}_raw": int(pulse) for k, pulse in enumerate(self._v.actuators.pwm)}
        return message("SERVO_OUTPUT_RAW").payload(time_usec=int(self._v.time_us) & 0xFFFFFFFF, **pulses)

    def _channels(self) -> bytes:
        found = self._sticks.pulses()
        pulses = {f"chan{k + 1}_raw": pulse for k, pulse in enumerate(found)}
        return message("RC_CHANNELS").payload(time_boot_ms=self._ms, chancount=len(found), rssi=_UNKNOWN8, **pulses)

    def _hud(self) -> bytes:
        body = self._v.physics.body
        speed = hypot(float(body.vel[0]), float(body.vel[1]))
        one, two, three, four = (float(x) for x in self._v.actuators.controls[: wire.MOTORS])
        throttle = round(25.0 * (one + two + three + four))
        return message("VFR_HUD").payload(
            airspeed=speed, groundspeed=speed, heading=self._heading // 100, throttle=throttle,
            alt=self._home[2] - float(body.pos[2]), climb=-float(body.vel[2]),
        )  # fmt: skip

    def _landed(self) -> bytes:
        return message("EXTENDED_SYS_STATE").payload(
            landed_state=MavLandedState.ON_GROUND if self.is_on_ground else MavLandedState.IN_AIR
        )

    def _time(self) -> bytes:
        return message("SYSTEM_TIME").payload(time_boot_ms=self._ms)

    def _simstate(self) -> bytes:
        body = self._v.physics.body
        lat, lon, _ = self._location
        roll, pitch, yaw = euler_of(body.q)
        xacc, yacc, zacc = body.specific_force
        xgyro, ygyro, zgyro = body.rates
        return message("SIMSTATE").payload(
            roll=roll, pitch=pitch, yaw=yaw, xacc=xacc, yacc=yacc, zacc=zacc, xgyro=xgyro, ygyro=ygyro, zgyro=zgyro,
            lat=lat, lng=lon,
        )  # fmt: skip

    def _version(self) -> bytes:
        return message("AUTOPILOT_VERSION").payload(uid=1)
