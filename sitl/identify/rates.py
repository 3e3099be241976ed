# SPDX-License-Identifier: BSD-3-Clause
"""Angular acceleration by the rate controllers' output, lag and dead time of the motors, and rotational damping.

About each axis

    p' + damping p = effectiveness u(t - dead_time), through the motors' first-order lag

with p the rate and u the output of RATE. What is logged of p went through the low-pass of INS_GYRO_FILTER: u is sent
through the same one. Effectiveness changes with the thrust and with the air that comes through the rotors: terms of u
by both are besides, so that the value is that of a hover. Air that pushes the rotors aside turns the vehicle, too: the
specific force is a term; and about yaw a rotor that speeds up, by a term of u'.

In a closed loop disturbances are in u, too, and output and rate are logged more slowly than they change. So instruments
stand in. For lag and dead time, which all axes share, those are the wanted angles (ATT.DesRoll ...) at several delays.
Gusts are in these, too, through the position controller; so effectiveness and damping are found with the angles that
the path alone asks for (PSCN.DAN, PSCE.DAE), where it is logged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core.constants import GRAVITY
from .estimate import NORMAL_95, Begins, Estimate, Sought, silent
from .estimated_motion import motion
from .log_streams import FlightLog
from .moments import WEAK, Block, JointFit, fit
from .outputs import resolution, saturated
from .signals import means, spectrum, within

Array = np.ndarray[Any, Any]

BAND_HZ = (0.5, 8.0)
_LEAST_HZ = 20.0
_MOST_HZ = 100.0
"""Faster logs are averaged to this rate."""
_LEAST_S = 20.0
_EDGE_S = 2.0
"""Of each stretch, which filters need to settle."""
_LAGS_S = (0.0, 0.04, 0.08, 0.12, 0.18, 0.26, 0.36)
_SLOW_HZ = 1.0
"""Thrust and flow below this are taken as conditions."""
_LEAST_QUANTA = 0.15
"""With less, pulses of whole microseconds hold back part of the output: values were up to 10 % low."""
_MOST_RELATIVE = 0.2
_MOST_LAG_S = 0.015
"""A wider half interval of a lag is as good as none."""
SYSTEMATIC = {"roll": 0.02, "pitch": 0.02, "yaw": 0.035}
"""Relative half of the interval that is added for what the model leaves out: chosen on logs with known truth, as are
the others below."""
DAMPING, DAMPING_SHARE = 0.15, 0.1
_MOST_DAMPING = 1.0
SPIN_UP_SHARE = 0.08
TIMING_S = 0.004
"""Lag and dead time are distinguished no better."""

AXES = (("roll", "R", "Roll"), ("pitch", "P", "Pitch"), ("yaw", "Y", "Yaw"))
LAG = Sought("motor_lag", "s", "time constant of motors and their controllers")
DEAD = Sought("dead_time", "s", "from a logged output to the beginning of its effect")
SPIN_UP = Sought("yaw_spin_up", "s", "yaw torque of a changing output by that of the output itself")


def _effectiveness(axis: str) -> Sought:
    letter = axis[0].upper()
    return Sought(
        f"{axis}_effectiveness",
        "rad/s^2",
        f"angular acceleration by a unit of {axis} output (RATE.{letter}Out) in a hover",
    )


def _damping(axis: str) -> Sought:
    return Sought(f"{axis}_damping", "1/s", f"angular deceleration by {axis} rate")


def _all() -> list[Sought]:
    return [
        *(_effectiveness(axis) for axis, *_ in AXES),
        *(_damping(axis) for axis, *_ in AXES),
        SPIN_UP,
        LAG,
        DEAD,
    ]


class _Stretch(NamedTuple):
    """One span of a log on even times, in the frequency domain."""

    s: Array
    """2 pi i f."""
    band: Array
    gyro: Array
    """Low-pass of the rates."""
    keep: Array
    """Which samples count."""
    rate: Array
    outputs: tuple[Array, ...]
    """The output, and its products with the conditions."""
    aside: Array
    """Specific force that comes with the air's push on the rotors [m/s^2]."""
    wanted: Array
    """The attitude controller's angle."""
    path: Array
    """The angle that the path alone asks for, where it is logged."""
    conditions: Array

    def with_one_angle(self, by_path: bool) -> _Stretch:
        """Without the angle that is not used any more."""
        kept = self.path if by_path else self.wanted
        return self._replace(wanted=kept, path=kept)


