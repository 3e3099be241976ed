# SPDX-License-Identifier: BSD-3-Clause
"""The wind as properties of a vehicle whose physics is here: they can be changed from episode to episode."""

from __future__ import annotations

from collections.abc import Iterable

from sitl.move import WIND
from sitl.vehicles.airframe import Value

PARAMETERS = {
    "wind_speed": "SIM_WIND_SPD",
    "wind_direction": "SIM_WIND_DIR",
    "wind_turbulence": "SIM_WIND_TURB",
}
PROPERTIES = {prop.name: prop for prop in WIND}
"""Not every kind of vehicle feels wind."""
assert PROPERTIES.keys() == PARAMETERS.keys()


def wind_and_own(properties: Iterable[tuple[str, Value]]) -> tuple[dict[str, float], dict[str, Value]]:
    """Properties that were changed, apart: the parameters of the wind, and the airframe's own properties."""
    wind: dict[str, float] = {}
    own: dict[str, Value] = {}
    for name, value in properties:
        if name in PARAMETERS:
            wind[PARAMETERS[name]] = float(value)  # type: ignore[arg-type]
        else:
            own[name] = value
    return wind, own
