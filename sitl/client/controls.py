# SPDX-License-Identifier: BSD-3-Clause
"""What a pilot does with any vehicle: modes, arming, positions to go to, sticks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial

from ..bridge.services.setpoint_messages import (
    ACCELERATION_IGNORED,
    POSITION_IGNORED,
    VELOCITY_IGNORED,
    YAW_IGNORED,
    YAW_RATE_IGNORED,
    YAWS_IGNORED,
)
from ..core.geodesy import add_offset, offset_ne
from ..core.mavlink import ARM_FORCED, MavCmd, MavFrame, MavModeFlag
from ..errors import OptionError
from . import px4
from .errors import UnknownNameError
from .parameters import Parameters
from .waits import AT_REST, SURE_S, Waits

__tracebackhide__ = True

_CHANGE_MODE = 1.0
"""MAV_CMD_DO_REPOSITION, MAV_DO_REPOSITION_FLAGS_CHANGE_MODE"""
OFFBOARD_S = 1.0
"""So long PX4 gets set-points before it is asked into OFFBOARD."""
POSITION_ONLY = VELOCITY_IGNORED | ACCELERATION_IGNORED | YAWS_IGNORED
VELOCITY_ONLY = POSITION_IGNORED | ACCELERATION_IGNORED | YAWS_IGNORED
CHANNELS = range(1, 19)
IGNORED = 65535
"""RC_CHANNELS_OVERRIDE: this channel stays as it is; from channel 9 on, 0 says that."""
STICKS = {"roll": "RCMAP_ROLL", "pitch": "RCMAP_PITCH", "throttle": "RCMAP_THROTTLE", "yaw": "RCMAP_YAW"}
STICKS |= {"steering": "RCMAP_ROLL"}
REST_US = 3_000_000
OBEYING = ("GUIDED", "AUTO", "FOLLOW", "GUIDED_NOGPS", "AVOID_ADSB")
"""Modes in which positions may be obeyed; in AUTO, while an item of the mission says so (NAV_GUIDED_ENABLE)."""
_VELOCITY, _STICKS = "velocity", "sticks"


def check_finite(**arguments: float | None) -> None:
    """OptionError with name and value of an argument that is no finite number; None is one that is not given.

    A message can carry such a number, but a vehicle ignores it without an answer, and the wait ends for no reason.
    """
    for name, value in arguments.items():
        if value is not None and not math.isfinite(value):
            raise OptionError(f"{name} = {value}: a finite number is needed")


class Controls(Waits):
    """A vehicle with a pilot."""

    _order: Callable[[], None] | None = None
    """Sends the vehicle to where it is waited for."""
    _moved_us = 0
    """When it moved last, or was sent."""

    @property
    def params(self) -> Parameters:
        """Its parameters by name."""
        return Parameters(self)

    # ------------------------------------------------------------------ modes

    def set_mode(self, name: str, timeout: float = 5.0) -> None:
        """Choose a mode ("GUIDED"), and wait until it is on; ``timeout`` in simulated seconds, as everywhere here."""
        number = self._mode_number(name)
        self._stop_sending(_VELOCITY)
        self._ask_mode(number, f"mode {name}")
        self.wait_mode(name, timeout)

    def _ask_mode(self, number: int, subject: str) -> None:
        numbers = px4.mode_parameters(number) if self.telemetry.is_px4 else (number,)
        self.command("DO_SET_MODE", MavModeFlag.CUSTOM_MODE_ENABLED, *numbers, subject=subject)

    def arm(self, force: bool = False) -> None:
        """Arm; ``force``: without its checks."""
        self.command("COMPONENT_ARM_DISARM", 1, ARM_FORCED if force else 0, subject="arming")
        self.wait_armed(2.0)

    def disarm(self, force: bool = False) -> None:
        """Disarm; ``force``: even in the air."""
        self.command("COMPONENT_ARM_DISARM", 0, ARM_FORCED if force else 0, subject="disarming")
        self.wait_disarmed(5.0)  # heartbeats, of which a bad link loses some

    def reboot(self) -> None:
        """Restart the autopilot where it stands; parameters and mission stay. ``wait_ready`` is what comes next."""
        self.command("PREFLIGHT_REBOOT_SHUTDOWN", 1, subject="the reboot")
        self.telemetry.has_position = self.telemetry.checked = False
        self.delay(1.0)

    def guided_and_armed(self) -> None:
        """In GUIDED (PX4: LOITER), and armed: what is not so yet is asked for."""
        guided = px4.READY if self.telemetry.is_px4 else "GUIDED"
        if self.mode != guided:
            self.set_mode(guided)
        if not self.armed:
            self.arm()

    # ------------------------------------------------------------------ up and down

    def take_off(self, altitude: float = 10.0, timeout: float = 60.0) -> None:
        """GUIDED, arm if need be, climb to an altitude above home [m], and wait until it is there."""
        check_finite(altitude=altitude)
        self.guided_and_armed()
        if self.telemetry.is_px4:  # above mean sea level, where it stands
            here, high = math.nan, self.home()[2] + altitude
            there = {"yaw": here, "latitude": here, "longitude": here, "altitude": high}
            self.command("NAV_TAKEOFF", **there, subject="the take-off")
        else:
            self.command("NAV_TAKEOFF", altitude=altitude, subject="the take-off")
        low, high = altitude - max(0.5, 0.05 * altitude), altitude + 2.0
        self._wait_range("an altitude", "m", lambda t: t.altitude, low, high, timeout, 0.0, self._disarmed())

    def land(self, timeout: float = 120.0) -> None:
        """LAND, and wait until it is disarmed, at most ``timeout`` [simulated s]."""
        self.set_mode("LAND")
        self.wait_disarmed(timeout)

    def return_to_launch(self, timeout: float = 300.0) -> None:
        """RTL, and wait until it is disarmed, at most ``timeout`` [simulated s]."""
        self.set_mode("RTL")
        self.wait_disarmed(timeout)

    # ------------------------------------------------------------------ positions

    def place_of(self, lat: float, lon: float) -> tuple[float, float]:
        """North, east from home [m] of a latitude and longitude [deg]."""
        home = self.home()
        north, east = offset_ne(home[0], home[1], lat * 1e7, lon * 1e7)
        return (float(north), float(east))

    def location_of(self, north: float, east: float) -> tuple[int, int]:
        """Latitude, longitude [degE7] of a position from home [m]."""
        home = self.home()
        lat, lon = add_offset(home[0], home[1], north, east)
        return (round(lat), round(lon))

    def home(self) -> tuple[int, int, float]:
        """Latitude, longitude [degE7], altitude above mean sea level [m] of home; it is asked for when it is not known.

        Raises:
            CommandRefusedError: there is no home yet.
        """
        if self.telemetry.home is None:
            self.message("HOME_POSITION", 10.0)
        assert self.telemetry.home is not None
        return self.telemetry.home

    def set_position(self, north: float, east: float, altitude: float | None = None, yaw: float | None = None) -> None:
        """In GUIDED: go to a position from home [m], at an altitude above home (None: its present one) and a yaw [deg].

        PX4 goes into LOITER with it.
        """
        check_finite(north=north, east=east, altitude=altitude, yaw=yaw)
        self._stop_sending(_VELOCITY)
        lat, lon = self.location_of(north, east)
        if self.telemetry.is_px4:
            height = self.telemetry.altitude if altitude is None else altitude
            self.send(
                "COMMAND_INT", frame=MavFrame.GLOBAL_INT, command=MavCmd.DO_REPOSITION, x=lat, y=lon,
                z=self.home()[2] + height,
                param1=-1.0, param2=_CHANGE_MODE, param4=math.nan if yaw is None else math.radians(yaw),
            )  # fmt: skip
            return
        self.send(
            "SET_POSITION_TARGET_GLOBAL_INT",
            coordinate_frame=MavFrame.GLOBAL_RELATIVE_ALT_INT,
            type_mask=POSITION_ONLY & ~(YAW_IGNORED if yaw is not None else 0),
            lat_int=lat, lon_int=lon, alt=self.telemetry.altitude if altitude is None else altitude,
            yaw=math.radians(yaw or 0.0),
        )  # fmt: skip

    def goto(
        self,
        north: float,
        east: float,
        altitude: float | None = None,
        yaw: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
    ) -> None:
        """``set_position``, and wait until it is there, within ``accuracy`` [m].

        The order is not answered: a vehicle that has stood elsewhere for ``REST_US`` is told again.

        Raises:
            ImpossibleWaitError: the vehicle is disarmed, or in a mode that takes no such order.
        """
        order = partial(self.set_position, north, east, altitude, yaw)
        order()
        self._order, self._moved_us = order, self.connection.time_us
        try:
            height = altitude if self.flies else None
            self._wait_location(north, east, height, accuracy, timeout, in_vain=self._not_going())
        finally:
            self._order = None

    def _not_going(self) -> Callable[[], str]:
        """Tells why the vehicle does not go where it is sent: it is disarmed, or it was never in GUIDED since now."""
        disarmed, begin, obeyed = self._disarmed(), self.now, list[str]()

        def why() -> str:
            if self.mode in OBEYING or "GUIDED" not in self.telemetry.mode_names.values():
                obeyed.append(self.mode)
            reason = disarmed()
            if not (reason or obeyed) and self.telemetry.heartbeat_at - begin >= SURE_S:
                reason = f"the {self.kind} is in mode {self.mode}, and goes where it is sent in GUIDED only"
            return reason

        return why

    def step(self, stop_us: int | None = None) -> None:
        super().step(stop_us)
        if self._order is None:
            return
        now, t = self.connection.time_us, self.telemetry
        if max(t.groundspeed, abs(t.climb_rate)) > AT_REST:
            self._moved_us = now
        elif now - self._moved_us >= REST_US:
            self._order()
            self._moved_us = now

    def set_velocity(
        self,
        north: float,
        east: float,
        down: float = 0.0,
        *,
        yaw: float | None = None,
        yaw_rate: float | None = None,
        body: bool = False,
    ) -> None:
        """In GUIDED: a velocity [m/s], sent twice a second until another order is given; PX4 goes into OFFBOARD.

        Args:
            north, east, down: with ``body``: forward, right, down.
            yaw: [deg]; yaw_rate: [deg/s].
        """
        check_finite(north=north, east=east, down=down, yaw=yaw, yaw_rate=yaw_rate)
        mask = VELOCITY_ONLY
        mask &= ~(YAW_IGNORED if yaw is not None else 0) & ~(YAW_RATE_IGNORED if yaw_rate is not None else 0)
        of_body = MavFrame.BODY_NED if self.telemetry.is_px4 else MavFrame.BODY_OFFSET_NED
        self._keep_sending(_VELOCITY, "SET_POSITION_TARGET_LOCAL_NED", {
            "coordinate_frame": of_body if body else MavFrame.LOCAL_NED,
            "type_mask": mask,
            "vx": north, "vy": east, "vz": down,
            "yaw": math.radians(yaw or 0.0), "yaw_rate": math.radians(yaw_rate or 0.0),
        })  # fmt: skip
        if self.telemetry.is_px4 and self.mode != px4.OFFBOARD:
            self.delay(OFFBOARD_S)  # it has to get some before it may be in that mode
            self._repeat(_VELOCITY)
            self._ask_mode(self._mode_number(px4.OFFBOARD), f"mode {px4.OFFBOARD}")
            self.wait_mode(px4.OFFBOARD)

    def set_speed(self, metres_per_second: float) -> None:
        """Along the ground [m/s], in AUTO and GUIDED (DO_CHANGE_SPEED)."""
        self.command("DO_CHANGE_SPEED", 1, metres_per_second, -1, subject=f"speed {metres_per_second:g} m/s")

    # ------------------------------------------------------------------ sticks

    def rc(self, channels: Mapping[int, int] | None = None, **sticks: int) -> None:
        """Hold sticks: pulses [us] by channel, or ``roll=``, ``pitch=``, ``throttle=``, ``yaw=``, ``steering=``.

        They stay until they are set again or ``release_rc``.

        Raises:
            OptionError: the vehicle is a PX4, which is flown without sticks here.
        """
        if self.telemetry.is_px4:
            raise OptionError("sticks: a PX4 is started without them here (COM_RC_IN_MODE 4); send velocities instead")
        pulses = self._pulses()
        for name, pulse in sticks.items():
            if name not in STICKS:
                raise UnknownNameError(
                    f"there is no stick {name!r}; there are {', '.join(STICKS)}, or channels by number"
                )
            pulses[round(self.params[STICKS[name]])] = pulse
        pulses.update(channels or {})
        for channel in pulses:
            if channel not in CHANNELS:
                raise UnknownNameError(f"there is no channel {channel}; there are 1 to 18")
        self._send_rc(pulses)

    def release_rc(self) -> None:
        """Give all sticks back to the pilot's own transmitter."""
        self._send_rc({channel: 0 if channel <= 8 else IGNORED - 1 for channel in self._pulses()})
        self._stop_sending(_STICKS)

    def _pulses(self) -> dict[int, int]:
        """Those that are held, by channel."""
        held = self._repeated.get(_STICKS, ("", {}))[1]
        return {k: pulse for k in CHANNELS if (pulse := held.get(f"chan{k}_raw", 0)) not in (0, IGNORED)}

    def _send_rc(self, pulses: Mapping[int, int]) -> None:
        fields = {f"chan{k}_raw": pulses.get(k, IGNORED if k <= 8 else 0) for k in CHANNELS}
        self._keep_sending(_STICKS, "RC_CHANNELS_OVERRIDE", fields)
