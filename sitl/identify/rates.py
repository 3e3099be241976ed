# SPDX-License-Identifier: BSD-3-Clause
"""Angular acceleration by the rate controllers' output, by two-stage least squares.

Output and rate are logged more slowly than they change, so that both have errors, and in a closed loop these errors
are in each other. What the pilot or the mission asked for (RATE.RDes) moves the vehicle and has no part in them: it is
the instrument. All signals pass the same filter.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import signal

from .figure import NORMAL_95, Figure, Sought
from .flight import FlightLog
from .regression import Instrumented, instrumented

Array = np.ndarray[Any, Any]

BAND_HZ = (0.5, 5.0)
_LEAST_HZ = 20.0
_LEAST_S = 20.0
_DELAYS_S = np.arange(-0.01, 0.07, 0.01)
_LAGS_S = (0.0, 0.04, 0.08, 0.14, 0.22, 0.32)
_WEAK = 10.0
_LEAST_EXPLAINED = 0.75
"""Below, values of logs with known truth are up to 25 % low."""
SYSTEMATIC = 0.12
"""Half of the interval that is added for what the model leaves out (lags of motors and filters, aliasing), relative:
on logs with known truth, values are 2 to 8 % low."""


def effectiveness(logs: Sequence[FlightLog], axis: str, letter: str) -> Figure:
    """Angular acceleration by a unit of the rate controller's output about an axis [rad/s^2]."""
    sought = Sought(
        f"{axis}_effectiveness", "rad/s^2", f"angular acceleration by a unit of {axis} output (RATE.{letter}Out)"
    )
    if axis == "yaw":
        return sought.hidden("the torque of rotors that speed up is not told apart from that of their drag yet")
    usable = [log for log in logs if log.has("RATE") and log.stream("RATE").rate >= _LEAST_HZ]
    if not usable:
        rates = [log.stream("RATE").rate for log in logs if log.has("RATE")]
        had = f"RATE is logged at {max(rates):.0f} Hz" if rates else "there is no RATE"
        return sought.hidden(f"{had}; {_LEAST_HZ:.0f} Hz are needed (LOG_BITMASK: fast attitude)")
    best: Instrumented | None = None
    seconds = 0.0
    for delay in _DELAYS_S:
        rows = [part for log in usable for part in _parts(log, letter, float(delay))]
        seconds = sum(len(part[0]) / rate for *part, rate in rows)
        if seconds < _LEAST_S:
            return sought.hidden(f"{seconds:.0f} s in the air with RATE; {_LEAST_S:.0f} s are needed")
        x, y, z = (np.concatenate([row[k] for row in rows]) for k in range(3))
        groups = np.concatenate([np.full(len(row[0]), k) for k, row in enumerate(rows)])
        found = instrumented(y, x, z, groups, int(2.0 * rows[0][3]), 1)
        if best is None or found.objective < best.objective:
            best = found
    assert best is not None
    value, error = float(best.value[0]), float(np.sqrt(best.covariance[0, 0]))
    explained = 1.0 - float(best.residual @ best.residual) / float(y @ y)
    if explained < _LEAST_EXPLAINED:
        share = f"{100.0 * max(explained, 0.0):.0f} % of the angular acceleration follow the output"
        return sought.hidden(
            f"{share}, {100.0 * _LEAST_EXPLAINED:.0f} % are needed: there is much turbulence or vibration"
        )
    if best.strength < _WEAK or value <= 0.0 or NORMAL_95 * error > 0.25 * value:
        return sought.hidden(f"the {axis} rate was moved too little (F {best.strength:.0f}): fly doublets, or SYSTEMID")
    half = float(np.hypot(NORMAL_95 * error, SYSTEMATIC * value))
    return sought.between(
        value, value - half, value + half, f"{seconds:.0f} s of RATE, {BAND_HZ[0]} to {BAND_HZ[1]} Hz"
    )


def _parts(log: FlightLog, letter: str, delay: float) -> list[tuple[Array, Array, Array, float]]:
    """(Regressors, angular acceleration, instruments, rate) of each span."""
    table = log.stream("RATE")
    rate = min(round(table.rate), 100)
    output = table[f"{letter}Out"]
    turned = np.radians(np.stack([table[letter], table[f"{letter}Des"]], -1))
    band = signal.butter(2, BAND_HZ, "band", fs=rate, output="sos")
    found = []
    for span in log.spans:
        time = np.arange(span.begin, span.end, 1.0 / rate)
        if len(time) < 8 * rate:
            continue
        columns = [np.interp(time - delay, table.time, output)]
        columns += [np.interp(time, table.time, column) for column in turned.T]
        u, y, wanted = signal.sosfiltfilt(band, np.stack(columns, -1), axis=0).T
        keep = slice(2 * rate, -2 * rate)
        z = np.stack([np.roll(wanted, round(lag * rate)) for lag in _LAGS_S], -1)
        x = np.stack([_smooth(u), _smooth(y)], -1)
        found.append((x[keep], (np.gradient(y, 1.0 / rate))[keep], z[keep], float(rate)))
    return found


def _smooth(x: Array) -> Array:
    """Mean over the two steps that a central difference spans (Simpson)."""
    return np.concatenate([x[:1], (x[:-2] + 4.0 * x[1:-1] + x[2:]) / 6.0, x[-1:]])
