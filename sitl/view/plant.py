# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a vehicle whose autopilot is another program: its physics alone is here."""

from __future__ import annotations

from ..plants.local import LocalPlant
from .frame import Frame
from .record import RecordSource

ELSEWHERE = "autopilot elsewhere"
"""Shown in place of a mode."""
_OWN = ("physics.", "sensors.", "actuators.")
"""Signals that physics knows."""


class PlantSource(RecordSource):
    """The physics of a vehicle, as a page sees it."""

    def __init__(self, plant: LocalPlant) -> None:
        vehicle = plant.vehicle
        super().__init__(vehicle.kind, vehicle.fleet, vehicle.index, vehicle.airframe.name, plant.world)
        self._clock = vehicle.reader.field("time_us")

    def capture(self) -> tuple[int, bytes]:
        """The vehicle as it is now."""
        return int(self._clock()), self._copy()

    def signal_names(self) -> list[str]:
        return [name for name in super().signal_names() if name.startswith(_OWN)]

    def frame(self, captured: tuple[int, bytes]) -> Frame:
        """What the page shows of a moment."""
        time_us, record = captured
        v = self._take(record)
        gps, battery = v.sensors, v.autopilot.battery
        return Frame(
            time_us=time_us, mode=ELSEWHERE, satellites=int(gps.gps_satellites), fix=int(gps.gps_fix),
            voltage=battery.voltage, current=battery.current, charge_left=battery.remaining_pct, **self._moment(),
        )  # fmt: skip
