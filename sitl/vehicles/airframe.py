# SPDX-License-Identifier: BSD-3-Clause
"""An airframe as data: properties under the names of its kind, and the parameters it is driven with."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, TypeVar

import numpy as np

from ..deprecation import renamed
from ..errors import SitlError, did_you_mean
from .properties.property import Property

Value = float | Sequence[float]
Properties = Mapping[str, Value]
Intervals = Mapping[str, tuple[Value, Value]]
A = TypeVar("A", bound="Airframe")


class AirframeError(SitlError, ValueError):
    """An airframe, or a property of one, that cannot be used; the message names it, its value, the limits."""


@renamed("figures", "properties", since="0.2", removed_in="0.4")
@dataclass(frozen=True, kw_only=True)
class Airframe:
    """A vehicle as data: what all kinds have; make a ``CopterAirframe``, a ``RoverAirframe`` ...

    Args:
        name: what ``--frame`` takes.
        description: one line.
        properties: every property of the kind that its model uses; those with a default may be left out.
        parameters: values under ArduPilot's names that differ from the firmware's defaults.
        intervals: property -> low and high of its 95 % interval, of those that were measured; each is a number, or a
            vector of as many as the property has, and the property lies between them.
        file: path of the user's file that it was read from, for messages; "": of none.

    Raises:
        AirframeError: a property is missing, unknown, not a number or out of range.
    """

    kind: ClassVar[str] = ""
    """Name of the kind of vehicle."""
    known: ClassVar[tuple[Property, ...]] = ()
    """Properties that may be given."""
    dtype: ClassVar[np.dtype[Any]]
    """Record of the kind's properties."""
    model: ClassVar[str] = ""
    """Name of the property that says which of the others are needed."""

    name: str
    description: str
    properties: Properties
    parameters: Mapping[str, float] = field(default_factory=dict)
    intervals: Intervals = field(default_factory=dict)
    file: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        if not self.kind:
            raise AirframeError(f"airframe {self.name!r} is of no kind: make one of a class of its kind")
        names = {prop.name: prop for prop in self.known}
        for name in self.properties:
            if name not in names:
                raise AirframeError(f"airframe {self.name!r}: unknown property {name!r}{did_you_mean(name, names)}")
        missing = [prop.name for prop in self.known if self._needs(prop) and prop.name not in self.properties]
        if missing:
            raise AirframeError(f"airframe {self.name!r}: properties missing: {', '.join(missing)}")
        for name, value in self.properties.items():
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
            AirframeError: a property is missing, not a number or out of range.
        """
        model = record.get(cls.model)
        properties = {}
        for prop in cls.known:
            if prop.name not in record:
                raise AirframeError(f"airframe {name!r}: property missing: {prop.name}")
            value = record[prop.name]
            needed = prop.default is None and (not prop.models or model in prop.models)
            if needed or np.any(np.asarray(value) != (0.0 if prop.default is None else prop.default)):
                properties[prop.name] = value
        return cls(name=name, description="", properties=properties, parameters=dict(parameters), **cls._rest(record))

    @classmethod
    def _rest(cls, record: Mapping[str, Any]) -> dict[str, Any]:
        """What a kind has besides properties, as its arguments."""
        return {}

    @property
    def title(self) -> str:
        """What messages call it."""
        return f"airframe file {self.file!r}" if self.file else f"airframe {self.name}"

    def has(self, name: str) -> bool:
        """Whether airframes of this kind have a property of this name."""
        return any(prop.name == name for prop in self.known)

    def value(self, name: str) -> Any:
        """A property by its name: a number, or a sequence for a vector."""
        if name in self.properties:
            return self.properties[name]
        default = next(prop.default for prop in self.known if prop.name == name)
        return 0.0 if default is None else default

    def changed(self: A, **properties: float | Sequence[float]) -> A:
        """A copy with some properties replaced; what was measured of them is not true of these any more."""
        kept = {name: interval for name, interval in self.intervals.items() if name not in properties}
        return replace(self, properties={**self.properties, **properties}, intervals=kept)

    def record(self) -> np.ndarray[Any, Any]:
        """All properties, in their units, as one record of the kind (an array without dimensions)."""
        out = np.zeros((), self.dtype)
        for prop in self.known:
            out[prop.name] = self.value(prop.name)
        return out

    def _needs(self, prop: Property) -> bool:
        if prop.default is not None:
            return False
        return not prop.models or self.properties.get(self.model) in prop.models

    def _check_interval(self, name: str, interval: Any, names: Mapping[str, Property]) -> None:
        title = f"airframe {self.name!r}: interval of {name!r}"
        if name not in names:
            raise AirframeError(f"{title}: there is no such property{did_you_mean(name, names)}")
        if not isinstance(interval, list | tuple) or len(interval) != 2:
            raise AirframeError(f"{title} = {interval!r}; low and high are needed")
        for end in interval:
            self._check(names[name], end)
        low, value, high = (np.asarray(one, dtype=float) for one in (interval[0], self.value(name), interval[1]))
        if np.any(low > value) or np.any(value > high):
            raise AirframeError(f"{title} = {interval!r} does not hold the property, which is {self.value(name)!r}")

    def _check(self, prop: Property, value: float | Sequence[float]) -> None:
        title = f"airframe {self.name!r}: {prop.name} = {value!r}"
        shape = () if prop.length == 1 else (prop.length,)
        try:
            elements = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            elements = np.empty(0)
        if elements.shape != shape:
            raise AirframeError(f"{title}; expected {'one number' if prop.length == 1 else f'{prop.length} numbers'}")
        if not np.all(np.isfinite(elements)) or np.any(elements < prop.low) or np.any(elements > prop.high):
            unit = f" {prop.unit}" if prop.unit else ""
            raise AirframeError(f"{title} is outside {prop.low:g} .. {prop.high:g}{unit}")
        if prop.whole and math.floor(float(elements)) != float(elements):
            raise AirframeError(f"{title} is not a whole number")


def apply(airframe: Airframe, v: Any) -> None:
    """Write the airframe's properties into a vehicle's record (``v.physics.airframe``), which must be of its kind."""
    v["physics"]["airframe"] = airframe.record()
