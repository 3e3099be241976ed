# SPDX-License-Identifier: BSD-3-Clause
"""Curve of thrust over the motors' command, from how thrust follows the throttle that the firmware demands.

The firmware makes commands of demanded thrust by MOT_THST_EXPO, battery voltage and air density: with the right
properties thrust is proportional to the demand. How much more or less it changes, at a hover, tells the right
exponent. Flow through the rotors takes thrust away, and is a term besides. Gusts make the controllers answer, so that
the demand itself says nothing sure: instruments are the height that the navigation wanted, and the wanted lean, which
takes thrust.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.constants import GRAVITY
from .estimate import NORMAL_95, Estimate, Sought
from .estimated_motion import motion
from .expected import exponent, slope_of
from .log_streams import FlightLog
from .moments import WEAK, Block, fit
from .outputs import saturated
from .signals import means, spectrum, within

Array = np.ndarray[Any, Any]

EXPO = Sought(
    "thrust_expo", "", "MOT_THST_EXPO that makes thrust follow the demanded one, at a hover and with the battery's sag"
)

_RATE = 25.0
_BAND_HZ = (0.15, 2.5)
_EDGE_S = 5.0
_LEAST_S = 60.0
_LAGS_S = (0.0, 0.08, 0.2, 0.4, 0.8, 1.4)
_MOTORS_S = 0.02
"""Lag of thrust (assumed: it matters little below 2.5 Hz)."""
_MOST = 0.15
"""A wider half interval of the exponent is as good as none."""
SYSTEMATIC = 0.03
"""Half of the interval of the slope for what the model leaves out."""


def thrust_expo(logs: Sequence[FlightLog], hover: Estimate) -> Estimate:
    """The exponent, where the hover output was found."""
    if not hover.is_observed:
        return EXPO.hidden(f"it needs {hover.name}: {hover.reason}")
    usable = [log for log in logs if log.has("RATE", "IMU", "ATT", "XKF1", "CTUN") and log.stream("RATE").rate >= 20.0]
    parts = [part for log in usable for part in _parts(log)]
    seconds = sum(len(y) for _, y, _ in parts) / _RATE
    if seconds < _LEAST_S:
        return EXPO.hidden(f"{seconds:.0f} s in the air with RATE at 20 Hz; {_LEAST_S:.0f} s are needed")
    y, x, z = np.concatenate([p[1] for p in parts]), np.vstack([p[0] for p in parts]), np.vstack([p[2] for p in parts])
    groups = np.concatenate([np.full(len(p[1]), k) for k, p in enumerate(parts)])
    block = Block(lambda _: (y, x), z, groups, int(4.0 * _RATE))
    if (strength := block.strength(0)) < WEAK:
        return EXPO.hidden(f"height and lean changed too little (F {strength:.0f}): climb, sink, fly fast")
    found = fit([block], np.zeros(0), np.zeros(0))
    slope, log = float(found.values[0][0]), usable[0]
    low, high = log.parameter("MOT_SPIN_MIN", default=0.15), log.parameter("MOT_SPIN_MAX", default=0.95)
    command, expo = (hover.value - low) / (high - low), log.parameter("MOT_THST_EXPO", default=0.65)
    half = float(np.hypot(NORMAL_95 * found.errors[0][0], SYSTEMATIC))
    firmware = slope_of(expo, command)
    value, *ends = (exponent(firmware * (slope + side * half), command) for side in (0.0, -1.0, 1.0))
    if not max(ends) - min(ends) < 2.0 * _MOST:
        return EXPO.hidden(
            f"height and lean changed too little, or there are gusts: {min(ends):.2f} .. {max(ends):.2f}"
        )
    data = f"{seconds:.0f} s of RATE, IMU, XKF1, {_BAND_HZ[0]:g} to {_BAND_HZ[1]:g} Hz"
    return EXPO.between(value, min(ends), max(ends), data)


def _parts(log: FlightLog) -> list[tuple[Array, Array, Array]]:
    """(Demand and flow, thrust by weight, instruments) of each span."""
    rates, imu, attitude, control = log.stream("RATE"), log.stream("IMU", 0), log.stream("ATT"), log.stream("CTUN")
    busy = saturated(log)
    found = []
    for span in log.spans:
        edges = np.arange(span.begin, span.end, 1.0 / _RATE)
        if len(edges) < (2.0 * _EDGE_S + 10.0) * _RATE:
            continue
        thrust = -means(imu.time, imu["AccZ"], edges) / GRAVITY
        demand = means(rates.time, rates["AOut"], edges)
        demand /= np.median(demand / np.clip(thrust, 0.5, 2.0))
        moved = motion(log, edges)
        through = moved.along_body(moved.velocity)[:, 2]
        height = means(control.time, control["DAlt"], edges)
        lean = means(attitude.time, np.radians(np.stack([attitude["DesRoll"], attitude["DesPitch"]], -1)), edges)
        n = len(thrust)
        s = 2j * np.pi * np.fft.rfftfreq(n, 1.0 / _RATE)
        f = s.imag / (2.0 * np.pi)
        low = (f / _BAND_HZ[0]) ** 4
        band = low / (1.0 + low) / (1.0 + (f / _BAND_HZ[1]) ** 8)

        def passed(x: Array, by: Array | float = 1.0, band: Array = band, n: int = n) -> Array:
            return np.fft.irfft(band * by * spectrum(x), n)

        wanted = [passed(height, s * s), passed(1.0 / np.cos(lean).prod(1))]
        z = np.stack([np.roll(column, round(lag * _RATE)) for column in wanted for lag in _LAGS_S], -1)
        x = np.stack([passed(demand, 1.0 / (1.0 + s * _MOTORS_S)), passed(through), passed(through * abs(through))], -1)
        middle = 0.5 * (edges[1:] + edges[:-1])
        keep = (middle > span.begin + _EDGE_S) & (middle < span.end - _EDGE_S) & ~within(middle, busy)
        found.append((x[keep], passed(thrust)[keep], z[keep]))
    return found
