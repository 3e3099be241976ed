# SPDX-License-Identifier: BSD-3-Clause
"""What was found in logs, and the airframe that it makes of a shipped one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .. import vehicles
from ..core.constants import GRAVITY
from ..core.whole_file import write_whole
from ..logs.dataflash.columns import Progress
from ..physics.native.atmosphere import density
from ..vehicles import CopterAirframe
from .copter import figures
from .figure import Figure
from .flight import FlightLog, IdentifyError

_BASES = {
    (1, 0): "ardupilot_quad",
    (1, 1): "ardupilot_x",
    (2, 0): "ardupilot_hexa",
    (2, 1): "ardupilot_hexa_x",
    (3, 0): "ardupilot_octa",
    (4, 1): "ardupilot_octa_quad",
    (5, 0): "ardupilot_y6",
}
"""FRAME_CLASS, FRAME_TYPE -> the shipped airframe with these rotors."""
_KEPT = ("ATC_", "FRAME_", "INS_ACCEL_FILTER", "INS_GYRO_FILTER", "MOT_", "PSC_", "WPNAV_", "WP_", "ANGLE_MAX")
"""Parameters of the log that the airframe takes over, as far as the firmware has them."""


@dataclass(frozen=True)
class Identification:
    """What logs tell.

    Args:
        logs: the logs.
        figures: all that was looked for.
        mass: as the user gave it [kg]; None: not given.
    """

    logs: tuple[FlightLog, ...]
    figures: tuple[Figure, ...]
    mass: float | None = None

    def __getitem__(self, name: str) -> Figure:
        """A figure by its name."""
        for figure in self.figures:
            if figure.name == name:
                return figure
        raise KeyError(name)

    def table(self) -> str:
        """A line for each figure."""
        return "\n".join(map(str, self.figures))

    def airframe(self) -> CopterAirframe:
        """A shipped airframe with the rotors of the log's FRAME_CLASS and FRAME_TYPE, changed as far as figures were
        found.

        Raises:
            IdentifyError: there is no shipped airframe with such rotors, or the hover output was not found.
        """
        first = self.logs[0]
        pair = (int(first.parameter("FRAME_CLASS", default=0)), int(first.parameter("FRAME_TYPE", default=0)))
        if pair not in _BASES:
            known = ", ".join(f"{a}/{b}" for a, b in _BASES)
            raise IdentifyError(
                f"log {str(first.path)!r}: FRAME_CLASS/FRAME_TYPE {pair[0]}/{pair[1]} is none of {known}, of which "
                "there are airframes to begin with"
            )
        if not self["hover_output"].is_observed:
            raise IdentifyError(f"no airframe without {self['hover_output']}")
        base = vehicles.load(_BASES[pair])
        assert isinstance(base, CopterAirframe)
        mass = self.mass or float(base.value("mass"))
        heavier = mass / float(base.value("mass"))
        low, high = first.parameter("MOT_SPIN_MIN", default=0.15), first.parameter("MOT_SPIN_MAX", default=0.95)
        expo, count = float(base.value("thrust_expo")), len(base.rotors)
        command = (self["hover_output"].value - low) / (high - low)
        if not 0.0 < command < 1.0:
            raise IdentifyError(f"no airframe with {self['hover_output']}: outside MOT_SPIN_MIN .. MAX {low} .. {high}")
        altitude = 0.0
        if first.has("GPS"):
            fixes = first.columns["GPS"]
            altitude = float(fixes["Alt"][fixes["Status"] >= 3][-1]) if (fixes["Status"] >= 3).any() else 0.0
        flow = 0.5 * density(altitude) * float(base.value("outflow_area")) * count
        speed = math.sqrt(mass * GRAVITY / (flow * command * (1.0 - expo + expo * command)))
        changes: dict[str, float | tuple[float, ...]] = {
            "mass": mass,
            "inertia": tuple(heavier * x for x in base.value("inertia")),
            "drag_area": tuple(heavier * x for x in base.value("drag_area")),
            "momentum_drag": float(base.value("momentum_drag")) * math.sqrt(heavier),
            "control_min": low,
            "control_max": high,
            "outflow_speed_max": speed,
            "power_by_thrust": float(base.value("power_by_thrust")),
        }
        voltage, current = self["hover_voltage"], self["hover_current"]
        if voltage.is_observed:
            changes["outflow_speed_max"] = speed * float(base.value("battery_voltage_full")) / voltage.value
        if voltage.is_observed and current.is_observed:
            changes["power_by_thrust"] = voltage.value * current.value / (mass * GRAVITY)
        if self["battery_resistance"].is_observed:
            changes["battery_resistance"] = self["battery_resistance"].value
        firmware_names = first.parameters
        parameters = {
            **base.parameters,
            **{name: value for name, value in firmware_names.items() if name.startswith(_KEPT)},
        }
        parameters = _known(parameters)
        return CopterAirframe(
            name="identified",
            description=f"identified from {', '.join(log.path.name for log in self.logs)}",
            rotors=base.rotors,
            figures={**base.figures, **changes},
            parameters=parameters,
        )

    def to_toml(self) -> str:
        """The airframe's file, with logs, firmware and intervals as comments."""
        notes = {}
        for figure, source in (
            ("outflow_speed_max", "hover_output"),
            ("power_by_thrust", "hover_current"),
            ("battery_resistance", "battery_resistance"),
        ):
            if self[source].is_observed:
                notes[figure] = f"identified, by {self[source]}"
        notes["mass"] = "as given" if self.mass else "not given: logs tell ratios only, all forces are by this mass"
        head = [f"Identified from {log.path.name}: {log.columns.firmware}, {log.seconds:.0f} s" for log in self.logs]
        head += [
            "",
            *map(str, self.figures),
            "",
            "Figures without the word 'identified' are those of the airframe that",
        ]
        head += [
            "this one began with, by the logs' FRAME_CLASS and FRAME_TYPE, inertia and drag scaled to the mass;",
            "parameters are those of the log.",
        ]
        return vehicles.to_toml(self.airframe(), head=head, notes=notes)

    def write(self, path: str | Path) -> None:
        """Write the file that ``--frame`` takes."""
        write_whole(path, self.to_toml(), IdentifyError, f"airframe file {str(path)!r}")


def _known(parameters: dict[str, float]) -> dict[str, float]:
    """Those that our copter's firmware has and takes."""
    from ..autopilot.copter.parameters import TABLE

    return {name: v for name, v in parameters.items() if name in TABLE and TABLE[name].refusal(v) is None}


def identify(
    logs: str | Path | Sequence[str | Path], mass: float | None = None, progress: Progress | None = None
) -> Identification:
    """The figures of the copter that flew these logs.

    Args:
        logs: .bin files of flights of one vehicle.
        mass: of the vehicle [kg].
        progress: is told how far each log is read.

    Raises:
        sitl.logs.tlog.LogError, IdentifyError: a log that cannot be used, named with the reason.
    """
    paths = [logs] if isinstance(logs, str | Path) else list(logs)
    if not paths:
        raise IdentifyError("no logs are given; at least one .bin is needed")
    if mass is not None and not (math.isfinite(mass) and 0.001 <= mass <= 1e4):
        raise IdentifyError(f"mass {mass} kg is outside 0.001 .. 10000")
    found = [FlightLog(path, progress) for path in paths]
    return Identification(tuple(found), tuple(figures(found)), mass)
