# SPDX-License-Identifier: BSD-3-Clause
"""What was found in logs, and the airframe that it makes of a shipped one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from .. import vehicles
from ..core.constants import GRAVITY
from ..core.whole_file import write_whole
from ..logs.dataflash.columns import Progress
from ..physics.native.atmosphere import density
from ..vehicles import CopterAirframe
from .copter import figures
from .expected import exponent, slope_of
from .figure import Begins, Figure, silent
from .flight import FlightLog, IdentifyError
from .model import Model, outflow
from .telemetry import judged

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
_CELL = 4.2
"""Voltage of a full cell."""
_OVERCHARGE = 0.02
"""Part of a cell by which a full battery may seem to have one more: chargers and voltmeters err."""
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
        found, with intervals of what follows from them.

        Raises:
            IdentifyError: there is no shipped airframe with such rotors, or the hover output was not found.
        """
        return self._with_intervals(self._model().airframe)

    def _with_intervals(self, airframe: CopterAirframe) -> CopterAirframe:
        """How far off the airframe's figures may be: those of the logs are moved to the ends of their intervals one at
        a time, and what that does to a figure of the airframe is added up in squares, as of independent errors."""
        squares: dict[str, list[Any]] = {}
        for k, figure in enumerate(self.figures):
            if not figure.is_observed or figure.name == "hover_voltage":  # which also tells the number of cells
                continue
            for end in {figure.low, figure.high}:
                moved = [*self.figures[:k], replace(figure, value=end), *self.figures[k + 1 :]]
                other = replace(self, figures=tuple(moved))._model().airframe
                for name, value in other.figures.items():
                    change: Any = np.subtract(value, airframe.value(name))
                    if np.any(change):
                        below, above = squares.setdefault(name, [np.zeros_like(change), np.zeros_like(change)])
                        below += np.minimum(change, 0.0) ** 2
                        above += np.maximum(change, 0.0) ** 2
        limits = {figure.name: (figure.low, figure.high) for figure in airframe.known}
        intervals: dict[str, Any] = {}
        for name, (below, above) in squares.items():
            middle = np.asarray(airframe.value(name), float)
            ends = np.clip((middle - np.sqrt(below), middle + np.sqrt(above)), *limits[name])
            intervals[name] = tuple(tuple(end.tolist()) if end.ndim else float(end) for end in ends)
        return replace(airframe, intervals=intervals)

    def _model(self) -> Model:
        first = self.logs[0]
        pair = (int(first.parameter("FRAME_CLASS", default=0)), int(first.parameter("FRAME_TYPE", default=0)))
        if pair not in _BASES:
            known = ", ".join(f"{a}/{b}" for a, b in _BASES)
            raise IdentifyError(
                f"log {str(first.path)!r}: FRAME_CLASS/FRAME_TYPE {pair[0]}/{pair[1]} is none of {known}, of which "
                "there are airframes to begin with"
            )
        hover = self["hover_output"]
        if not hover.is_observed:
            raise IdentifyError(f"no airframe without {hover}")
        base = vehicles.load(_BASES[pair])
        assert isinstance(base, CopterAirframe)
        low, high = first.parameter("MOT_SPIN_MIN", default=0.15), first.parameter("MOT_SPIN_MAX", default=0.95)
        command = (hover.value - low) / (high - low)
        if not 0.0 < command < 1.0:
            raise IdentifyError(f"no airframe with {hover}: outside MOT_SPIN_MIN .. MAX {low} .. {high}")
        mass = self.mass or float(base.value("mass"))
        model = Model(self._scaled(base, mass, command, (low, high)), first.parameters, first.conditions, self._figure)
        model.notes["outflow_speed_max"] = f"identified, by {hover}"
        for name, source in (
            ("thrust_expo", "thrust_expo"),
            ("power_by_thrust", "hover_current"),
            ("battery_resistance", "battery_resistance"),
        ):
            if self[source].is_observed and float(model.airframe.value(name)) > 0.0:
                model.notes[name] = f"identified, by {self[source]}"
        return model

    def _scaled(self, base: CopterAirframe, mass: float, command: float, spin: tuple[float, float]) -> CopterAirframe:
        """The base with this mass, which hovers at this command, and the log's parameters."""
        first = self.logs[0]
        heavier = mass / float(base.value("mass"))
        expo, battery = float(base.value("thrust_expo")), self._battery()
        if self["thrust_expo"].is_observed:
            expo = self["thrust_expo"].value
            if "battery_capacity" in battery:  # its sag is in the figure, and in the model besides
                sag = self["battery_resistance"].value * self["hover_current"].value / self["hover_voltage"].value
                expo = exponent(slope_of(expo, command) * (1.0 + 2.0 * sag), command)
        expo = min(max(expo, 0.0), 1.0)
        base = replace(base, figures={**base.figures, **battery})
        speed = outflow(base, mass, command, expo, density(first.altitude))
        changes: dict[str, float | tuple[float, ...]] = {
            "mass": mass,
            "inertia": tuple(heavier * x for x in base.value("inertia")),
            "drag_area": tuple(heavier * x for x in base.value("drag_area")),
            "momentum_drag": float(base.value("momentum_drag")) * math.sqrt(heavier),
            "control_min": spin[0],
            "control_max": spin[1],
            "thrust_expo": expo,
            "outflow_speed_max": speed,
            "power_by_thrust": float(base.value("power_by_thrust")),
        }
        voltage, current = self["hover_voltage"], self["hover_current"]
        if voltage.is_observed:
            changes["outflow_speed_max"] = speed * float(base.value("battery_voltage_full")) / voltage.value
        if voltage.is_observed and current.is_observed:
            changes["power_by_thrust"] = voltage.value * current.value / (mass * GRAVITY)
        kept = {name: value for name, value in first.parameters.items() if name.startswith(_KEPT)}
        return CopterAirframe(
            name="identified",
            description=f"identified from {', '.join(log.path.name for log in self.logs)}",
            rotors=base.rotors,
            figures={**base.figures, **changes},
            parameters=_known({**base.parameters, **kept}),
        )

    def _battery(self) -> dict[str, float]:
        """A battery that sags, where the log's did; its capacity is BATT_CAPACITY."""
        voltage, resistance = self["hover_voltage"], self["battery_resistance"]
        if not voltage.is_observed:
            return {}
        found = {"battery_voltage_full": _CELL * math.ceil(voltage.value / _CELL - _OVERCHARGE)}
        capacity = 1e-3 * self.logs[0].parameter("BATT_CAPACITY", default=0.0)
        if resistance.is_observed and self["hover_current"].is_observed and capacity > 0.0:
            found |= {"battery_resistance": resistance.value, "battery_capacity": capacity}
        return found

    def _figure(self, name: str) -> Figure:
        return self[name]

    def to_toml(self) -> str:
        """The airframe's file, with logs, firmware and intervals as comments."""
        model = self._model()
        notes = model.notes
        notes["mass"] = "as given" if self.mass else "not given: logs tell ratios only, all forces are by this mass"
        head = [f"Identified from {log.path.name}: {log.columns.firmware}, {log.seconds:.0f} s" for log in self.logs]
        head += [
            "",
            *map(str, self.figures),
            "",
            "Figures without the word 'identified' are those of the airframe that",
        ]
        head += [
            "this one began with, by the logs' FRAME_CLASS and FRAME_TYPE, as far as forces go scaled to the mass;",
            "parameters are those of the log.",
        ]
        return vehicles.to_toml(self._with_intervals(model.airframe), head=head, notes=notes)

    def write(self, path: str | Path) -> None:
        """Write the file that ``--frame`` takes."""
        write_whole(path, self.to_toml(), IdentifyError, f"airframe file {str(path)!r}")


