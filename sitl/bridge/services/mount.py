# SPDX-License-Identifier: BSD-3-Clause
"""The gimbal (MNT1_*): servo outputs of functions 6 (yaw), 7 (pitch) and 8 (roll) turn it; it stays level.

Nothing says where it really is: GIMBAL_DEVICE_ATTITUDE_STATUS tells what the outputs ask for.
https://mavlink.io/en/services/gimbal_v2.html
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from ...autopilot import payload
from ...autopilot.aux_switch import HIGH
from ...autopilot.mission import item as commands
from ...autopilot.mission.item import MissionItem
from ...core.algebra import conjugate, euler_of, multiply, quat_from_euler
from ...core.elementary import atan2, hypot
from ...core.mavlink import MavCmd, MavResult
from ...core.scalars import wrap_pi
from ...core.vectors import Euler, Vec3
from ..dialect import message
from ..host import Host
from ..listener import Sender
from .payload import PayloadService

ATTITUDE_STATUS, INFORMATION, STATUS = (
    message(f"GIMBAL_{name}") for name in ("DEVICE_ATTITUDE_STATUS", "MANAGER_INFORMATION", "MANAGER_STATUS")
)
FOLDED, NEUTRAL, ANGLES, STICKS, GPS_POINT, SYSTEM, HOME = range(7)
"""MAV_MOUNT_MODE"""
RATES = -1
"""Angular rates of a command."""
IS_RETRACTED, IS_NEUTRAL, ROLL_LOCK, PITCH_LOCK, YAW_LOCK, YAW_IN_VEHICLE_FRAME = 1, 2, 4, 8, 16, 32
"""GIMBAL_DEVICE_FLAGS"""
CAPABILITIES = 0x327FF
"""GIMBAL_MANAGER_CAP_FLAGS of ArduPilot's"""
DEVICE = 1
EVERY_US = 20_000
STEEP = math.radians(85.0)
"""Beyond this pitch, roll and yaw turn about nearly the same axis."""
SENDER = -2.0
"""DO_GIMBAL_MANAGER_CONFIGURE: who sends it."""
STICK_ROLL, STICK_PITCH, STICK_YAW = 212, 213, 214
"""RCn_OPTION"""
FUNCTIONS = {"ROLL": payload.MOUNT_ROLL, "PITCH": payload.MOUNT_PITCH, "YAW": payload.MOUNT_YAW}


class State(NamedTuple):
    """What it is to do; angles [rad], yaw from the nose or, with ``is_locked``, from north."""

    mode: int = STICKS
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    is_locked: bool = False
    pitch_rate: float = 0.0
    """[rad/s]"""
    yaw_rate: float = 0.0
    location: tuple[int, int, float] | None = None
    """To point at: latitude, longitude [degE7], m above sea level."""
    locks_sticks: bool = False
    """Function 163: the sticks' yaw is from north."""
    owner: tuple[int, int] = (0, 0)
    """System and component that have primary control."""


