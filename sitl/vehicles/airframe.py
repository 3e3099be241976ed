# SPDX-License-Identifier: BSD-3-Clause
"""An airframe as data: figures under the names of ``figures.FIGURES_DTYPE``, and the parameters it is flown
with.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from .figures import FIGURES_DTYPE, ROTORS_MAX, THRUST_MOMENTUM, THRUST_SPEED_SQUARED

CCW, CW = 1.0, -1.0
"""Sense of rotation seen from above."""

Figures = Mapping[str, float | Sequence[float]]


class AirframeError(ValueError):
    """An airframe, or a figure of one, that cannot be used; the message names it, its value, the limits."""


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


_FROM_ROTORS = ("rotor_count", "rotor_x", "rotor_y", "rotor_z", "rotor_direction")

_NONE = (
    "angular_damping",
    "command_slew",
    "time_constant_up",
    "time_constant_down",
    "rotor_drag",
    "rolling_moment",
    "rotor_inertia",
    "speed_voltage",
    "momentum_drag",
    "battery_capacity",
    "battery_resistance",
    "avionics_current",
    "acc_scale_error",
    "gyro_scale_error",
)
_OPTIONAL: dict[str, float | Sequence[float]] = {
    **dict.fromkeys(_NONE, 0.0),
    "drag_area": (0.0, 0.0, 0.0),
    "mag_offset": (0.0, 0.0, 0.0),
    "substeps": 1,
    "noise_scale": 1.0,
    "efficiency": 1.0,
    "control_min": 0.0,
    "control_max": 1.0,
}
"""Figures that may be left out, and what they are then."""

_MODEL_FIGURES = {
    THRUST_SPEED_SQUARED: ("speed_max", "thrust_coefficient", "moment_coefficient"),
    THRUST_MOMENTUM: (
        "outflow_area",
        "outflow_speed_max",
        "thrust_expo",
        "yaw_lever",
        "disc_area",
        "power_by_thrust",
    ),
}

_TINY = 1e-12
_LIMITS: dict[str, tuple[float, float]] = {
    "mass": (1e-3, 1e4),
    "inertia": (1e-9, 1e6),
    "substeps": (1, 100),
    "thrust_model": (THRUST_SPEED_SQUARED, THRUST_MOMENTUM),
    "control_min": (0.0, 0.99),
    "control_max": (0.01, 1.0),
    "speed_max": (_TINY, 1e5),
    "thrust_coefficient": (_TINY, 1e3),
    "efficiency": (1e-3, 1.0),
    "outflow_area": (_TINY, 1e3),
    "outflow_speed_max": (_TINY, 400.0),
    "thrust_expo": (0.0, 1.0),
    "battery_voltage_full": (1.0, 1000.0),
    "tip_angle": (0.0, math.pi),
    "noise_scale": (0.0, 100.0),
    "gps_rate": (0.1, 20.0),
    "gps_delay": (0.0, 0.35),
    "gps_satellites": (0, 255),
    "gps_hdop": (0.0, 99.99),
    "gps_vdop": (0.0, 99.99),
    "baro_rate": (1.0, 200.0),
    "mag_rate": (1.0, 200.0),
}
"""Allowed range of each element; any other figure must be 0 or more, except offsets."""
_SIGNED = ("mag_offset",)


@dataclass(frozen=True)
class Airframe:
    """A vehicle as data.

    Args:
        name: what ``--frame`` takes.
        description: one line.
        rotors: in the order of the motor outputs.
        figures: every other field of FIGURES_DTYPE that the thrust model uses; drag, lag and the like may
            be left out.
        parameters: values under ArduPilot's names that differ from the firmware's defaults.

    Raises:
        AirframeError: a figure is missing, unknown, not a number or out of range.
    """

    name: str
    description: str
    rotors: tuple[Rotor, ...]
    figures: Figures
    parameters: Mapping[str, float] = field(default_factory=dict)

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
        for name in self.figures:
            if name not in _names() or name in _FROM_ROTORS:
                raise AirframeError(f"airframe {self.name!r}: unknown figure {name!r}")
        missing = [n for n in self._required() if n not in self.figures]
        if missing:
            raise AirframeError(f"airframe {self.name!r}: figures missing: {', '.join(missing)}")
        for name, value in self.figures.items():
            self._check(name, value)
        if self.value("control_min") >= self.value("control_max"):
            raise AirframeError(f"airframe {self.name!r}: control_min must be below control_max")

    def value(self, name: str) -> Any:
        """A figure by its name: a number, or a sequence for a vector."""
        return self.figures.get(name, _OPTIONAL.get(name, 0.0))

    def changed(self, **figures: float | Sequence[float]) -> Airframe:
        """A copy with some figures replaced."""
        return replace(self, figures={**self.figures, **figures})

    def record(self) -> np.ndarray[Any, Any]:
        """All figures as one FIGURES_DTYPE record (an array without dimensions)."""
        out = np.zeros((), FIGURES_DTYPE)
        for name in _names():
            if name not in _FROM_ROTORS:
                out[name] = self.value(name)
        out["rotor_count"] = len(self.rotors)
        for k, rotor in enumerate(self.rotors):
            for axis in ("x", "y", "z", "direction"):
                out[f"rotor_{axis}"][k] = getattr(rotor, axis)
        return out

    def _required(self) -> list[str]:
        model = self.figures.get("thrust_model")
        others = {n for m, names in _MODEL_FIGURES.items() if m != model for n in names}
        return [n for n in _names() if n not in _OPTIONAL and n not in _FROM_ROTORS and n not in others]

    def _check(self, name: str, value: float | Sequence[float]) -> None:
        shape = FIGURES_DTYPE[name].shape
        try:
            elements = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            elements = np.empty(0)
        if elements.shape != shape:
            wanted = f"{shape[0]} numbers" if shape else "one number"
            raise AirframeError(f"airframe {self.name!r}: {name} = {value!r}; expected {wanted}")
        low, high = _LIMITS.get(name, (-math.inf if name in _SIGNED else 0.0, math.inf))
        if not np.all(np.isfinite(elements)) or np.any(elements < low) or np.any(elements > high):
            raise AirframeError(f"airframe {self.name!r}: {name} = {value!r} is outside {low:g} .. {high:g}")


def _names() -> tuple[str, ...]:
    assert FIGURES_DTYPE.names is not None
    return FIGURES_DTYPE.names


def apply(airframe: Airframe, v: Any) -> None:
    """Write the airframe's figures into a vehicle's record (``v.physics.airframe``)."""
    v["physics"]["airframe"] = airframe.record()
