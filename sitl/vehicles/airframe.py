# SPDX-License-Identifier: BSD-3-Clause
"""An airframe as data: figures under the names of its kind (``figures``), and the parameters it is driven with."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, TypeVar

import numpy as np

from ..errors import SitlError, did_you_mean
from .figures.figure import Figure

Value = float | Sequence[float]
Figures = Mapping[str, Value]
Intervals = Mapping[str, tuple[Value, Value]]
A = TypeVar("A", bound="Airframe")


class AirframeError(SitlError, ValueError):
    """An airframe, or a figure of one, that cannot be used; the message names it, its value, the limits."""


@dataclass(frozen=True, kw_only=True)
class Airframe:
    """A vehicle as data: what all kinds have; make a ``CopterAirframe``, a ``RoverAirframe`` ...

    Args:
        name: what ``--frame`` takes.
        description: one line.
        figures: every figure of the kind that its model uses; those with a default may be left out.
        parameters: values under ArduPilot's names that differ from the firmware's defaults.
        intervals: figure -> low and high of its 95 % interval, of those that were measured; each is a number, or a
            vector of as many as the figure has, and the figure lies between them.
        file: path of the user's file that it was read from, for messages; "": of none.

    Raises:
        AirframeError: a figure is missing, unknown, not a number or out of range.
    """

    kind: ClassVar[str] = ""
    """Name of the kind of vehicle."""
    known: ClassVar[tuple[Figure, ...]] = ()
    """Figures that may be given."""
    dtype: ClassVar[np.dtype[Any]]
    """Record of the kind's figures."""
    model: ClassVar[str] = ""
    """Name of the figure that says which of the others are needed."""

    name: str
    description: str
    figures: Figures
    parameters: Mapping[str, float] = field(default_factory=dict)
    intervals: Intervals = field(default_factory=dict)
    file: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        if not self.kind:
            raise AirframeError(f"airframe {self.name!r} is of no kind: make one of a class of its kind")
        names = {figure.name: figure for figure in self.known}
        for name in self.figures:
            if name not in names:
                raise AirframeError(f"airframe {self.name!r}: unknown figure {name!r}{did_you_mean(name, names)}")
        missing = [figure.name for figure in self.known if self._needs(figure) and figure.name not in self.figures]
        if missing:
            raise AirframeError(f"airframe {self.name!r}: figures missing: {', '.join(missing)}")
        for name, value in self.figures.items():
            self._check(names[name], value)
        for name, interval in self.intervals.items():
            self._check_interval(name, interval, names)
        if "lidar_rays" in names and self.value("lidar_samples") > self.value("lidar_rays"):
            raise AirframeError(
                f"airframe {self.name!r}: lidar_samples = {self.value('lidar_samples')!r}; at most lidar_rays, "
                f"which is {self.value('lidar_rays')!r}"
            )

    @classmethod
    def of_record(cls: type[A], name: str, record: Mapping[str, Any], parameters: Mapping[str, float]) -> A:
        """The airframe that a record was written from (``record``), given as plain numbers by name.

        Raises:
            AirframeError: a figure is missing, not a number or out of range.
        """
        model = record.get(cls.model)
        figures = {}
        for figure in cls.known:
            if figure.name not in record:
                raise AirframeError(f"airframe {name!r}: figure missing: {figure.name}")
            value = record[figure.name]
            needed = figure.default is None and (not figure.models or model in figure.models)
            if needed or np.any(np.asarray(value) != (0.0 if figure.default is None else figure.default)):
                figures[figure.name] = value
        return cls(name=name, description="", figures=figures, parameters=dict(parameters), **cls._rest(record))

    @classmethod
    def _rest(cls, record: Mapping[str, Any]) -> dict[str, Any]:
        """What a kind has besides figures, as its arguments."""
        return {}

    @property
    def title(self) -> str:
        """What messages call it."""
        return f"airframe file {self.file!r}" if self.file else f"airframe {self.name}"

    def has(self, name: str) -> bool:
        """Whether airframes of this kind have a figure of this name."""
        return any(figure.name == name for figure in self.known)

    def value(self, name: str) -> Any:
        """A figure by its name: a number, or a sequence for a vector."""
        if name in self.figures:
            return self.figures[name]
        default = next(figure.default for figure in self.known if figure.name == name)
        return 0.0 if default is None else default

    def changed(self: A, **figures: float | Sequence[float]) -> A:
        """A copy with some figures replaced; what was measured of them is not true of these any more."""
        kept = {name: interval for name, interval in self.intervals.items() if name not in figures}
        return replace(self, figures={**self.figures, **figures}, intervals=kept)

    def record(self) -> np.ndarray[Any, Any]:
        """All figures, in their units, as one record of the kind (an array without dimensions)."""
        out = np.zeros((), self.dtype)
        for figure in self.known:
            out[figure.name] = self.value(figure.name)
        return out

    def _needs(self, figure: Figure) -> bool:
        if figure.default is not None:
            return False
        return not figure.models or self.figures.get(self.model) in figure.models

    def _check_interval(self, name: str, interval: Any, names: Mapping[str, Figure]) -> None:
        title = f"airframe {self.name!r}: interval of {name!r}"
        if name not in names:
            raise AirframeError(f"{title}: there is no such figure{did_you_mean(name, names)}")
        if not isinstance(interval, list | tuple) or len(interval) != 2:
            raise AirframeError(f"{title} = {interval!r}; low and high are needed")
        for end in interval:
            self._check(names[name], end)
        low, value, high = (np.asarray(one, dtype=float) for one in (interval[0], self.value(name), interval[1]))
        if np.any(low > value) or np.any(value > high):
            raise AirframeError(f"{title} = {interval!r} does not hold the figure, which is {self.value(name)!r}")

    def _check(self, figure: Figure, value: float | Sequence[float]) -> None:
        title = f"airframe {self.name!r}: {figure.name} = {value!r}"
        shape = () if figure.length == 1 else (figure.length,)
        try:
            elements = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            elements = np.empty(0)
        if elements.shape != shape:
            raise AirframeError(
                f"{title}; expected {'one number' if figure.length == 1 else f'{figure.length} numbers'}"
            )
        if not np.all(np.isfinite(elements)) or np.any(elements < figure.low) or np.any(elements > figure.high):
            unit = f" {figure.unit}" if figure.unit else ""
            raise AirframeError(f"{title} is outside {figure.low:g} .. {figure.high:g}{unit}")
        if figure.whole and math.floor(float(elements)) != float(elements):
            raise AirframeError(f"{title} is not a whole number")


def apply(airframe: Airframe, v: Any) -> None:
    """Write the airframe's figures into a vehicle's record (``v.physics.airframe``), which must be of its kind."""
    v["physics"]["airframe"] = airframe.record()