class MountService(PayloadService):
    """The gimbal."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._there = self._value("MNT1_TYPE") == payload.BY_SERVO
        self._fitted = {axis: self._is_fitted(function) for axis, function in FUNCTIONS.items()}
        self._state = State(mode=int(self._value("MNT1_DEFLT_MODE", STICKS)))
        self._angles = Euler(0.0, 0.0, 0.0)
        if self._there:
            self.due_us = 0

    def snapshot(self) -> Any:
        return (tuple(self._state), tuple(self._angles), self.due_us)

    def restore(self, state: Any) -> None:
        found, angles, self.due_us = state
        self._state, self._angles = State(*found), Euler(*angles)

    @property
    def turns_by_itself(self) -> bool:
        """Whether it has a yaw axis: then the vehicle need not turn its nose to a region of interest."""
        return self._there and self._fitted["YAW"]

    # ------------------------------------------------------------------ what it reports

    def messages(self) -> dict[str, Callable[[], bytes]]:
        if not self._there:
            return {}
        return {ATTITUDE_STATUS.name: self.attitude, INFORMATION.name: self.information, STATUS.name: self.status}

    def _flags(self) -> int:
        state = self._state
        flags = ROLL_LOCK | PITCH_LOCK
        return flags | {FOLDED: IS_RETRACTED, NEUTRAL: IS_NEUTRAL}.get(state.mode, 0)

    def _is_locked(self) -> bool:
        state = self._state
        if state.mode == STICKS:
            return state.locks_sticks
        return state.mode in (GPS_POINT, HOME) or (state.mode in (ANGLES, RATES) and state.is_locked)

    def attitude(self) -> bytes:
        """GIMBAL_DEVICE_ATTITUDE_STATUS: the angles of the outputs, from the vehicle; with MNT1_TYPE at boot."""
        q, unknown = quat_from_euler(self._angles), math.nan
        flags = self._flags() | YAW_IN_VEHICLE_FRAME | (YAW_LOCK if self._is_locked() else 0)
        return ATTITUDE_STATUS.payload(
            time_boot_ms=self.bridge.now_us // 1000, q=(q.w, q.x, q.y, q.z), flags=flags,
            angular_velocity_x=unknown, angular_velocity_y=unknown, angular_velocity_z=unknown,
            delta_yaw=unknown, delta_yaw_velocity=unknown, gimbal_device_id=DEVICE,
        )  # fmt: skip

    def information(self) -> bytes:
        """GIMBAL_MANAGER_INFORMATION: limits [rad]; with MNT1_TYPE at boot."""
        limits = {f"{a.lower()}_{e.lower()}": self._limit(a, e) for a in FUNCTIONS for e in ("MIN", "MAX")}
        time_ms = self.bridge.now_us // 1000
        return INFORMATION.payload(time_boot_ms=time_ms, cap_flags=CAPABILITIES, gimbal_device_id=DEVICE, **limits)

    def status(self) -> bytes:
        """GIMBAL_MANAGER_STATUS: who has control; with MNT1_TYPE at boot."""
        system, component = self._state.owner
        return STATUS.payload(
            time_boot_ms=self.bridge.now_us // 1000, flags=self._flags(), gimbal_device_id=DEVICE,
            primary_control_sysid=system, primary_control_compid=component,
        )  # fmt: skip

    def _limit(self, axis: str, end: str) -> float:
        return math.radians(self._values[f"MNT1_{axis}_{end}"])

    # ------------------------------------------------------------------ what it is asked

    def carry_out(self, item: MissionItem) -> None:
        """A mission's command about the gimbal, or about a region of interest."""
        if item.command == MavCmd.DO_MOUNT_CONTROL:
            self.control(item.p1, item.p2, item.p3, ANGLES)
        elif item.command == MavCmd.DO_GIMBAL_MANAGER_PITCHYAW:
            self.pitch_yaw(item.p1, item.p2, item.p3, item.p4, item.x, item.z)
        elif item.command == MavCmd.DO_SET_ROI_NONE or (item.no_location and item.z == 0.0):
            self.look_ahead()
        else:
            ap = self.bridge.vehicle.v.autopilot
            position = self.bridge.locations.ned(item.x, item.y, item.z, item.frame)
            if position is not None:
                self.look_at(item.x, item.y, float(ap.estimate.origin_alt) - position[2])
        if self.turns_by_itself and item.command in commands.ROI_COMMANDS:
            self.bridge.autopilot.set_roi(None)

    def control(self, pitch: float, roll: float, yaw: float, mode: float) -> int:
        """DO_MOUNT_CONTROL: angles [deg] (yaw from the nose) and MAV_MOUNT_MODE. Its MAV_RESULT."""
        if not self._there or mode not in (FOLDED, NEUTRAL, ANGLES, STICKS, GPS_POINT, HOME):
            return MavResult.FAILED
        state = self._state._replace(mode=int(mode))
        if mode == ANGLES:
            if not all(map(math.isfinite, (pitch, roll, yaw))):
                return MavResult.FAILED
            state = state._replace(
                roll=math.radians(roll), pitch=math.radians(pitch), yaw=wrap_pi(math.radians(yaw)), is_locked=False
            )
        self._state = state
        return MavResult.ACCEPTED

    def configure(self, mode: float) -> int:
        """DO_MOUNT_CONFIGURE: MAV_MOUNT_MODE, with the angles of before. Its MAV_RESULT."""
        if not self._there or mode not in (FOLDED, NEUTRAL, ANGLES, STICKS, GPS_POINT, HOME):
            return MavResult.FAILED
        self._state = self._state._replace(mode=int(mode))
        return MavResult.ACCEPTED

    def pitch_yaw(
        self, pitch: float, yaw: float, pitch_rate: float, yaw_rate: float, flags: float, device: float
    ) -> int:
        """DO_GIMBAL_MANAGER_PITCHYAW: angles [deg], or rates [deg/s] where angles are NaN. Its MAV_RESULT."""
        if not self._there or device not in (0.0, DEVICE) or not 0.0 <= flags < 2.0**31:
            return MavResult.FAILED
        bits, state = int(flags), self._state
        if bits & (IS_RETRACTED | IS_NEUTRAL):
            self._state = state._replace(mode=FOLDED if bits & IS_RETRACTED else NEUTRAL)
            return MavResult.ACCEPTED
        is_locked = bits & YAW_LOCK != 0
        if math.isfinite(pitch) and math.isfinite(yaw):
            self._state = state._replace(
                mode=ANGLES, roll=0.0, pitch=math.radians(pitch), yaw=wrap_pi(math.radians(yaw)), is_locked=is_locked
            )
        elif math.isfinite(pitch_rate) and math.isfinite(yaw_rate):
            heading = self._heading() if is_locked else 0.0
            self._state = state._replace(
                mode=RATES, roll=0.0, pitch=self._angles.pitch, yaw=wrap_pi(self._angles.yaw + heading),
                is_locked=is_locked, pitch_rate=math.radians(pitch_rate), yaw_rate=math.radians(yaw_rate),
            )  # fmt: skip
        else:
            return MavResult.FAILED
        return MavResult.ACCEPTED

    def give_control(self, system: float, component: float, sender: Sender) -> int:
        """DO_GIMBAL_MANAGER_CONFIGURE: who has primary control. Its MAV_RESULT."""
        if not self._there:
            return MavResult.FAILED
        owner = sender if system == SENDER else (int(system), int(component))
        if not all(0 <= x <= 255 for x in owner):
            return MavResult.FAILED
        self._state = self._state._replace(owner=owner)
        self.bridge.send_to_all(STATUS.id)
        return MavResult.ACCEPTED

    def look_at(self, lat: int, lon: int, alt: float) -> None:
        """Point at a location [degE7, m above sea level]."""
        self._state = self._state._replace(mode=GPS_POINT, location=(lat, lon, alt))

    def look_ahead(self) -> None:
        """MNT1_DEFLT_MODE again."""
        self._state = self._state._replace(mode=int(self._value("MNT1_DEFLT_MODE", STICKS)))

    def fold(self, position: int) -> None:
        """Function 27 of a switch: high folds it; else MNT1_DEFLT_MODE."""
        if position == HIGH:
            self._state = self._state._replace(mode=FOLDED)
        else:
            self.look_ahead()

    def lock(self, position: int) -> None:
        """Function 163 of a switch: high keeps the sticks' yaw from north, else from the nose."""
        self._state = self._state._replace(locks_sticks=position == HIGH)

    # ------------------------------------------------------------------ what it does

    def service(self, now_us: int) -> None:
        self.due_us = now_us + EVERY_US
        mode = self._state.mode
        if mode in (FOLDED, NEUTRAL):
            stance = "RETRACT" if mode == FOLDED else "NEUTRAL"
            roll, pitch, yaw = (math.radians(self._values[f"MNT1_{stance}_{axis}"]) for axis in "XYZ")
        else:
            self._aim()
            roll, pitch, yaw = self._from_vehicle()
        self._angles = Euler(self._turn("ROLL", roll), self._turn("PITCH", pitch), self._turn("YAW", yaw))

    def _turn(self, axis: str, angle: float) -> float:
        """Send an angle to the outputs of an axis; what they can do of it. 0 without outputs."""
        if not self._fitted[axis]:
            return 0.0
        least, most = self._limit(axis, "MIN"), self._limit(axis, "MAX")
        angle = min(max(angle, least), most)
        tenths, first, last = (_tenths(x) for x in (angle, least, most))
        self._send_share(FUNCTIONS[axis], (tenths - first) / (last - first) if last > first else 0.5)
        return angle

    def _heading(self) -> float:
        return float(self.bridge.vehicle.v.autopilot.estimate.yaw)

    def _aim(self) -> None:
        """The target's angles now."""
        state, dt = self._state, EVERY_US * 1e-6
        if state.mode == STICKS:
            self._follow_sticks(dt)
        elif state.mode == RATES:
            pitch = state.pitch + state.pitch_rate * dt
            pitch = min(max(pitch, self._limit("PITCH", "MIN")), self._limit("PITCH", "MAX"))
            self._state = state._replace(pitch=pitch, yaw=wrap_pi(state.yaw + state.yaw_rate * dt))
        elif state.mode in (GPS_POINT, HOME):
            to = self._target()
            if to is not None:
                pitch = atan2(-to.z, hypot(to.x, to.y))
                self._state = state._replace(roll=0.0, pitch=pitch, yaw=atan2(to.y, to.x))

    def _target(self) -> Vec3 | None:
        """From the vehicle to what it points at, NED [m]."""
        ap, location = self.bridge.vehicle.v.autopilot, self._state.location
        if self._state.mode == HOME:
            return Vec3(*(a - b for a, b in zip(ap.home.pos, ap.estimate.pos, strict=True)))
        found = None if location is None else self.bridge.locations.ned(*location, 0)
        return None if found is None else Vec3(*(a - b for a, b in zip(found, ap.estimate.pos, strict=True)))

    def _follow_sticks(self, dt: float) -> None:
        state, rate = self._state, math.radians(self._values["MNT1_RC_RATE"])
        angles = []
        for axis, option, now in (("ROLL", STICK_ROLL, state.roll), ("PITCH", STICK_PITCH, state.pitch),
                                  ("YAW", STICK_YAW, state.yaw)):  # fmt: skip
            least, most, stick = self._limit(axis, "MIN"), self._limit(axis, "MAX"), self._stick(option)
            wanted = now + stick * rate * dt if rate > 0.0 else 0.5 * (least + most + stick * (most - least))
            angles.append(min(max(wanted, least), most))
        self._state = state._replace(roll=angles[0], pitch=angles[1], yaw=angles[2])

    def _stick(self, option: int) -> float:
        """Where a stick is, -1 to 1."""
        rc = self.bridge.vehicle.v.autopilot.rc
        for n in range(1, payload.OUTPUTS + 1):
            if self._values[f"RC{n}_OPTION"] == option:
                pulse, least, trim, most = int(rc.channels[n - 1]), *(
                    self._values[f"RC{n}_{name}"] for name in ("MIN", "TRIM", "MAX")
                )  # fmt: skip
                if pulse == 0:
                    return 0.0
                span = most - trim if pulse > trim else trim - least
                share = (pulse - trim) / span if span > 0.0 else 0.0
                return min(max(-share if self._values[f"RC{n}_REVERSED"] else share, -1.0), 1.0)
        return 0.0

    def _from_vehicle(self) -> Euler:
        """The target's angles for axes that are fixed to the vehicle."""
        state, vehicle = self._state, self.bridge.vehicle.v.autopilot.estimate.euler
        yaw = wrap_pi(state.yaw - vehicle.yaw) if self._is_locked() else state.yaw
        turned = yaw if self._fitted["YAW"] else 0.0
        base = multiply(
            quat_from_euler(Euler(vehicle.roll, vehicle.pitch, 0.0)), quat_from_euler(Euler(0.0, 0.0, turned))
        )
        pitch = min(max(state.pitch, self._limit("PITCH", "MIN")), self._limit("PITCH", "MAX"))
        wanted = quat_from_euler(Euler(state.roll, pitch, turned))
        rest = euler_of(multiply(conjugate(base), wanted))
        roll = state.roll if abs(rest.pitch) > STEEP else rest.roll
        return Euler(roll, rest.pitch, yaw)


def _tenths(angle: float) -> int:
    """An angle [rad] in whole tenths of a degree, which is what ArduPilot gives its outputs."""
    return int(round(math.degrees(angle) * 10.0, 6))