class _Filters(NamedTuple):
    """Of all series of one length, in the frequency domain."""

    s: Array
    band: Array
    gyro: Array


def _filters(count: int, rate: float, cutoff: float) -> _Filters:
    """What the axes share.

    Args:
        count: of samples.
        rate: of these [Hz].
        cutoff: of the rates' low-pass [rad/s].
    """
    s = 2j * np.pi * np.fft.rfftfreq(count, 1.0 / rate)
    f = s.imag / (2.0 * np.pi)
    low, high = (f / BAND_HZ[0]) ** 4, (f / BAND_HZ[1]) ** 8
    band = low / (1.0 + low) / (1.0 + high)
    gyro = np.ones_like(s) if cutoff <= 0.0 else 1.0 / (1.0 + np.sqrt(2.0) * s / cutoff + (s / cutoff) ** 2)
    return _Filters(s, band, gyro)


def rates(logs: Sequence[FlightLog], begins: Begins = silent) -> list[Estimate]:
    """All that RATE reports."""
    usable = [log for log in logs if log.has("RATE", "ATT", "IMU", "XKF1") and log.stream("RATE").rate >= _LEAST_HZ]
    if not usable:
        had = [log.stream("RATE").rate for log in logs if log.has("RATE")]
        text = f"RATE is logged at {max(had):.0f} Hz" if had else "there is no RATE"
        reason = f"{text}; {_LEAST_HZ:.0f} Hz are needed (LOG_BITMASK: fast attitude)"
        return [sought.hidden(reason) for sought in _all()]
    rate = min(min(round(log.stream("RATE").rate) for log in usable), _MOST_HZ)
    lags: list[Block] = []
    chosen: dict[str, tuple[list[_Stretch], bool]] = {}
    """Stretches of an axis, and whether its instrument is the path: a block of all is large, and is made again."""
    weak: dict[str, str] = {}
    seconds, quantum = 0.0, max(resolution(log) for log in usable)
    common: dict[tuple[int, float], _Filters] = {}
    for axis, letter, angle in AXES:
        begins(f"{axis} rate")
        stretches = [part for log in usable for part in _stretches(log, letter, angle, rate, common)]
        seconds = sum(int(part.keep.sum()) for part in stretches) / rate
        if seconds < _LEAST_S:
            reason = f"{seconds:.0f} s in the air with RATE and free outputs; {_LEAST_S:.0f} s are needed"
            return [sought.hidden(reason) for sought in _all()]
        by_path = True
        moved, strength = _power(_block(stretches, axis == "yaw", rate, by_path))
        first = _block(stretches, axis == "yaw", rate, by_path=False)
        if moved < _LEAST_QUANTA * quantum or strength < WEAK:
            by_path = False  # the pilot flies, and the path asks for nothing
            moved, strength = _power(first)
        if moved < _LEAST_QUANTA * quantum:
            weak[axis] = (
                f"what was asked for moves the {axis} output by {moved:.1e} (RMS), less than {_LEAST_QUANTA:g} of a "
                f"microsecond of the motors' pulses, {quantum:.1e}: fly sharper turns, doublets, or SYSTEMID"
            )
        elif strength < WEAK:
            weak[axis] = f"the {axis} rate was moved too little (F {strength:.0f}): fly doublets, or SYSTEMID"
        else:
            lags.append(first)
            chosen[axis] = ([part.with_one_angle(by_path) for part in stretches], by_path)
        del first, stretches  # each is as large as a part of the log
    if not chosen:
        return [sought.hidden("; ".join(weak.values())) for sought in _all()]
    begins("lag of the motors")
    found = fit(lags, np.array([0.02, 0.005]), np.array([0.01, 0.005]))
    shared = np.maximum(found.shared, 0.0)
    lags.clear()
    begins("effectiveness and damping")
    blocks = (_block(parts, axis == "yaw", rate, by_path) for axis, (parts, by_path) in chosen.items())
    found = fit(blocks, shared, np.array([0.01, 0.005]), found)
    data = f"{seconds:.0f} s of RATE, ATT, {BAND_HZ[0]:g} to {BAND_HZ[1]:g} Hz"
    return _estimates(found, list(chosen), weak, data)


