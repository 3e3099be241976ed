# SPDX-License-Identifier: BSD-3-Clause
"""What a rover's battery gives: for the work of the motors, for their controllers, for the electronics.

Of a direct-current motor, work is force times the speed that the throttle stands for (``physics.native.rover.drive``);
logs have the force by the mass, so that what is found is the mass by the efficiency.
"""

from __future__ import annotations

import numpy as np

from ..estimate import NORMAL_95, Estimate
from ..regression import GUSTS_S, least_squares
from .fit import DriveFit
from .model import Array
from .sought import ELECTRONICS, FULL, LOAD

_SOUGHT = (LOAD, FULL, ELECTRONICS)
_SHARE = 0.05
"""Relative half of the interval for what the model leaves out."""
_OF_ALL = 0.01
"""Half of the interval by the greatest power: a value below it is as good as none."""
_MOST_RELATIVE = 0.3
_STANDS = 0.01
"""Speed below which a vehicle without throttle stands [m/s]."""
_LEAST = 20


def power(found: DriveFit) -> list[Estimate]:
    """The three parts of the battery's power."""
    data = found.data
    if not len(data.voltage.value):
        return [
            sought.hidden("no BAT, or no battery monitor (BATT_MONITOR) of voltage and current") for sought in _SOUGHT
        ]
    first, second = data.inputs()
    throttle = 0.5 * (abs(first) + abs(second)) if data.skids else abs(second)
    volts = data.voltage.value
    columns = np.stack([data.voltage.of(found.courses.work), data.voltage.of(throttle)], -1)
    standing = (abs(data.voltage.of(found.courses.speed)) < _STANDS) & (data.voltage.of(throttle) == 0.0)
    electronics = _electronics(data.current.value[standing])
    given = volts * (data.current.value - (electronics.value if electronics.is_observed else 0.0))
    size = np.maximum(np.percentile(abs(columns), 99.0, 0), 1e-9)
    x = columns / size
    if np.std(given) < 0.01 * np.mean(given):
        return [*(sought.hidden("the current did not change") for sought in (LOAD, FULL)), electronics]
    start = np.linalg.lstsq(x, given, rcond=None)[0]
    fit = least_squares(lambda p: given - x @ p, start, data.voltage.group, int(10 * GUSTS_S))
    most = float(np.percentile(given, 99.0))
    rolling, unsure = found.of(lambda model: model.rolling_resistance)  # what most of the work may be done against
    of_load = min(NORMAL_95 * unsure / max(rolling, 1e-9), 1.0)
    estimates = []
    for sought, value, error, scale in zip((LOAD, FULL), fit.value, fit.error, size):
        share = float(np.hypot(_SHARE, of_load)) if sought is LOAD else _SHARE
        half = float(np.linalg.norm([NORMAL_95 * error, share * value, _OF_ALL * most]))
        if value < half:
            estimates.append(
                sought.hidden(f"too little to tell: {value / scale:.3g} +- {half / scale:.2g} {sought.unit}")
            )
        elif half > _MOST_RELATIVE * value:
            estimates.append(sought.hidden(f"too uncertain: {value / scale:.3g} +- {half / scale:.2g} {sought.unit}"))
        else:
            ends = (value - half) / scale, (value + half) / scale
            estimates.append(sought.between(value / scale, *ends, f"{len(given)} rows of BAT"))
    return [*estimates, electronics]


def _electronics(current: Array) -> Estimate:
    """Of rows of a vehicle that stands with its motors off."""
    if len(current) < _LEAST:
        return ELECTRONICS.hidden(f"it stood for {len(current)} rows of BAT without throttle; {_LEAST} are needed")
    value, error = float(current.mean()), float(current.std() / np.sqrt(len(current) / 10.0))
    half = float(np.hypot(NORMAL_95 * error, 0.01 * value))
    if value <= 0.0 or half > _MOST_RELATIVE * value:
        return ELECTRONICS.hidden(f"too uncertain: {value:.3g} +- {half:.2g} A")
    return ELECTRONICS.between(value, value - half, value + half, f"{len(current)} rows of BAT, standing")
