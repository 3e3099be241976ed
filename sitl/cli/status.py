# SPDX-License-Identifier: BSD-3-Clause
"""The live status line of a run."""

from __future__ import annotations

import math
import sys
import time
from collections import deque
from collections.abc import Callable

from ..autopilot.modes import shown
from ..plants.local import LocalPlant
from ..simulation import Simulation

_PERIOD_S = 0.25


class Line:
    """A line on a terminal, rewritten four times a second; messages are printed above it, also without a terminal.

    Args:
        messages: texts to be printed, taken from it when they are; other threads may add some.
        time_us: reads the simulated time [us].
        describe: gives the text of the line; its argument is simulated by wall time.
        enabled: whether there is a line at all.
    """

    def __init__(
        self, messages: deque[str], time_us: Callable[[], int], describe: Callable[[float], str], enabled: bool
    ) -> None:
        self._messages, self._time_us, self._describe = messages, time_us, describe
        self._enabled = enabled and sys.stderr.isatty()
        self._next = self._last_wall = time.monotonic()
        self._last_us = time_us()
        self._factor = 0.0
        self._width = 0

    def refresh(self) -> None:
        """Print the messages, and rewrite the line when it is due."""
        while self._messages:
            print(f"\r{self._messages.popleft()}".ljust(self._width), file=sys.stderr, flush=True)
        now = time.monotonic()
        if not self._enabled or now < self._next:
            return
        time_us = self._time_us()
        if now > self._last_wall:
            self._factor = (time_us - self._last_us) * 1e-6 / (now - self._last_wall)
        self._last_wall, self._last_us, self._next = now, time_us, now + _PERIOD_S
        text = self._describe(self._factor)
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)

    def close(self) -> None:
        """End the line."""
        if self._enabled and self._width:
            sys.stderr.write("\n")


class StatusLine(Line):
    """Of a simulation; the messages are about lost clients."""

    def __init__(self, simulation: Simulation, enabled: bool = True) -> None:
        dropped = simulation.bridge.dropped
        super().__init__(dropped, lambda: simulation.time_us, lambda factor: describe(simulation, factor), enabled)


def describe(simulation: Simulation, factor: float) -> str:
    """Time, speed (``factor``: times real time), mode, position and clients in one line."""
    v = simulation.v
    estimate, ap = v.autopilot.estimate, v.autopilot
    height = -float(estimate.pos[2]) + float(ap.home.pos[2])
    speed = math.hypot(float(estimate.vel[0]), float(estimate.vel[1]))
    armed = "ARMED" if int(ap.arming.armed) else "disarmed"
    mode = simulation.firmware.mode_names[int(shown(ap.modes))]
    ready = "" if int(ap.arming.prearm_ok) or int(ap.arming.armed) else " (not ready to arm)"
    return (
        f"{simulation.time_us * 1e-6:9.1f} s  {factor:6.1f}x  {mode} {armed}{ready}"
        f"  alt {height:.1f} m  speed {speed:.1f} m/s  {float(ap.battery.voltage):.1f} V"
        f"  clients {clients(simulation)}"
    )


def clients(simulation: Simulation) -> int:
    """Number of clients that have sent messages."""
    return sum(channel.port.received > 0 for channel in simulation.bridge.channels)


class PlantStatus(Line):
    """Of a vehicle whose autopilot is another program, from the physics' state."""

    def __init__(self, plant: LocalPlant, messages: deque[str], enabled: bool = True) -> None:
        reader = plant.vehicle.reader
        read = reader.fields("time_us", "physics.body.pos", "physics.body.vel")

        def describe(factor: float) -> str:
            time_us, north, east, down, vn, ve, _ = read()
            return (
                f"{time_us * 1e-6:9.1f} s  {factor:6.1f}x  north {north:.1f}  east {east:.1f}  height {-down:.1f} m  "
                f"speed {math.hypot(vn, ve):.1f} m/s"
            )

        super().__init__(messages, reader.field("time_us"), describe, enabled)
        self._said = messages

    def close(self) -> None:
        """End the line and print pending messages."""
        super().close()
        while self._said:
            print(self._said.popleft(), file=sys.stderr)
