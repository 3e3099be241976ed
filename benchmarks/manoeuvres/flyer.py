# SPDX-License-Identifier: BSD-3-Clause
"""A client that flies manoeuvres, keeps what telemetry says of them, and notes metrics."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from sitl.bridge.services.setpoint_messages import YAW_IGNORED, YAW_RATE_IGNORED
from sitl.client import Client
from sitl.client.connection import Connection
from sitl.client.controls import POSITION_ONLY, VELOCITY_ONLY
from sitl.core.mavlink import MavFrame
from sitl.simulation import Simulation

from .track import Track

RATES_HZ = {"HEARTBEAT": 10.0, "GLOBAL_POSITION_INT": 10.0, "SYS_STATUS": 2.0, "EKF_STATUS_REPORT": 2.0}
SETTLE_S = 5.0
"""Between being ready and the first command [s]."""
REACTION_S = 0.5

Metrics = dict[str, tuple[float, str]]
"""Value and unit by name."""


class Flyer(Client):
    """Flies one of the flights; ``rate_hz``: how often position and attitude are told."""

    def __init__(self, vehicle: Simulation | Connection, rate_hz: float) -> None:
        self.metrics: Metrics = {}
        self._rows: list[tuple[float, ...]] = []
        self._attitude = (0.0,) * 6
        rates = {**RATES_HZ, "ATTITUDE": rate_hz, "LOCAL_POSITION_NED": rate_hz}
        super().__init__(vehicle, rates=rates, patience=60.0)

    def _take(self, name: str, fields: Any) -> None:
        super()._take(name, fields)
        f = fields
        if name == "ATTITUDE":
            self._attitude = (f.roll, f.pitch, f.yaw, f.rollspeed, f.pitchspeed, f.yawspeed)
        elif name == "LOCAL_POSITION_NED":
            self._rows.append((f.time_boot_ms * 1e-3, f.x, f.y, f.z, f.vx, f.vy, f.vz, *self._attitude))

    def note(self, name: str, unit: str, value: float) -> None:
        """Keep a metric."""
        if name in self.metrics:
            raise ValueError(f"metric {name!r} is noted twice")
        self.metrics[name] = (float(value), unit)

    def fly(self, seconds: float, until: Callable[[], bool] = lambda: False) -> Track:
        """Let time pass, up to ``seconds`` or until the condition holds; gives what was flown."""
        start, first = self.now, len(self._rows)
        before = self._rows[first - 1 : first]
        self.passes(until, seconds)
        return Track(np.array([*before, *self._rows[first:]]), start)

    # ------------------------------------------------------------------ what is commanded

    def be_ready(self, mode: str = "GUIDED") -> None:
        """Wait for position and checks, and choose a mode."""
        self.wait_ready()
        self.delay(SETTLE_S)
        self.set_mode(mode)

    def airborne(self, altitude: float) -> None:
        """In GUIDED, at rest at an altitude."""
        self.be_ready()
        self.arm()
        self.delay(2.0)
        self.command("NAV_TAKEOFF", altitude=altitude)
        self.delay(6.0 + altitude)

    def begin_mission(self, items: Sequence[Any]) -> None:
        """Upload it, arm and start it in AUTO."""
        self.transfer(items)
        self.arm()
        self.delay(1.0)
        self.change_mode("AUTO")
        self.send_command("MISSION_START")

    def change_mode(self, mode: str) -> None:
        """Ask for a mode without waiting."""
        self.send_command("DO_SET_MODE", 1, self._mode_number(mode))

    def go_to(self, north: float, east: float, altitude: float, yaw: float | None = None) -> None:
        """GUIDED set-point from the origin [m], yaw [deg]."""
        self._stop_sending("velocity")
        mask = POSITION_ONLY & ~(YAW_IGNORED if yaw is not None else 0)
        self.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=MavFrame.LOCAL_NED, type_mask=mask,
                  x=north, y=east, z=-altitude, yaw=math.radians(yaw or 0.0))  # fmt: skip

    def velocity_at(self, seconds: float, interval: float, yaw_rate: float) -> Track:
        """GUIDED at rest turning with a rate [deg/s], sent every ``interval`` [s]."""
        self._stop_sending("velocity")
        start, first = self.now, len(self._rows)
        while self.now < start + seconds:
            self.send("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=MavFrame.LOCAL_NED,
                      type_mask=VELOCITY_ONLY & ~YAW_RATE_IGNORED, yaw_rate=math.radians(yaw_rate))  # fmt: skip
            self.delay(interval)
        return Track(np.array(self._rows[first - 1 :]), start)

    def sticks(self, channels: Mapping[int, int]) -> None:
        """Pulses [us] of channels 1 .. 4; those not named at rest."""
        self.rc({1: 1500, 2: 1500, 3: 1500, 4: 1500, **channels})
