# SPDX-License-Identifier: BSD-3-Clause
"""What a pilot does with any vehicle: modes, arming, places to go to, sticks."""

from __future__ import annotations

import math
from collections.abc import Mapping

from sitl.core.geodesy import add_offset, offset_ne

from .parameters import Tunable, UnknownName
from .waits import Waits

SET_MODE, ARM, DO_CHANGE_SPEED, REBOOT = 176, 400, 178, 246
FORCED = 21196
"""Second parameter of arming: without asking."""
RELATIVE_INT = 6
"""MAV_FRAME_GLOBAL_RELATIVE_ALT_INT"""
LOCAL_NED, BODY_OFFSET_NED = 1, 9
POSITION_ONLY, VELOCITY_ONLY = 0b1101_1111_1000, 0b1101_1100_0111
"""POSITION_TARGET_TYPEMASK: acceleration, yaw, yaw rate and the other one are to be ignored."""
YAW, YAW_RATE = 0x400, 0x800
IGNORED = 65535
STICKS = {"roll": "RCMAP_ROLL", "pitch": "RCMAP_PITCH", "throttle": "RCMAP_THROTTLE", "yaw": "RCMAP_YAW"}
STICKS |= {"steering": "RCMAP_ROLL"}


class Piloted(Tunable, Waits):
    """A vehicle with a pilot."""

    def change_mode(self, name: str, timeout: float = 5.0) -> None:
        """Choose a mode, and wait until it is on."""
        __tracebackhide__ = True
        numbers = {mode: number for number, mode in self.simulation.firmware.mode_names.items()}
        if name not in numbers:
            raise UnknownName(f"the {self.kind} has no mode {name!r}; it has {', '.join(numbers)}")
        self._let_go("velocity")
        self.command(SET_MODE, 1, numbers[name], name=f"mode {name}")
        self.wait_mode(name, timeout)

    def arm(self, force: bool = False) -> None:
        """Arm; ``force``: without its checks."""
        __tracebackhide__ = True
        self.command(ARM, 1, FORCED if force else 0, name="arming")
        self.wait_armed(2.0)

    def disarm(self, force: bool = False) -> None:
        """Disarm; ``force``: even in the air."""
        __tracebackhide__ = True
        self.command(ARM, 0, FORCED if force else 0, name="disarming")
        self.wait_disarmed(2.0)

    def reboot(self) -> None:
        """Restart the autopilot where it stands; parameters and mission stay. ``wait_ready`` is what comes next."""
        __tracebackhide__ = True
        self.command(REBOOT, 1, name="the reboot")
        self.telemetry.has_position = self.telemetry.checked = False
        self.delay(1.0)

    def set_speed(self, metres_per_second: float) -> None:
        """Along the ground, in AUTO and GUIDED (DO_CHANGE_SPEED)."""
        __tracebackhide__ = True
        self.command(DO_CHANGE_SPEED, 1, metres_per_second, -1, name=f"speed {metres_per_second:g} m/s")

    # ------------------------------------------------------------------ places

    def place_of(self, lat: float, lon: float) -> tuple[float, float]:
        """North, east from home [m] of a latitude and longitude [deg]."""
        home = self._home()
        north, east = offset_ne(home[0], home[1], lat * 1e7, lon * 1e7)
        return (float(north), float(east))

    def set_position(self, north: float, east: float, height: float | None = None, yaw: float | None = None) -> None:
        """In GUIDED: go to a place from home [m], at a height above home (None: its present one) and a yaw [deg]."""
        __tracebackhide__ = True
        self._let_go("velocity")
        home = self._home()
        lat, lon = add_offset(home[0], home[1], north, east)
        self.send(
            "SET_POSITION_TARGET_GLOBAL_INT",
            coordinate_frame=RELATIVE_INT,
            type_mask=POSITION_ONLY & ~(YAW if yaw is not None else 0),
            lat_int=round(lat), lon_int=round(lon), alt=self.height if height is None else height,
            yaw=math.radians(yaw or 0.0),
        )  # fmt: skip

    def fly_to(
        self,
        north: float,
        east: float,
        height: float | None = None,
        yaw: float | None = None,
        accuracy: float = 1.0,
        timeout: float = 120.0,
    ) -> None:
        """``set_position``, and wait until it is there."""
        __tracebackhide__ = True
        self.set_position(north, east, height, yaw)
        self.wait_location(north, east, height if self.kind == "copter" else None, accuracy, timeout)

    drive_to = fly_to

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
        """In GUIDED: a velocity [m/s], sent twice a second until another order is given.

        Args:
            north, east, down: with ``body``: forward, right, down.
            yaw: [deg]; yaw_rate: [deg/s].
        """
        mask = VELOCITY_ONLY & ~(YAW if yaw is not None else 0) & ~(YAW_RATE if yaw_rate is not None else 0)
        self._hold("velocity", "SET_POSITION_TARGET_LOCAL_NED", {
            "coordinate_frame": BODY_OFFSET_NED if body else LOCAL_NED, "type_mask": mask,
            "vx": north, "vy": east, "vz": down,
            "yaw": math.radians(yaw or 0.0), "yaw_rate": math.radians(yaw_rate or 0.0),
        })  # fmt: skip

    def _home(self) -> tuple[int, int, float]:
        __tracebackhide__ = True
        if self.telemetry.home is None:
            self.give_up("no home yet: places are counted from it")
        return self.telemetry.home

    # ------------------------------------------------------------------ sticks

    def set_rc(self, channels: Mapping[int, int] | None = None, **sticks: int) -> None:
        """Hold sticks: pulses [us] by channel, or ``roll=``, ``pitch=``, ``throttle=``, ``yaw=``, ``steering=``.

        They stay until they are set again or ``release_rc``.
        """
        __tracebackhide__ = True
        pulses = self._pulses()
        for name, pulse in sticks.items():
            if name not in STICKS:
                raise UnknownName(f"there is no stick {name!r}; there are {', '.join(STICKS)}, or channels by number")
            pulses[round(self.parameter(STICKS[name]))] = pulse
        pulses.update(channels or {})
        for channel in pulses:
            if not 1 <= channel <= 18:
                raise UnknownName(f"there is no channel {channel}; there are 1 to 18")
        self._send_rc(pulses)

    def release_rc(self) -> None:
        """Give all sticks back to the pilot's own transmitter."""
        pulses = self._pulses()
        self._send_rc({channel: 0 if channel <= 8 else IGNORED - 1 for channel in pulses})
        self._let_go("sticks")

    def _pulses(self) -> dict[int, int]:
        held = self._held.get("sticks", ("", {}))[1]
        given = {k: held.get(f"chan{k}_raw", IGNORED if k <= 8 else 0) for k in range(1, 19)}
        return {k: pulse for k, pulse in given.items() if pulse not in (0, IGNORED)}

    def _send_rc(self, pulses: Mapping[int, int]) -> None:
        fields = {f"chan{k}_raw": pulses.get(k, IGNORED if k <= 8 else 0) for k in range(1, 19)}
        self._hold("sticks", "RC_CHANNELS_OVERRIDE", fields)
