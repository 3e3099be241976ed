# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter as data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..deprecation import renamed
from .airframe import Airframe, AirframeError
from .properties.multicopter import MODEL, ROTORS_MAX, Hubs, Properties
from .properties.property import properties

CCW, CW = 1.0, -1.0
"""Sense of rotation seen from above."""


class Rotor(NamedTuple):
    """One rotor, in the order of the autopilot's motor outputs."""

    x: float
    """Position in the body frame, forward [m]."""
    y: float
    """To the right [m]."""
    z: float
    """Down [m]."""
    direction: float
    """CCW or CW."""


@renamed("figures", "properties", since="0.2", removed_in="0.4")
@dataclass(frozen=True, kw_only=True)
class CopterAirframe(Airframe):
    """A multicopter: ``properties.copter``, and rotors in the order of the motor outputs."""

    kind: ClassVar[str] = "copter"
    known = tuple(prop for prop in properties(Properties) if prop.name not in Hubs.fields)
    dtype = Properties.dtype
    model = MODEL

    rotors: tuple[Rotor, ...]

    def __post_init__(self) -> None:
        if not 1 <= len(self.rotors) <= ROTORS_MAX:
            count = len(self.rotors)
            raise AirframeError(f"airframe {self.name!r}: {count} rotors; allowed 1 .. {ROTORS_MAX}")
        for number, rotor in enumerate(self.rotors, 1):
            if not all(isinstance(value, int | float) and math.isfinite(value) for value in rotor):
                raise AirframeError(f"airframe {self.name!r}: rotor {number} is {tuple(rotor)}; expected four numbers")
            if rotor.direction not in (CCW, CW):
                raise AirframeError(
                    f"airframe {self.name!r}: rotor {number} turns {rotor.direction}; CCW is 1.0, CW is -1.0"
                )
        super().__post_init__()
        if self.value("control_min") >= self.value("control_max"):
            raise AirframeError(f"airframe {self.name!r}: control_min must be below control_max")

    @classmethod
    def _rest(cls, record: Mapping[str, Any]) -> dict[str, Any]:
        """The rotors, from the hubs."""
        hubs = [record[f"rotor_{axis}"] for axis in ("x", "y", "z", "direction")]
        return {"rotors": tuple(Rotor(*hub) for hub in zip(*hubs, strict=True))[: int(record["rotor_count"])]}

    def record(self) -> np.ndarray[Any, Any]:
        """All properties and the rotors, in their units, as one record."""
        out = super().record()
        out["rotor_count"] = len(self.rotors)
        for k, rotor in enumerate(self.rotors):
            for axis in ("x", "y", "z", "direction"):
                out[f"rotor_{axis}"][k] = getattr(rotor, axis)
        return out
