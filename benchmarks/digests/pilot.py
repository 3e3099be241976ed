# SPDX-License-Identifier: BSD-3-Clause
"""A MAVLink client in the vehicle's process, by pymavlink: what it sends does not depend on the tree under test."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from . import tree
from .tape import CHECKPOINT_US, Record, Series

STEP_US = 100_000
CLIENT = 255
"""System id of the client."""
STREAMED = (
    "ATTITUDE_QUATERNION", "ATTITUDE_TARGET", "DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR", "EXTENDED_SYS_STATE",
    "GPS_GLOBAL_ORIGIN", "HIGHRES_IMU", "HOME_POSITION", "OBSTACLE_DISTANCE", "POSITION_TARGET_LOCAL_NED",
    "POSITION_TARGET_GLOBAL_INT", "SCALED_IMU", "EKF_STATUS_REPORT", "SYS_STATUS",
)  # fmt: skip
"""Sent at 2 Hz, besides all stream groups at 4 Hz."""
ARM, SET_MODE, TAKEOFF, START, REBOOT = 400, 176, 22, 300, 246
MODES = {
    "copter": {"STABILIZE": 0, "ALT_HOLD": 2, "AUTO": 3, "GUIDED": 4, "LOITER": 5, "RTL": 6, "LAND": 9, "BRAKE": 17},
    "rover": {
        "MANUAL": 0, "ACRO": 1, "STEERING": 3, "HOLD": 4, "LOITER": 5, "SIMPLE": 7, "CIRCLE": 9, "AUTO": 10,
        "RTL": 11, "SMART_RTL": 12, "GUIDED": 15,
    },
}  # fmt: skip
KINDS = {message.msgname: message for message in mavlink.mavlink_map.values()}
HEARD = {KINDS[name].id for name in (
    "HEARTBEAT", "SYS_STATUS", "EKF_STATUS_REPORT", "COMMAND_ACK", "MISSION_REQUEST", "MISSION_REQUEST_INT",
    "MISSION_ACK", "MISSION_CURRENT", "STATUSTEXT",
)}  # fmt: skip


class ScriptError(RuntimeError):
    """A vehicle did not do what the script of its flight needs."""


class Item(NamedTuple):
    """A mission item; a place in degE7."""

    command: int
    x: int = 0
    y: int = 0
    z: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    p3: float = 0.0
    p4: float = 0.0
    frame: int = 3
    autocontinue: int = 1


class Pilot:
    """Commands one vehicle, and takes the digests of its flight."""

    on_step: Callable[..., None] | None = None
    """Called with the simulated time [us] after each step of 0.1 s."""

    def __init__(self, frame: str, kind: str = "copter", **options: Any) -> None:
        self.kind = kind
        self.sent, self.record = Series(), Record()
        self.simulation = tree.simulation(frame, **options)
        self.link = tree.connect(self.simulation, self)
        self.mav = mavlink.MAVLink(self, srcSystem=CLIENT, srcComponent=190)
        self.sticks: tuple[int, ...] = ()
        self.items: Sequence[Item] = ()
        self.texts: list[str] = []
        self._checkpoint_us = 0
        self._restart()

    def _restart(self) -> None:
        self.armed = self.is_located = self.is_checked = False
        self.acks: dict[int, int] = {}
        self.answer: int | None = None
        self.mission_state = 0
        self.send("REQUEST_DATA_STREAM", req_stream_id=0, req_message_rate=4, start_stop=1)
        for name in STREAMED:
            self.command(511, KINDS[name].id, 500_000)

    # ------------------------------------------------------------------ what comes in

    def write(self, data: bytes) -> None:
        """pymavlink's way to send."""
        self.link.send(bytes(data))

    def frame(self, time_us: int, raw: bytes) -> None:
        """A frame in or out: into the digest what the vehicle sent."""
        if raw[0] != 0xFD:
            raise ScriptError(f"a frame that is not MAVLink 2: {raw.hex()}")
        if raw[5] == CLIENT:
            return
        number = raw[7] | raw[8] << 8 | raw[9] << 16
        kind = mavlink.mavlink_map.get(number)
        name = kind.msgname if kind is not None else f"message {number}"
        self.sent.add(name, time_us // 1_000_000, struct.pack("<q", time_us) + bytes(raw))
        if number in HEARD:
            self._hear(name, self.mav.decode(bytearray(raw)))

    def _hear(self, name: str, message: Any) -> None:
        if name == "HEARTBEAT":
            self.armed = bool(message.base_mode & 128)
        elif name == "EKF_STATUS_REPORT":
            self.is_located = message.flags & 0x11 == 0x11
        elif name == "SYS_STATUS":
            self.is_checked = bool(message.onboard_control_sensors_health & 0x10000000)
        elif name == "COMMAND_ACK":
            self.acks[message.command] = message.result
        elif name == "MISSION_ACK":
            self.answer = message.type
        elif name == "MISSION_CURRENT":
            self.mission_state = message.mission_state
        elif name == "STATUSTEXT":
            self.texts.append(message.text)
        else:
            self._send_item(message.seq)

    # ------------------------------------------------------------------ what goes out

    def send(self, name: str, **fields: Any) -> None:
        """One message; fields not given are zero."""
        kind = KINDS[name]
        lengths = dict(zip(kind.ordered_fieldnames, kind.array_lengths))
        types = dict(zip(kind.fieldnames, kind.fieldtypes))
        blank = {f: b"" if types[f] == "char" else [0] * lengths[f] if lengths[f] else 0 for f in kind.fieldnames}
        blank |= {f: 1 for f in ("target_system", "target_component") if f in blank}
        self.mav.send(kind(**(blank | fields)))

    def command(self, number: int, *params: float) -> None:
        """COMMAND_LONG."""
        self.send("COMMAND_LONG", command=number, **{f"param{k + 1}": p for k, p in enumerate(params)})

    def command_int(self, number: int, *params: float, x: int, y: int, z: float, frame: int = 3) -> None:
        """COMMAND_INT."""
        values = {f"param{k + 1}": p for k, p in enumerate(params)}
        self.send("COMMAND_INT", command=number, frame=frame, x=x, y=y, z=z, **values)

    def set_mode(self, name: str, wait: float = 0.1) -> None:
        """Ask for a mode."""
        self.command(SET_MODE, 1, MODES[self.kind][name])
        self.fly(wait)

    def set_parameter(self, name: str, value: float) -> None:
        """PARAM_SET."""
        self.send("PARAM_SET", param_id=name.encode(), param_value=value, param_type=9)
        self.fly(0.1)

    def hold(self, *pulses: int) -> None:
        """Hold the sticks from now on: channels from 1 on [us]; nothing: send none any more."""
        self.sticks = pulses

    def target(self, mask: int, frame: int = 1, **fields: float) -> None:
        """SET_POSITION_TARGET_LOCAL_NED."""
        self.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=frame, type_mask=mask, **fields)

    def stream(self, seconds: float, mask: int, frame: int = 1, **fields: float) -> None:
        """The same at 10 Hz."""
        for _ in range(round(10 * seconds)):
            self.target(mask, frame, **fields)
            self.fly(0.1)

    # ------------------------------------------------------------------ time

    @property
    def now(self) -> float:
        """Simulated time [s]."""
        return float(self.simulation.time_us) * 1e-6

    def fly(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass, in steps of 0.1 s, until the condition holds; whether it came to hold."""
        for _ in range(round(seconds * 10)):
            if self.sticks:
                channels = {f"chan{k + 1}_raw": 65535 for k in range(8)}
                channels |= {f"chan{k + 1}_raw": pulse for k, pulse in enumerate(self.sticks)}
                self.send("RC_CHANNELS_OVERRIDE", **channels)
            self.simulation.advance_to(self.simulation.time_us // STEP_US * STEP_US + STEP_US)
            self.link.receive()
            if self.on_step is not None:
                self.on_step(self.simulation.time_us)
            if self.simulation.time_us >= self._checkpoint_us:
                self.look()
            if until():
                return True
        return False

    def look(self) -> None:
        """Take the digest of the record now."""
        now = self.simulation.time_us
        self.record.look(now, *tree.record(self.simulation))
        self._checkpoint_us = now + CHECKPOINT_US

    def need(self, condition: bool, what: str) -> None:
        """ScriptError unless the condition holds."""
        if not condition:
            raise ScriptError(f"at {self.now:.1f} s: {what}; texts {self.texts[-4:]}")

    # ------------------------------------------------------------------ what scripts begin and end with

    def boot(self) -> None:
        """Wait until it can be armed, in GUIDED."""
        self.need(self.fly(90.0, lambda: self.is_located and self.is_checked), "not ready to be armed")
        self.set_mode("GUIDED")

    def arm(self) -> None:
        """Arm."""
        self.acks.clear()
        self.command(ARM, 1)
        self.need(self.fly(2.0, lambda: self.acks.get(ARM) == 0), f"not armed: {self.acks}")

    def hover(self, height: float = 10.0) -> None:
        """Boot, arm, take off."""
        self.boot()
        self.arm()
        self.command(TAKEOFF, 0, 0, 0, 0, 0, 0, height)
        self.fly(6.0 + height)

    def reboot(self) -> None:
        """Reboot, and boot again."""
        self.command(REBOOT, 1)
        self.fly(0.5)
        self._restart()
        self.boot()

    def upload(self, items: Sequence[Item], or_refused: bool = False) -> None:
        """Upload a mission, home first."""
        self.items, self.answer = items, None
        self.send("MISSION_COUNT", count=len(items))
        self.need(self.fly(30.0, lambda: self.answer is not None), "no MISSION_ACK")
        self.need(self.answer == 0 or or_refused, f"MISSION_ACK {self.answer}")

    def _send_item(self, seq: int) -> None:
        item = self.items[seq]
        self.send(
            "MISSION_ITEM_INT", seq=seq, frame=item.frame, command=item.command, autocontinue=item.autocontinue,
            param1=item.p1, param2=item.p2, param3=item.p3, param4=item.p4, x=item.x, y=item.y, z=item.z,
        )  # fmt: skip

    def fly_mission(self, items: Sequence[Item], limit: float = 500.0) -> None:
        """Upload, arm, fly until disarmed, or until the mission is complete."""
        self.upload(items)
        self.arm()
        self.set_mode("AUTO")
        if self.kind == "copter":
            self.command(START)
        self.fly(limit, lambda: not self.armed or (self.kind == "rover" and self.mission_state == 5))
        self.fly(5.0)

    def result(self) -> dict[str, Any]:
        """The digests of the flight, up to now; the flight is over."""
        self.look()
        self.simulation.close()
        return {"end_us": self.simulation.time_us, "telemetry": self.sent.result(), "record": self.record.result()}