def _power(block: Block) -> tuple[float, float]:
    """How far the instruments move the output (RMS), and their F statistic."""
    return block.moved(1), block.strength(1)


def _estimates(found: JointFit, axes: list[str], weak: dict[str, str], data: str) -> list[Estimate]:
    result: dict[str, Estimate] = {}
    for axis, *_ in AXES:
        sought, damping = _effectiveness(axis), _damping(axis)
        if axis in weak:
            result[sought.name], result[damping.name] = sought.hidden(weak[axis]), damping.hidden(weak[axis])
            if axis == "yaw":
                result[SPIN_UP.name] = SPIN_UP.hidden(weak[axis])
            continue
        k = axes.index(axis)
        value, error = found.values[k], found.errors[k]
        half = float(np.hypot(NORMAL_95 * error[1], SYSTEMATIC[axis] * value[1]))
        if value[1] <= 0.0 or half > _MOST_RELATIVE * value[1]:
            reason = f"the {axis} rate was moved too little, or there is much turbulence: {value[1]:.3g} +- {half:.2g}"
            result[sought.name] = sought.hidden(reason)
        else:
            result[sought.name] = sought.between(value[1], value[1] - half, value[1] + half, data)
        half = float(np.linalg.norm([NORMAL_95 * error[0], DAMPING, DAMPING_SHARE * value[0]]))
        if half > _MOST_DAMPING:
            result[damping.name] = damping.hidden(f"too uncertain: {value[0]:.2f} +- {half:.2f} 1/s")
        else:
            result[damping.name] = damping.between(value[0], value[0] - half, value[0] + half, data)
        if axis == "yaw":
            ratio = value[-1] / value[1]
            half = float(np.hypot(NORMAL_95 * error[-1] / value[1], SPIN_UP_SHARE * ratio))
            hidden = result[sought.name].reason or (f"{ratio:.3f} +- {half:.3f} s" if half > 0.1 else "")
            if hidden:
                result[SPIN_UP.name] = SPIN_UP.hidden(hidden)
            else:
                result[SPIN_UP.name] = SPIN_UP.between(ratio, ratio - half, ratio + half, data)
    for sought, value, error in zip((LAG, DEAD), found.shared, found.shared_errors):
        half = float(np.hypot(NORMAL_95 * error, TIMING_S))
        if half > _MOST_LAG_S:
            reason = (
                f"too uncertain: {1e3 * value:.0f} +- {1e3 * half:.0f} ms; fast movements tell it (SYSTEMID, doublets)"
            )
            result[sought.name] = sought.hidden(reason)
        else:
            high = max(value + half, 1e-4)
            result[sought.name] = sought.between(max(value, 0.0), max(value - half, 0.0), high, data)
    return [result[sought.name] for sought in _all()]


