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
from ..core.whole_file import write_whole
from ..logs.dataflash.columns import Progress
from ..vehicles import Airframe
from .copter_airframe import model_of
from .copter_properties import estimates
from .estimate import Begins, Estimate, silent
from .log_streams import ABOVE_M, FlightLog, IdentifyError
from .model import Model
from .required_messages import judged
from .rover.airframe import RoverModel
from .rover.airframe import model_of as rover_model_of
from .rover.estimates import estimates as rover_estimates
from .rover.sought import LOAD

_LEAST_EFFICIENCY = 0.1
"""Of motors with gears: with less a mass is a slip of the pen."""
_CELLS = ("hover_voltage", "battery_voltage")
"""Properties of which the number of cells follows, at whose ends there may be one more."""

_ASSUMED = 2.0
"""By this an assumed property may be off, either way."""


@dataclass(frozen=True)
class Identification:
    """What logs show.

    Args:
        logs: the logs.
        estimates: all that was looked for.
        mass: as the user gave it [kg]; None: not given.
    """

    logs: tuple[FlightLog, ...]
    estimates: tuple[Estimate, ...]
    mass: float | None = None

    def __getitem__(self, name: str) -> Estimate:
        """A property by its name."""
        for estimate in self.estimates:
            if estimate.name == name:
                return estimate
        raise KeyError(name)

    def table(self) -> str:
        """A line for each property."""
        return "\n".join(map(str, self.estimates))

    @property
    def kind(self) -> str:
        """Of the vehicle: "copter" or "rover"."""
        return self.logs[0].kind

    def airframe(self) -> Airframe:
        """A shipped airframe with the rotors of the log's FRAME_CLASS and FRAME_TYPE, or the steering of its
        SERVOn_FUNCTION, changed as far as properties were found, with intervals of what follows from them.

        Raises:
            IdentifyError: there is no shipped airframe with such rotors, or what moves it (hover output; speed and
                steering) was not found.
        """
        return self._with_intervals(self._model())

    def _with_intervals(self, model: Model | RoverModel) -> Airframe:
        """How far off the airframe's properties may be: those of the logs are moved to the ends of their intervals
        one at a time, and what that does to a property of the airframe is added up in squares, as of independent
        errors."""
        airframe: Airframe = model.airframe
        squares: dict[str, list[Any]] = {}
        for k, estimate in enumerate(self.estimates):
            if not estimate.is_observed or estimate.name in _CELLS:
                continue
            for end in {estimate.low, estimate.high}:
                moved = [*self.estimates[:k], replace(estimate, value=end), *self.estimates[k + 1 :]]
                other = replace(self, estimates=tuple(moved))._model().airframe
                for name, value in other.properties.items():
                    if self.kind == "rover" and name not in model.notes:
                        continue  # a length that goes with the vehicle's size
                    change: Any = np.subtract(value, airframe.value(name))
                    if np.any(change):
                        below, above = squares.setdefault(name, [np.zeros_like(change), np.zeros_like(change)])
                        below += np.minimum(change, 0.0) ** 2
                        above += np.maximum(change, 0.0) ** 2
        limits = {prop.name: (prop.low, prop.high) for prop in airframe.known}
        intervals: dict[str, Any] = {}
        for name, (below, above) in squares.items():
            middle = np.asarray(airframe.value(name), float)
            ends = np.clip((middle - np.sqrt(below), middle + np.sqrt(above)), *limits[name])
            if model.notes.get(name, "").startswith("assumed"):
                ends = np.clip((middle / _ASSUMED, middle * _ASSUMED), *limits[name])
            intervals[name] = tuple(tuple(end.tolist()) if end.ndim else float(end) for end in ends)
        return replace(airframe, intervals=intervals)

    @property
    def doubts(self) -> list[str]:
        """What the logs say against the mass that was given: of a rover the battery tells it by the motors'
        efficiency."""
        load = next(
            (estimate for estimate in self.estimates if estimate.name == LOAD.name and estimate.is_observed), None
        )
        if load is None or self.mass is None or _LEAST_EFFICIENCY * load.low <= self.mass <= load.high:
            return []
        low, high = (share * load.value for share in (_LEAST_EFFICIENCY, 1.0))
        return [
            f"mass {self.mass:g} kg does not go with the battery: what it gave for the motors' work makes {low:.3g} to "
            f"{high:.3g} kg likely, at an efficiency of {100.0 * _LEAST_EFFICIENCY:.0f} to 100 %; {self.mass:g} kg "
            f"would be {100.0 * self.mass / load.value:.2g} %"
        ]

    def _model(self) -> Model | RoverModel:
        make = model_of if self.kind == "copter" else rover_model_of
        return make(self.logs, self.__getitem__, self.mass)

    def to_toml(self) -> str:
        """The airframe's file, with logs, firmware and intervals as comments."""
        model = self._model()
        notes = model.notes
        notes["mass"] = "as given" if self.mass else "not given: logs tell ratios only, all forces are by this mass"
        head = [f"Identified from {log.path.name}: {log.columns.firmware}, {log.seconds:.0f} s" for log in self.logs]
        head += [
            "",
            *map(str, self.estimates),
            "",
            "Properties without the word 'identified' are those of the airframe that",
        ]
        if self.kind == "copter":
            head += [
                "this one began with, by the logs' FRAME_CLASS and FRAME_TYPE, as far as forces go scaled to the mass;"
            ]
        else:
            head += [
                "this one began with, by the logs' SERVOn_FUNCTION, as far as lengths and forces go scaled to its size;"
            ]
        head += ["parameters are those of the log."]
        return vehicles.to_toml(self._with_intervals(model), head=head, notes=notes)

    def write(self, path: str | Path) -> None:
        """Write the file that ``--frame`` takes."""
        write_whole(path, self.to_toml(), IdentifyError, f"airframe file {str(path)!r}")


