# SPDX-License-Identifier: BSD-3-Clause
"""A client that does things at set simulated times, and keeps at 25 Hz what telemetry says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sitl.autopilot.mission.item import MissionItem
from sitl.client import Client
from sitl.client.commands import command_number
from sitl.client.controls import POSITION_ONLY, VELOCITY_ONLY
from sitl.core.mavlink import MavFrame, MavModeFlag
from sitl.errors import SitlError
from sitl.simulation import Simulation

from .recording import COLUMNS, Recording

__all__ = ["POSITION_ONLY", "VELOCITY_ONLY", "FlightError", "Pilot", "items"]

ARM = command_number("COMPONENT_ARM_DISARM")
SAMPLE_US = 40_000
RATES_HZ = {"LOCAL_POSITION_NED": 25.0, "ATTITUDE": 25.0, "EKF_STATUS_REPORT": 5.0, "SYS_STATUS": 5.0}


class FlightError(SitlError, RuntimeError):
    """A flight that did not go as its script needs it to (not ready, not disarmed in time)."""


class Pilot(Client):
    """A client that keeps to a script: its commands go out at set times, whatever is answered. It looks every 40 ms."""

    def __init__(self, simulation: Simulation) -> None:
        self.rows: list[tuple[float, ...]] = []
        self.phases: dict[str, float] = {}
        self.acks: list[tuple[int, int]] = []
        """(MAV_CMD, MAV_RESULT) of all answers."""
        self._place = (0.0,) * 6
        self._euler = (0.0,) * 3
        super().__init__(simulation, rates=RATES_HZ, heartbeat=False)

    def step(self, stop_us: int | None = None) -> None:
        """Let 40 ms pass, but not beyond ``stop_us``, and note what telemetry says."""
        now = self.connection.time_us
        self.connection.run(SAMPLE_US if stop_us is None else min(SAMPLE_US, stop_us - now))
        self.note()

    def fly(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass, up to ``seconds`` or until the condition holds; returns whether it held."""
        stop = self.connection.time_us + int(seconds * 1e6)
        while self.connection.time_us < stop:
            self.step(stop)
            if until():
                return True
        return False

    def note(self) -> None:
        """Keep what telemetry says now; called every 40 ms."""
        self.rows.append((self.now, *self._place, *self._euler))

    def phase(self, name: str) -> None:
        """Name what comes now."""
        self.phases[name] = self.now

    def recording(self) -> Recording:
        """All that was flown."""
        data = np.array(self.rows)
        assert data.shape[1] == len(COLUMNS)
        texts = [(text.time, text.text) for text in self.texts]
        return Recording(data, self.phases, self.telemetry.reached, texts, self.now)

    def choose_mode(self, name: str) -> None:
        """Ask for a mode by its name, and wait for nothing."""
        self.send_command("DO_SET_MODE", MavModeFlag.CUSTOM_MODE_ENABLED, self._mode_number(name))

    def boot(self) -> None:
        """Wait for a position and for the checks, 5 s more as the recordings did, then choose GUIDED."""
        seen = self.telemetry
        if not self.fly(90.0, lambda: seen.has_position and seen.checked):
            state = f"position {seen.has_position}, checks {seen.checked}"
            raise FlightError(f"not ready after {self.now:.0f} s ({state}): {self.last_texts(5)}")
        self.fly(5.0)
        self.choose_mode("GUIDED")

    def arm(self, wait: float = 2.0) -> None:  # type: ignore[override]
        """Arm and let ``wait`` seconds pass; FlightError with the vehicle's texts when it refuses."""
        self.acks.clear()
        self.send_command("COMPONENT_ARM_DISARM", arm=1)
        self.fly(wait)
        if (ARM, 0) not in self.acks:
            raise FlightError(f"did not arm: {self.last_texts(5)}")

    def setpoint(
        self, mask: int, position: tuple[float, ...] = (0, 0, 0), velocity: tuple[float, ...] = (0, 0, 0)
    ) -> None:
        """SET_POSITION_TARGET_LOCAL_NED in the local NED frame."""
        self.send(
            "SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=MavFrame.LOCAL_NED, type_mask=mask,
            x=position[0], y=position[1], z=position[2], vx=velocity[0], vy=velocity[1], vz=velocity[2],
        )  # fmt: skip

    def stream_setpoint(self, seconds: float, mask: int, velocity: tuple[float, ...]) -> None:
        """Repeat a velocity at 10 Hz, as the recorded script did."""
        for _ in range(round(seconds * 10)):
            self.setpoint(mask, velocity=velocity)
            self.fly(0.1)

    def _take(self, name: str, fields: Any) -> None:
        super()._take(name, fields)
        if name == "LOCAL_POSITION_NED":
            self._place = (fields.x, fields.y, fields.z, fields.vx, fields.vy, fields.vz)
        elif name == "ATTITUDE":
            self._euler = (fields.roll, fields.pitch, fields.yaw)
        elif name == "COMMAND_ACK":
            self.acks.append((fields.command, fields.result))


def items(rows: list[tuple[int, int, int, int, float]]) -> list[MissionItem]:
    """Mission items from (frame, command, x, y, z)."""
    return [MissionItem(command, frame, x=x, y=y, z=z) for frame, command, x, y, z in rows]
