# SPDX-License-Identifier: BSD-3-Clause
"""Sends commands at simulated times, as MAVLink bytes, and keeps what telemetry says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sitl.bridge.client import Client
from sitl.simulation import Simulation

from .recording import COLUMNS, Recording

SET_MODE, ARM, TAKEOFF, CONDITION_YAW, MISSION_START = 176, 400, 22, 115, 300
POSITION_ABSOLUTE = 16
"""EKF_STATUS_REPORT: the filter has an absolute position."""
PREARM_BIT = 0x10000000
"""SYS_STATUS: MAV_SYS_STATUS_PREARM_CHECK."""
LOCAL_NED = 1
POSITION_ONLY, VELOCITY_ONLY = 0b0000110111111000, 0b0000110111000111
SAMPLE_US = 40_000


class FlightError(RuntimeError):
    """A flight that did not go as its script needs it to (not ready, not disarmed in time)."""


class Pilot:
    """Sends commands at simulated times and keeps what the vehicle's telemetry says, at 25 Hz."""

    def __init__(self, simulation: Simulation) -> None:
        self.simulation = simulation
        self.client = Client()
        simulation.bridge.add_link(self.client.link)
        self.rows: list[tuple[float, ...]] = []
        self.phases: dict[str, float] = {}
        self.reached: list[tuple[float, int]] = []
        self.texts: list[tuple[float, str]] = []
        self.acks: list[tuple[int, int]] = []
        self.armed = False
        self.position = self.checked = False
        self._position = self._attitude = (0.0,) * 6
        self.ask_for_telemetry()

    @property
    def now(self) -> float:
        """Simulated time [s]."""
        return self.simulation.time_us * 1e-6

    def ask_for_telemetry(self) -> None:
        """Ask for what the pilot looks at; a reboot makes the vehicle forget it."""
        for name in ("LOCAL_POSITION_NED", "ATTITUDE"):
            self.client.set_interval(name, 25.0)
        for name in ("EKF_STATUS_REPORT", "SYS_STATUS"):
            self.client.set_interval(name, 5.0)

    def fly(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass, up to ``seconds`` or until the condition holds; returns whether it held."""
        stop = self.simulation.time_us + int(seconds * 1e6)
        while self.simulation.time_us < stop:
            self.simulation.advance_to(min(stop, self.simulation.time_us + SAMPLE_US))
            for name, fields in self.client.receive():
                self._take(name, fields)
            self.note()
            if until():
                return True
        return False

    def note(self) -> None:
        """Keep what telemetry says now; called every 40 ms."""
        self.rows.append((self.now, *self._position, *self._attitude[:3]))

    def phase(self, name: str) -> None:
        """Name what comes now."""
        self.phases[name] = self.now

    def recording(self) -> Recording:
        """All that was flown."""
        data = np.array(self.rows)
        assert data.shape[1] == len(COLUMNS)
        return Recording(data, self.phases, self.reached, self.texts, self.now)

    def choose_mode(self, name: str) -> None:
        """Ask for a mode by its name."""
        numbers = {name: number for number, name in self.simulation.firmware.mode_names.items()}
        self.client.command(SET_MODE, 1, numbers[name])

    def boot(self) -> None:
        """Wait for a position and for the checks, 5 s more as the recordings did, then choose GUIDED."""
        if not self.fly(90.0, lambda: self.position and self.checked):
            state = f"position {self.position}, checks {self.checked}"
            raise FlightError(f"not ready after {self.now:.0f} s ({state}): {self.texts[-5:]}")
        self.fly(5.0)
        self.choose_mode("GUIDED")

    def arm(self, wait: float = 2.0) -> None:
        """Arm and let ``wait`` seconds pass; FlightError with the vehicle's texts when it refuses."""
        self.acks.clear()
        self.client.command(ARM, 1)
        self.fly(wait)
        if (ARM, 0) not in self.acks:
            raise FlightError(f"did not arm: {self.texts[-5:]}")

    def wait_disarmed(self, seconds: float) -> None:
        """Fly until disarmed."""
        if not self.fly(seconds, lambda: not self.armed):
            raise FlightError(f"still armed after {seconds} s: {self.texts[-5:]}")

    def setpoint(
        self, mask: int, position: tuple[float, ...] = (0, 0, 0), velocity: tuple[float, ...] = (0, 0, 0)
    ) -> None:
        """SET_POSITION_TARGET_LOCAL_NED in the local NED frame."""
        self.client.send(
            "SET_POSITION_TARGET_LOCAL_NED",
            target_system=1, target_component=1, coordinate_frame=LOCAL_NED, type_mask=mask,
            x=position[0], y=position[1], z=position[2], vx=velocity[0], vy=velocity[1], vz=velocity[2],
        )  # fmt: skip

    def stream_setpoint(self, seconds: float, mask: int, velocity: tuple[float, ...]) -> None:
        """Repeat a velocity at 10 Hz, as the recorded script did."""
        for _ in range(round(seconds * 10)):
            self.setpoint(mask, velocity=velocity)
            self.fly(0.1)

    def _take(self, name: str, fields: Any) -> None:
        if name == "LOCAL_POSITION_NED":
            self._position = (fields.x, fields.y, fields.z, fields.vx, fields.vy, fields.vz)
        elif name == "ATTITUDE":
            self._attitude = (fields.roll, fields.pitch, fields.yaw, 0.0, 0.0, 0.0)
        elif name == "HEARTBEAT":
            self.armed = bool(fields.base_mode & 128)
        elif name == "EKF_STATUS_REPORT":
            self.position = bool(fields.flags & POSITION_ABSOLUTE)
        elif name == "SYS_STATUS":
            self.checked = bool(fields.onboard_control_sensors_health & PREARM_BIT)
        elif name == "STATUSTEXT":
            self.texts.append((self.now, fields.text.decode()))
        elif name == "MISSION_ITEM_REACHED":
            self.reached.append((self.now, fields.seq))
        elif name == "COMMAND_ACK":
            self.acks.append((fields.command, fields.result))


def upload(pilot: Pilot, items: list[tuple[int, int, int, int, float]]) -> None:
    """Upload (frame, command, x, y, z) items by the mission protocol; FlightError when it is refused."""
    answers: list[int] = []
    take = pilot._take

    def answer(name: str, fields: Any) -> None:
        if name in ("MISSION_REQUEST", "MISSION_REQUEST_INT"):
            frame, command, x, y, z = items[fields.seq]
            pilot.client.send(
                "MISSION_ITEM_INT",
                target_system=1, target_component=1, seq=fields.seq, frame=frame, command=command,
                autocontinue=1, x=x, y=y, z=z,
            )  # fmt: skip
        elif name == "MISSION_ACK":
            answers.append(fields.type)
        take(name, fields)

    pilot._take = answer  # type: ignore[method-assign]
    pilot.client.send("MISSION_COUNT", target_system=1, target_component=1, count=len(items))
    pilot.fly(10.0, lambda: bool(answers))
    pilot._take = take  # type: ignore[method-assign]
    if answers != [0]:
        raise FlightError(f"mission upload: MISSION_ACK {answers}")
