# SPDX-License-Identifier: BSD-3-Clause
"""What a rover's battery gives: for the work of the motors, for their controllers, for the electronics.

Of a direct-current motor, work is force times the speed that the throttle stands for (``physics.native.rover.drive``);
logs have the force by the mass, so that the figure is the mass by the efficiency.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..figure import NORMAL_95, Figure, Sought
from ..regression import GUSTS_S, least_squares
from .fit import DriveFit

Array = np.ndarray[Any, Any]

LOAD = Sought("mass_by_efficiency", "kg", "battery's power by the motors' work of each kilogram")
FULL = Sought("power_full", "W", "drawn at full throttle whatever the load")
ELECTRONICS = Sought("avionics_current", "A", "drawn by all that is no motor")
_SOUGHT = (LOAD, FULL, ELECTRONICS)
_SHARE = 0.03
"""Relative half of the interval for what the model leaves out."""
_OF_ALL = 0.01
"""Half of the interval by the greatest power: a figure below it is as good as none."""
_MOST_RELATIVE = 0.3


def power(found: DriveFit) -> list[Figure]:
    """The three parts of the battery's power."""
    data = found.data
    if not len(data.voltage.value):
        return [sought.hidden("no BAT, or no battery monitor (BATT_MONITOR) of voltage and current") for sought in _SOUGHT]
    first, second = data.inputs()
    throttle = 0.5 * (abs(first) + abs(second)) if data.skids else abs(second)
    volts = data.voltage.value
    columns = np.stack([data.voltage.of(found.courses.work), data.voltage.of(throttle), volts], -1)
    given = volts * data.current.value
    size = np.maximum(np.percentile(abs(columns), 99.0, 0), 1e-9)
    x = columns / size
    if np.std(given) < 0.01 * np.mean(given):
        return [sought.hidden("the current did not change") for sought in _SOUGHT]
    start = np.linalg.lstsq(x, given, rcond=None)[0]
    fit = least_squares(lambda p: given - x @ p, start, data.voltage.group, int(10 * GUSTS_S))
    most = float(np.percentile(given, 99.0))
    figures = []
    for sought, value, error, scale in zip(_SOUGHT, fit.value, fit.error, size):
        half = float(np.linalg.norm([NORMAL_95 * error, _SHARE * value, _OF_ALL * most]))
        if value < half:
            figures.append(sought.hidden(f"too little to tell: {value / scale:.3g} +- {half / scale:.2g} {sought.unit}"))
        elif half > _MOST_RELATIVE * value:
            figures.append(sought.hidden(f"too uncertain: {value / scale:.3g} +- {half / scale:.2g} {sought.unit}"))
        else:
            ends = (value - half) / scale, (value + half) / scale
            figures.append(sought.between(value / scale, *ends, f"{len(given)} rows of BAT"))
    return figures
