# SPDX-License-Identifier: BSD-3-Clause
"""A ground station in the vehicle's own process: uploads a mission, arms, starts it, all by MAVLink bytes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import RESULT_NAMES
from sitl.bridge.client import Client
from sitl.simulation import Simulation

from .pilot import ARM, MISSION_START, PREARM_BIT, SET_MODE

STEP_US = 100_000
"""It looks ten times a second."""
READY_BITS = 0x10 | 0x01
"""EKF_STATUS_REPORT: attitude, absolute position."""
_ANSWER_S = 3.0
_SEVERE = 4
"""MAV_SEVERITY_WARNING: what is this grave may be a reason."""


class StationError(RuntimeError):
    """The vehicle did not do what it was asked to; says what and why."""


class Station:
    """Commands one vehicle, and keeps what it says.

    Args:
        simulation: the vehicle.
        advance: lets simulated time pass until a time [us]; it may wait for the wall clock.
        on_step: called after each step of a tenth of a second.
    """

    def __init__(
        self,
        simulation: Simulation,
        advance: Callable[[int], object] | None = None,
        on_step: Callable[[], None] = lambda: None,
    ) -> None:
        self.simulation = simulation
        self.client = Client()
        simulation.bridge.add_link(self.client.link)
        self.target = simulation.bridge.system
        self.on_step = on_step
        self.texts: list[tuple[float, int, str]] = []
        """(time [s], severity, text) of status texts."""
        self.reached: list[tuple[float, int]] = []
        """(time [s], item) of each MISSION_ITEM_REACHED."""
        self._advance = advance or simulation.advance_to
        self._acks: dict[int, int] = {}
        self._ekf = self._checked = False
        self._upload: Sequence[MissionItem] = ()
        self._upload_result: int | None = None

    @property
    def now(self) -> float:
        """Simulated time [s]."""
        return self.simulation.time_us * 1e-6

    @property
    def armed(self) -> bool:
        """Whether the vehicle is armed at this moment."""
        return bool(self.simulation.v.autopilot.arming.armed)

    @property
    def mode(self) -> str:
        """The vehicle's mode at this moment."""
        return self.simulation.firmware.mode_names[int(self.simulation.v.autopilot.modes.number)]

    def step(self) -> None:
        """Let a tenth of a second pass, and hear what the vehicle said."""
        until = self.simulation.time_us // STEP_US * STEP_US + STEP_US
        while self.simulation.time_us < until:
            self._advance(until)
        for name, fields in self.client.receive():
            self._take(name, fields)
        self.on_step()

    def wait(self, seconds: float, until: Callable[[], bool]) -> bool:
        """Let up to so many seconds pass; whether the condition came to hold."""
        stop = self.simulation.time_us + round(seconds * 1e6)
        while not until():
            if self.simulation.time_us >= stop:
                return False
            self.step()
        return True

    def why(self, since: float = 0.0) -> str:
        """The last two things that the vehicle said that sound like reasons; "" when it said nothing of the kind."""
        severe = [text for time, severity, text in self.texts if severity <= _SEVERE and time >= since]
        return ": " + "; ".join(severe[-2:]) if severe else ""

    # ------------------------------------------------------------------ what it does

    def wait_ready(self, seconds: float) -> None:
        """Until the vehicle has a position and its pre-arm checks are good."""
        for name in ("EKF_STATUS_REPORT", "SYS_STATUS"):
            self.client.set_interval(name, 5.0)
        if not self.wait(seconds, lambda: self._ekf and self._checked):
            raise StationError(f"not ready to arm after {self.now:.0f} s{self.why()}")
        for name in ("EKF_STATUS_REPORT", "SYS_STATUS"):
            self.client.set_interval(name, 0.0)

    def upload(self, items: Sequence[MissionItem]) -> None:
        """Send a mission, home first, by the mission protocol."""
        self._upload, self._upload_result = items, None
        self._send("MISSION_COUNT", count=len(items))
        if not self.wait(10.0 + 0.2 * len(items), lambda: self._upload_result is not None):
            raise StationError("the mission could not be uploaded: no MISSION_ACK")
        if self._upload_result:
            reason = RESULT_NAMES.get(self._upload_result, f"MAV_MISSION_RESULT {self._upload_result}")
            raise StationError(f"the mission was refused: {reason}{self.why()}")

    def choose_mode(self, name: str) -> None:
        """Change to a mode."""
        numbers = {mode: number for number, mode in self.simulation.firmware.mode_names.items()}
        self.command(SET_MODE, f"mode {name}", 1, numbers[name])

    def arm(self) -> None:
        """Arm."""
        self.command(ARM, "arming", 1)

    def disarm(self) -> None:
        """Disarm."""
        self.command(ARM, "disarming", 0)

    def start_mission(self) -> None:
        """MISSION_START, in AUTO."""
        self.command(MISSION_START, "the start of the mission", 0, 0)

    def command(self, number: int, name: str, *params: float) -> None:
        """A command that must be accepted."""
        self._acks.pop(number, None)
        asked = self.now
        self.client.command(number, *params, target=self.target)
        if not self.wait(_ANSWER_S, lambda: number in self._acks):
            raise StationError(f"{name} was not answered")
        if self._acks[number] != 0:
            raise StationError(f"{name} was refused (MAV_RESULT {self._acks[number]}){self.why(asked - 5.0)}")

    def _send(self, name: str, **fields: Any) -> None:
        self.client.send(name, target_system=self.target, target_component=1, **fields)

    def _take(self, name: str, fields: Any) -> None:
        if name == "STATUSTEXT":
            self.texts.append((self.now, int(fields.severity), fields.text.decode(errors="replace").rstrip("\0")))
        elif name == "MISSION_ITEM_REACHED":
            self.reached.append((self.now, int(fields.seq)))
        elif name == "COMMAND_ACK":
            self._acks[int(fields.command)] = int(fields.result)
        elif name == "EKF_STATUS_REPORT":
            self._ekf = fields.flags & READY_BITS == READY_BITS
        elif name == "SYS_STATUS":
            self._checked = bool(fields.onboard_control_sensors_health & PREARM_BIT)
        elif name in ("MISSION_REQUEST", "MISSION_REQUEST_INT") and fields.seq < len(self._upload):
            item = self._upload[fields.seq]
            self._send(
                "MISSION_ITEM_INT", seq=fields.seq, frame=item.frame, command=item.command, current=0,
                autocontinue=item.autocontinue, param1=item.p1, param2=item.p2, param3=item.p3, param4=item.p4,
                x=item.x, y=item.y, z=item.z,
            )  # fmt: skip
        elif name == "MISSION_ACK":
            self._upload_result = int(fields.type)
