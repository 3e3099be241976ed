# SPDX-License-Identifier: BSD-3-Clause
"""The live status line of a run."""

from __future__ import annotations

import math
import sys
import time

from ..simulation import Simulation


class StatusLine:
    """A line on a terminal, rewritten four times a second; without a terminal only messages about lost clients."""

    _PERIOD_S = 0.25

    def __init__(self, simulation: Simulation, enabled: bool = True) -> None:
        self._simulation = simulation
        self._enabled = enabled and sys.stderr.isatty()
        self._next = self._last_wall = time.monotonic()
        self._last_us = simulation.time_us
        self._factor = 0.0
        self._width = 0

    def refresh(self) -> None:
        """Rewrite the line when it is due; print which clients were lost and why."""
        dropped = self._simulation.bridge.dropped
        for text in dropped:
            print(f"\r{text}".ljust(self._width), file=sys.stderr)
        dropped.clear()  # printed; a run may last for months
        if not self._enabled or time.monotonic() < self._next:
            return
        now, time_us = time.monotonic(), self._simulation.time_us
        if now > self._last_wall:
            self._factor = (time_us - self._last_us) * 1e-6 / (now - self._last_wall)
        self._last_wall, self._last_us, self._next = now, time_us, now + self._PERIOD_S
        text = describe(self._simulation, self._factor)
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)

    def close(self) -> None:
        """End the line."""
        if self._enabled and self._width:
            sys.stderr.write("\n")


def describe(simulation: Simulation, factor: float) -> str:
    """Time, speed (``factor``: times real time), mode, position and clients in one line."""
    v = simulation.v
    estimate, ap = v.autopilot.estimate, v.autopilot
    height = -float(estimate.pos[2]) + float(ap.home.pos[2])
    speed = math.hypot(float(estimate.vel[0]), float(estimate.vel[1]))
    armed = "ARMED" if int(ap.arming.armed) else "disarmed"
    mode = simulation.firmware.mode_names[int(ap.modes.number)]
    ready = "" if int(ap.arming.prearm_ok) or int(ap.arming.armed) else " (not ready to arm)"
    return (
        f"{simulation.time_us * 1e-6:9.1f} s  {factor:6.1f}x  {mode} {armed}{ready}"
        f"  alt {height:.1f} m  speed {speed:.1f} m/s  {float(ap.battery.voltage):.1f} V"
        f"  clients {clients(simulation)}"
    )


def clients(simulation: Simulation) -> int:
    """Number of clients that have sent messages."""
    return sum(channel.statistics.received > 0 for channel in simulation.bridge.channels)
