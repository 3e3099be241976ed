# SPDX-License-Identifier: BSD-3-Clause
"""Two records, one at each end of a link that is a pair of byte strings."""

from __future__ import annotations

from typing import Any

import numpy as np

from sitl.bridge.dialect import message
from sitl.bridge.hil.autopilot_end import AutopilotEnd
from sitl.bridge.hil.physics_end import PhysicsEnd
from sitl.bridge.hil.protocol import Sender
from sitl.core.constants import TICK_US
from sitl.physics.carried import Carried, carried
from sitl.vehicle.copter import Copter
from sitl.vehicles import apply, load


class Vehicle:
    """A record of an Erle-Copter."""

    def __init__(self) -> None:
        self.fleet = Copter.fleet(2)
        self.index = 1
        self.v: Any = Copter.of(self.fleet, 1)
        apply(load("erle_copter"), self.v)


class FakePhysics(Vehicle):
    """A world in which every tick is noted and every sample is new."""

    def __init__(self) -> None:
        super().__init__()
        self.log: list[Any] = []
        self._stand()

    def _stand(self) -> None:
        s = self.v.sensors
        s.acc, s.abs_pressure, s.temperature = (0.0, 0.0, -9.8), 950.0, 20.0
        s.mag, s.mag_count, s.baro_count = (0.2, 0.0, -0.5), 1, 1
        s.battery_voltage, s.battery_current = 12.587, 0.31
        self.v.physics.body.q = (1.0, 0.0, 0.0, 0.0)

    def tick(self) -> None:
        v = self.v
        v.time_us += TICK_US
        v.tick += 1
        v.sensors.time_us = v.time_us
        v.sensors.gyro = v.sensors.gyro.replace(x=1e-6 * v.time_us)
        v.sensors.mag_count += int(v.tick % 4 == 1)
        self.log.append(round(float(v.actuators.controls[0]), 6))

    def power_on(self) -> None:
        self.v.time_us = self.v.tick = 0
        self.v["sensors"] = np.zeros((), self.v.sensors.dtype)
        self._stand()
        self.log.append("power on")

    def set_parameter(self, name: str, value: float) -> float | None:
        self.log.append((name, value))
        return value if name.startswith("SIM_") else None

    def reseed(self, seed: int) -> None:
        self.log.append(("seed", seed))

    def truth(self) -> Carried:
        return carried(self.v)


class Bench:
    """Both ends, wired."""

    def __init__(self) -> None:
        self.physics, self.autopilot = FakePhysics(), Vehicle()
        self.there = PhysicsEnd(self.physics)
        a = self.autopilot
        self.here = AutopilotEnd(a.fleet, a.index, a.v)
        self.stranger = Sender(1, 1)
        """Makes frames of another autopilot."""

    def join(self) -> int:
        """Begin where the physics is; gives what the autopilot's end found."""
        return self.here.feed(self.there.feed(self.here.hello({}) + self.here.ask_state()))

    def tick(self, control: float = 0.0) -> int:
        """One exchange."""
        self.autopilot.v.actuators.controls[0] = control
        return self.here.feed(self.there.feed(self.here.controls()))

    def say(self, name: str, **fields: Any) -> bytes:
        """A message to the physics; gives the answer."""
        kind = message(name)
        return self.there.feed(self.stranger.frame(kind, kind.payload(**fields)))