def _stretches(
    log: FlightLog, letter: str, angle: str, rate: float, shared: dict[tuple[int, float], _Filters]
) -> list[_Stretch]:
    """Of an axis; ``shared`` keeps what the axes have in common, by (samples, cutoff [rad/s])."""
    table, attitude, imu = log.stream("RATE"), log.stream("ATT"), log.stream("IMU", 0)
    cutoff = 2.0 * np.pi * log.parameter("INS_GYRO_FILTER", default=20.0)
    busy = saturated(log)
    found = []
    for span in log.spans:
        edges = np.arange(span.begin, span.end, 1.0 / rate)
        if len(edges) < (2.0 * _EDGE_S + 4.0) * rate:
            continue
        u = means(table.time, table[f"{letter}Out"], edges)
        p = means(table.time, np.radians(table[letter]), edges)
        wanted = means(attitude.time, np.unwrap(np.radians(attitude[f"Des{angle}"])), edges)
        path = _path(log, angle, edges, wanted)
        n = len(u)
        s, band, gyro = shared[n, cutoff] = shared.get((n, cutoff)) or _filters(n, rate, cutoff)
        slow = 1.0 / (1.0 + (s.imag / (2.0 * np.pi * _SLOW_HZ)) ** 4)

        def smooth(x: Array, slow: Array = slow, n: int = n) -> Array:
            return np.fft.irfft(slow * np.fft.rfft(x), n)

        thrust = smooth(-means(imu.time, imu["AccZ"], edges) / GRAVITY - 1.0)
        moved = motion(log, edges)
        through = smooth(moved.along_body(moved.velocity)[:, 2])
        conditions = np.stack([thrust, through], -1)
        middle = 0.5 * (edges[1:] + edges[:-1])
        keep = (middle > span.begin + _EDGE_S) & (middle < span.end - _EDGE_S) & ~within(middle, busy)
        outputs = (spectrum(u), *(spectrum(u * column) for column in conditions.T))
        aside = means(imu.time, imu["AccX" if letter == "P" else "AccY"], edges)
        found.append(
            _Stretch(
                s, band, gyro, keep, spectrum(p), outputs, spectrum(aside), spectrum(wanted), spectrum(path), conditions
            )
        )
    return found


def _path(log: FlightLog, angle: str, edges: Array, otherwise: Array) -> Array:
    """The angle [rad] that the path's own acceleration asks for: gusts have no part in it."""
    if angle == "Yaw" or not log.has("PSCN", "PSCE"):
        return otherwise
    north, east = (
        means(table.time, table[f"DA{axis}"], edges)
        for axis, table in ((axis, log.stream(f"PSC{axis}")) for axis in "NE")
    )
    yaw = motion(log, edges).yaw
    forward, right = np.cos(yaw) * north + np.sin(yaw) * east, np.cos(yaw) * east - np.sin(yaw) * north
    return (right if angle == "Roll" else -forward) / GRAVITY


def _block(stretches: list[_Stretch], spins_up: bool, rate: float, by_path: bool) -> Block:
    """Moments of an axis: angular acceleration, then -rate, output by conditions, and the output's change."""
    count = len(_LAGS_S) + 4 * stretches[0].conditions.shape[1] + (not spins_up)
    length = sum(int(part.keep.sum()) for part in stretches)
    instruments = np.empty((length, count), order="F")
    at = 0
    for part in stretches:
        n = len(part.keep)
        rows = slice(at, at := at + int(part.keep.sum()))
        z = np.fft.irfft(part.s * (part.path if by_path else part.wanted) * part.band, n)
        delayed = [np.roll(z, round(lag * rate)) for lag in _LAGS_S]
        columns_of = [*delayed, *(z * c for c in part.conditions.T for z in delayed[1:5])]
        if not spins_up:
            columns_of.append(np.fft.irfft(part.band * part.gyro * part.aside, n))
        for k, column in enumerate(columns_of):
            instruments[rows, k] = column[part.keep]

    none = np.zeros(0)
    stretches = [part._replace(wanted=none, path=none) for part in stretches]  # what is left is kept by the block

    def columns(shared: Array) -> tuple[Array, Array]:
        lag, dead = shared
        left, right = np.empty(length), np.empty((length, 3 + stretches[0].conditions.shape[1]))
        at = 0
        for part in stretches:
            n, keep = len(part.keep), part.keep
            rows = slice(at, at := at + int(keep.sum()))
            motor = part.band * part.gyro * np.exp(-part.s * dead) / (1.0 + part.s * lag)
            left[rows] = np.fft.irfft(part.s * part.band * part.rate, n)[keep]
            right[rows, 0] = -np.fft.irfft(part.band * part.rate, n)[keep]
            for k, u in enumerate(part.outputs, 1):
                right[rows, k] = np.fft.irfft(motor * u, n)[keep]
            last = part.s * motor * part.outputs[0] if spins_up else part.band * part.gyro * part.aside
            right[rows, -1] = np.fft.irfft(last, n)[keep]
        return left, right

    groups = np.concatenate([np.full(int(part.keep.sum()), k) for k, part in enumerate(stretches)])
    return Block(columns, instruments, groups, int(2.0 * rate))