def _known(parameters: dict[str, float]) -> dict[str, float]:
    """Those that our copter's firmware has, takes and heeds, and that are not its defaults."""
    from ..autopilot.copter.parameters import TABLE

    known = {name: value for name, value in parameters.items() if name in TABLE and TABLE[name].has_effect}
    return {name: v for name, v in known.items() if v != TABLE[name].default and TABLE[name].refusal(v) is None}


def identify(
    logs: str | Path | Sequence[str | Path],
    mass: float | None = None,
    progress: Progress | None = None,
    begins: Begins = silent,
) -> Identification:
    """The figures of the copter that flew these logs.

    Args:
        logs: .bin or .tlog files of flights of one vehicle.
        mass: of the vehicle [kg].
        progress: is told how far each log is read.
        begins: is told which figures are worked on.

    Raises:
        sitl.logs.tlog.LogError, IdentifyError: a log that cannot be used, named with the reason.
    """
    paths = [logs] if isinstance(logs, str | Path) else list(logs)
    if not paths:
        raise IdentifyError("no logs are given; at least one .bin is needed")
    if mass is not None and not (math.isfinite(mass) and 0.001 <= mass <= 1e4):
        raise IdentifyError(f"mass {mass} kg is outside 0.001 .. 10000")
    found = [FlightLog(path, progress) for path in paths]
    forms = {log.is_telemetry for log in found}
    if len(forms) > 1:
        words = ", ".join(f"{log.path.name} ({'telemetry' if log.is_telemetry else 'on-board'})" for log in found)
        raise IdentifyError(f"logs of two forms, which tell different figures: {words}; give those of one form")
    seen = figures(found, begins)
    return Identification(tuple(found), tuple(judged(seen, found)), mass)
