# SPDX-License-Identifier: BSD-3-Clause
"""What a test can ask about its vehicle at any time: what telemetry said last."""

from __future__ import annotations

from sitl.simulation import Simulation

from .telemetry import Place, Telemetry, Text

TEXTS_TOLD = 8
"""As many status texts stand in a failure."""


class Known:
    """A vehicle as its telemetry tells it."""

    name: str
    """For messages and files."""
    simulation: Simulation
    telemetry: Telemetry

    @property
    def now(self) -> float:
        """Simulated time since power-on [s]."""
        return self.simulation.time_us / 1e6

    @property
    def kind(self) -> str:
        """ "copter" or "rover"."""
        return self.simulation.kind.name

    @property
    def mode(self) -> str:
        """Flight mode by the last HEARTBEAT; "" before the first."""
        number = self.telemetry.custom_mode
        return "" if number < 0 else self.simulation.firmware.mode_names.get(number, str(number))

    @property
    def armed(self) -> bool:
        """Whether it is armed by the last HEARTBEAT."""
        return self.telemetry.armed

    @property
    def position(self) -> Place:
        """North, east, height from home [m] (GLOBAL_POSITION_INT)."""
        return self.telemetry.place

    @property
    def height(self) -> float:
        """Above home [m]."""
        return self.telemetry.height

    @property
    def location(self) -> tuple[float, float, float]:
        """Latitude, longitude [deg], altitude above mean sea level [m]."""
        return (self.telemetry.lat * 1e-7, self.telemetry.lon * 1e-7, self.telemetry.alt)

    @property
    def groundspeed(self) -> float:
        """[m/s]"""
        north, east, _ = self.telemetry.velocity
        return float((north * north + east * east) ** 0.5)

    @property
    def climb_rate(self) -> float:
        """Upward [m/s]."""
        return -self.telemetry.velocity[2]

    @property
    def heading(self) -> float:
        """[deg], 0 (north) .. 360"""
        return self.telemetry.heading

    @property
    def texts(self) -> list[Text]:
        """All status texts: (time [s], severity, text)."""
        return self.telemetry.texts

    @property
    def reached(self) -> list[int]:
        """Mission items that were reached, in order."""
        return [seq for _, seq in self.telemetry.reached]

    def describe(self) -> str:
        """Where it is and what it does, in a line."""
        state = f"{self.mode or 'no mode yet'}, {'armed' if self.armed else 'disarmed'}"
        item = f", item {self.telemetry.item}" if self.mode == "AUTO" else ""
        return f"{state}{item}, {self.position}, {self.groundspeed:.1f} m/s, heading {self.heading:.0f}"

    def last_texts(self, count: int = TEXTS_TOLD) -> list[str]:
        """The last status texts with their times."""
        return [f"{text.time:9.1f} s  {text.text}" for text in self.texts[-count:]]