def identify(
    logs: str | Path | Sequence[str | Path],
    mass: float | None = None,
    progress: Progress | None = None,
    begins: Begins = silent,
    above: float = ABOVE_M,
) -> Identification:
    """The properties of the copter or rover that these logs are of.

    Args:
        logs: .bin or .tlog files of flights of one vehicle.
        mass: of the vehicle [kg].
        progress: called with how far each log is read.
        begins: called with which properties are worked on.
        above: height over the ground from which on a copter's flight counts [m].

    Raises:
        sitl.logs.tlog.LogError, IdentifyError: a log that cannot be used, named with the reason.
    """
    paths = [logs] if isinstance(logs, str | Path) else list(logs)
    if not paths:
        raise IdentifyError("no logs are given; at least one .bin is needed")
    if mass is not None and not (math.isfinite(mass) and 0.001 <= mass <= 1e4):
        raise IdentifyError(f"mass {mass} kg is outside 0.001 .. 10000")
    if not (math.isfinite(above) and 0.0 <= above <= 100.0):
        raise IdentifyError(f"height {above} m over the ground is outside 0 .. 100")
    found = [FlightLog(path, progress, above) for path in paths]
    kinds = {log.kind for log in found}
    if len(kinds) > 1:
        raise IdentifyError(
            f"logs of {' and '.join(f'a {kind}' for kind in sorted(kinds))}: they must be of one vehicle"
        )
    forms = {log.is_telemetry for log in found}
    if len(forms) > 1:
        words = ", ".join(f"{log.path.name} ({'telemetry' if log.is_telemetry else 'on-board'})" for log in found)
        raise IdentifyError(f"logs of two forms, which tell different properties: {words}; give those of one form")
    if found[0].kind == "rover":
        begins("drive, steering, battery, sensors")
    seen = estimates(found, begins) if found[0].kind == "copter" else rover_estimates(found)
    return Identification(tuple(found), tuple(judged(seen, found)), mass)
