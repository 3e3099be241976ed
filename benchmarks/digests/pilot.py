# SPDX-License-Identifier: BSD-3-Clause
"""A MAVLink client in the vehicle's process, by pymavlink: what it sends does not depend on the tree under test."""

from __future__ import annotations

import hashlib
import struct
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.core.mavlink import MavCmd

from . import tree
from .leaves import leaves
from .tape import Tape

STEP_US = 100_000
CHECKPOINT_US = 4_000_000
"""Simulated time between two looks at the record [us]."""
CLIENT = 255
"""System id of the client."""
STREAMED = (
    "ATTITUDE_QUATERNION", "ATTITUDE_TARGET", "DEBUG_FLOAT_ARRAY", "DISTANCE_SENSOR", "EXTENDED_SYS_STATE",
    "GPS_GLOBAL_ORIGIN", "HIGHRES_IMU", "HOME_POSITION", "OBSTACLE_DISTANCE", "POSITION_TARGET_LOCAL_NED",
    "POSITION_TARGET_GLOBAL_INT", "SCALED_IMU", "EKF_STATUS_REPORT", "SYS_STATUS",
)  # fmt: skip
"""Sent at 2 Hz, besides all stream groups at 4 Hz."""
MODES = {
    "copter": {
        "STABILIZE": 0, "ACRO": 1, "ALT_HOLD": 2, "AUTO": 3, "GUIDED": 4, "LOITER": 5, "RTL": 6, "CIRCLE": 7, "LAND": 9,
        "DRIFT": 11, "FLIP": 14, "AUTOTUNE": 15, "POSHOLD": 16, "BRAKE": 17, "THROW": 18, "AVOID_ADSB": 19,
        "GUIDED_NOGPS": 20, "SMART_RTL": 21, "FLOWHOLD": 22, "FOLLOW": 23, "ZIGZAG": 24,
        "SYSTEMID": 25, "AUTO_RTL": 27, "TURTLE": 28,
    },
    "rover": {
        "MANUAL": 0, "ACRO": 1, "STEERING": 3, "HOLD": 4, "LOITER": 5, "FOLLOW": 6, "SIMPLE": 7, "DOCK": 8, "CIRCLE": 9,
        "AUTO": 10, "RTL": 11, "SMART_RTL": 12, "GUIDED": 15,
    },
}  # fmt: skip
DRAWN = {
    "copter": ("STABILIZE", "ALT_HOLD", "AUTO", "GUIDED", "LOITER", "RTL", "LAND", "BRAKE"),
    "rover": ("MANUAL", "ACRO", "STEERING", "HOLD", "LOITER", "SIMPLE", "CIRCLE", "AUTO", "RTL", "SMART_RTL", "GUIDED"),
}
"""Modes of random flights; a new mode is not added, so that the flights stay those of older versions."""
KINDS = {message.msgname: message for message in mavlink.mavlink_map.values()}


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
    """Commands one vehicle, and takes the digests of its flight.

    Args:
        frame: airframe.
        kind: "copter" or "rover".
        log: whether the flight's logs are digested, too.
        options: of ``Simulation``.
    """

    on_step: Callable[..., None] | None = None
    """Called with the simulated time [us] after each step of 0.1 s."""

    def __init__(self, frame: str, kind: str, log: bool = False, **options: Any) -> None:
        self.kind = kind
        self.sent, self.record = Tape(), Tape()
        self.simulation = tree.locate("Simulation", "sitl.simulation")(frame, **options)
        self._folder = tempfile.TemporaryDirectory(prefix="digests-") if log else None
        if self._folder is not None:
            tree.locate("open_log", "sitl.run.runner")(self.simulation, Path(self._folder.name), "flight")
        self.link = tree.connect(self.simulation, self)
        self.mav = mavlink.MAVLink(self, srcSystem=CLIENT, srcComponent=190)
        self.sticks: tuple[int, ...] = ()
        self.items: Sequence[Item] = ()
        self.knows_terrain = False
        """Whether it answers requests for heights of terrain: 0 m everywhere."""
        self._checkpoint_us = 0
        self._listen()

    def _listen(self) -> None:
        """Ask for telemetry, and forget what was heard."""
        self.heard: dict[str, Any] = {}
        """Name -> last message of it."""
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
        kind = mavlink.mavlink_map.get(int.from_bytes(raw[7:10], "little"))
        name = kind.msgname if kind is not None else "unknown"
        self.sent.add(time_us // 1_000_000, name, struct.pack("<q", time_us) + bytes(raw))
        self.heard[name] = raw
        if name in ("MISSION_REQUEST", "MISSION_REQUEST_INT"):
            self._send_item(self.last(name, "seq"))
        if name == "TERRAIN_REQUEST" and self.knows_terrain:
            self._send_terrain()

    def last(self, name: str, field: str) -> Any:
        """A field of the last message of a name; 0 before the first."""
        return getattr(self.mav.decode(bytearray(self.heard[name])), field) if name in self.heard else 0

    @property
    def armed(self) -> bool:
        """Whether it is armed, by the last HEARTBEAT."""
        return bool(self.last("HEARTBEAT", "base_mode") & 128)

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

    def set_mode(self, name: str, wait: float = 0.1) -> None:
        """Ask for a mode."""
        self.command(MavCmd.DO_SET_MODE, 1, MODES[self.kind][name])
        self.fly(wait)

    def set_parameter(self, name: str, value: float) -> None:
        """PARAM_SET."""
        self.send("PARAM_SET", param_id=name.encode(), param_value=value, param_type=9)
        self.fly(0.1)

    def hold(self, *pulses: int, seconds: float = 0.0) -> None:
        """Hold the sticks from now on: channels from 1 on [us]; nothing: send none any more."""
        self.sticks = pulses
        self.fly(seconds)

    def stream(self, seconds: float, mask: int, frame: int = 1, **fields: float) -> None:
        """SET_POSITION_TARGET_LOCAL_NED at 10 Hz."""
        for _ in range(round(10 * seconds)):
            self.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=frame, type_mask=mask, **fields)
            self.fly(0.1)

    def _send_item(self, seq: int) -> None:
        fields = self.items[seq]._asdict()
        params = {f"param{k}": fields.pop(f"p{k}") for k in range(1, 5)}
        self.send("MISSION_ITEM_INT", seq=seq, **params, **fields)

    def _send_terrain(self) -> None:
        fields = {each: self.last("TERRAIN_REQUEST", each) for each in ("lat", "lon", "grid_spacing")}
        mask = int(self.last("TERRAIN_REQUEST", "mask"))
        for bit in range(56):
            if mask >> bit & 1:
                self.send("TERRAIN_DATA", gridbit=bit, data=[0] * 16, **fields)

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
        dtype, record = tree.record(self.simulation)
        for leaf in leaves(dtype):
            self.record.add(self.now, leaf.path, leaf.wide(record))
        self._checkpoint_us = self.simulation.time_us + CHECKPOINT_US

    def need(self, condition: bool, what: str) -> None:
        """ScriptError unless the condition holds."""
        if not condition:
            raise ScriptError(f"at {self.now:.1f} s: {what}; last text {self.last('STATUSTEXT', 'text')!r}")

    # ------------------------------------------------------------------ what scripts begin and end with

    def boot(self) -> None:
        """Wait until it can be armed, in GUIDED."""

        def ready() -> bool:
            located = self.last("EKF_STATUS_REPORT", "flags") & 0x11 == 0x11
            return located and bool(self.last("SYS_STATUS", "onboard_control_sensors_health") & 0x10000000)

        self.need(self.fly(90.0, ready), "not ready to be armed")
        self.set_mode("GUIDED")

    def arm(self) -> None:
        """Arm."""
        self.command(MavCmd.COMPONENT_ARM_DISARM, 1)
        self.need(self.fly(2.0, lambda: self.armed), f"not armed: result {self.last('COMMAND_ACK', 'result')}")

    def set_out(self, height: float = 10.0) -> None:
        """Boot and arm; a copter takes off."""
        self.boot()
        self.arm()
        if self.kind == "copter":
            self.command(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height)
            self.fly(6.0 + height)

    def come_to_rest(self) -> None:
        """A copter lands, a rover stops."""
        if self.kind == "copter":
            self.hold(*((1500,) * 4 if self.sticks else ()))
            self.set_mode("LAND")
            self.fly(40.0, lambda: not self.armed)
            self.fly(1.0)
        else:
            self.hold()
            self.set_mode("HOLD", 3.0)

    def reboot(self) -> None:
        """Reboot, and boot again."""
        self.command(MavCmd.PREFLIGHT_REBOOT_SHUTDOWN, 1)
        self.fly(0.5)
        self._listen()
        self.boot()

    def upload(self, items: Sequence[Item], or_refused: bool = False) -> None:
        """Upload a mission, home first."""
        self.items = items
        self.heard.pop("MISSION_ACK", None)
        self.send("MISSION_COUNT", count=len(items))
        self.need(self.fly(30.0, lambda: "MISSION_ACK" in self.heard), "no MISSION_ACK")
        answer = self.last("MISSION_ACK", "type")
        self.need(answer == 0 or or_refused, f"MISSION_ACK {answer}")

    def fly_mission(self, items: Sequence[Item], limit: float = 500.0) -> None:
        """Upload, arm, fly until disarmed, or until the mission is complete."""
        self.upload(items)
        self.arm()
        self.set_mode("AUTO")
        if self.kind == "copter":
            self.command(MavCmd.MISSION_START)
        is_rover = self.kind == "rover"
        self.fly(limit, lambda: not self.armed or (is_rover and self.last("MISSION_CURRENT", "mission_state") == 5))
        self.fly(5.0)

    def result(self) -> dict[str, Any]:
        """The digests of the flight, up to now; the flight is over."""
        self.look()
        self.simulation.close()
        digests = {"end": self.now, "telemetry": self.sent.result(), "record": self.record.result()}
        if self._folder is not None:
            files = sorted(Path(self._folder.name).iterdir())
            digests["files"] = {file.suffix: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
            self._folder.cleanup()
        return digests
