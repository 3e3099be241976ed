# SPDX-License-Identifier: BSD-3-Clause
"""A rover's logs cut into stretches of some seconds, each of which a model drives anew from what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy import signal

from ..log_streams import FlightLog
from ..signals import Span
from .courses import STEP_S, Courses
from .outputs import Output, is_skid, outputs

Array = np.ndarray[Any, Any]

LENGTH_S = 8.0
"""Of a stretch: errors of the model add up no longer."""
SETTLES_S = 0.5
"""Wheels and servo may begin other than the model has them."""
_GAP_S = 0.5
_MOST_HZ = 50.0
_SAMPLES = round(LENGTH_S / STEP_S)


@dataclass(frozen=True)
class Series:
    """What was measured of one quantity in all stretches.

    Args:
        value: (n,)
        stretch: of each sample (n,).
        sample: in samples of the course, with what is between (n,).
        group: log of each sample, of which a constant is taken off.
        cutoff: of the low-pass that is behind what was measured [Hz]; 0: none.
    """

    value: Array
    stretch: Array
    sample: Array
    group: Array
    cutoff: float = 0.0

    def of(self, course: Array) -> Array:
        """A course (stretches, samples) at these samples."""
        if self.cutoff > 0.0:
            b, a = signal.butter(2, 2.0 * STEP_S * self.cutoff)
            settled = signal.lfilter_zi(b, a)[None, :] * course[:, :1]
            course, _ = signal.lfilter(b, a, course, 1, settled)
        k = np.clip(self.sample.astype(int), 0, course.shape[1] - 2)
        part = self.sample - k
        return (1.0 - part) * course[self.stretch, k] + part * course[self.stretch, k + 1]

    def free(self, residual: Array) -> Array:
        """A residual without its mean in each log: sensors have biases."""
        found = residual.copy()
        for group in np.unique(self.group):
            found[self.group == group] -= residual[self.group == group].mean()
        return found


_MEASURED = ("speed", "aside", "yaw_rate", "accel", "voltage", "current")
_NOTHING = Series(np.zeros(0), np.zeros(0, int), np.zeros(0), np.zeros(0, int))


@dataclass(frozen=True)
class Stretches:
    """Of logs that all steer alike.

    Args:
        begin: of each stretch [s] (stretches,).
        log: of which it is.
        outputs: of each log, two.
        speed: forward [m/s], yaw_rate [rad/s], accel [m/s^2]: what was measured.
        aside: velocity to the right [m/s], as ``speed``.
        voltage, current: of the battery [V], [A]; empty when no log has them.
        start_speed, start_yaw_rate: at the beginning of each stretch (stretches,).
        skids: whether it steers by its left and right motors.
    """

    begin: Array
    log: Array
    outputs: tuple[tuple[Output, Output], ...]
    speed: Series
    yaw_rate: Series
    accel: Series
    aside: Series
    voltage: Series
    current: Series
    start_speed: Array
    start_yaw_rate: Array
    skids: bool
    _inputs: list[Array] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        """[s]"""
        return LENGTH_S * len(self.begin)

    @property
    def times(self) -> Array:
        """Of the samples of all courses [s] (stretches, samples), of the middles of their ticks."""
        return self.begin[:, None] + STEP_S * (np.arange(_SAMPLES) + 0.5)

    def inputs(self) -> tuple[Array, Array]:
        """Both outputs at ``times``."""
        if not self._inputs:
            times = self.times
            for channel in (0, 1):
                found = np.zeros(times.shape)
                for k, pair in enumerate(self.outputs):
                    own = times[self.log == k]
                    found[self.log == k] = pair[channel].at(own.ravel(), STEP_S).reshape(own.shape)
                self._inputs.append(found)
        return self._inputs[0], self._inputs[1]

    def with_outputs(self, found: Sequence[tuple[Output, Output]]) -> Stretches:
        """The same with steps at other onsets."""
        return replace(self, outputs=tuple(found), _inputs=[])

    def measured(self) -> tuple[Series, Series, Series]:
        """Speed, yaw rate and acceleration."""
        return self.speed, self.yaw_rate, self.accel

    def modelled(self, courses: Courses) -> tuple[Array, Array, Array]:
        """The same of a model."""
        before = np.concatenate([self.start_speed[:, None], courses.speed[:, :-1]], 1)
        return (
            self.speed.of(courses.speed),
            self.yaw_rate.of(courses.yaw_rate),
            self.accel.of((courses.speed - before) / STEP_S),
        )


def stretches(logs: Sequence[FlightLog]) -> Stretches | str:
    """Of these logs; a text says what they lack."""
    columns: dict[str, list[list[Array]]] = {name: [] for name in _MEASURED}
    begins, numbers, pairs, starts = [], [], [], []
    skids = is_skid(logs[0])
    cutoff = accel_cutoff = 0.0
    count = 0
    for number, log in enumerate(logs):
        pair = outputs(log)
        if pair is None:
            return (
                "no RCOU with an output of steering and one of throttle (SERVOn_FUNCTION 26 and 70), or of left and "
                "right motors (73 and 74)"
            )
        if not log.has("IMU", "ATT", "XKF1"):
            return "IMU, ATT and XKF1 are needed"
        pairs.append(pair)
        imu, moved = log.stream("IMU", 0), _body_velocity(log)
        step = max(round(imu.rate / _MOST_HZ), 1)
        imu = imu.where(np.arange(len(imu)) % step == 0)
        if "gym-sitl" not in log.columns.firmware:  # ours logs what no filter was over
            cutoff = log.parameter("INS_GYRO_FILTER", default=4.0)
            accel_cutoff = log.parameter("INS_ACCEL_FILTER", default=10.0)
        measured = {
            "speed": moved[:2],
            "aside": (moved[0], moved[2]),
            "yaw_rate": (imu.time, imu["GyrZ"]),
            "accel": (imu.time, imu["AccX"]),
            **_battery(log),
        }
        for span in log.spans:
            for begin in np.arange(span.begin, span.end - LENGTH_S, LENGTH_S):
                piece = Span(float(begin), float(begin) + LENGTH_S)
                if not all(_is_whole(time, piece) for time in (imu.time, moved[0], pair[0].time)):
                    continue
                for name, (time, value) in measured.items():
                    inside = (time >= begin + SETTLES_S) & (time < piece.end)
                    # A sample is that of its ticks' end, an acceleration the mean over them.
                    sample = (time[inside] - begin) / STEP_S - (0.5 if name == "accel" else 1.0)
                    columns[name].append(
                        [value[inside], np.full(len(sample), count), sample, np.full(len(sample), number)]
                    )
                starts.append([_near(begin, moved[0], moved[1]), _near(begin, imu.time, imu["GyrZ"])])
                begins.append(float(begin))
                numbers.append(number)
                count += 1
    if not count:
        return f"no {LENGTH_S:.0f} s in one piece with RCOU, IMU, ATT and XKF1"
    series = {name: _series(rows) if rows else _NOTHING for name, rows in columns.items()}
    first, second = np.array(starts).T
    return Stretches(
        begin=np.array(begins),
        log=np.array(numbers),
        outputs=tuple(pairs),
        speed=series["speed"],
        yaw_rate=replace(series["yaw_rate"], cutoff=cutoff),
        accel=replace(series["accel"], cutoff=accel_cutoff),
        aside=series["aside"],
        voltage=series["voltage"],
        current=series["current"],
        start_speed=first,
        start_yaw_rate=second,
        skids=skids,
    )


def _body_velocity(log: FlightLog) -> tuple[Array, Array, Array]:
    """Times [s], velocity forward and to the right [m/s], as the estimator had them."""
    table, attitude = log.estimate(), log.stream("ATT")
    yaw = np.interp(table.time, attitude.time, np.unwrap(np.radians(attitude["Yaw"])))
    north, east = table["VN"], table["VE"]
    return table.time, np.cos(yaw) * north + np.sin(yaw) * east, np.cos(yaw) * east - np.sin(yaw) * north


def _series(rows: list[list[Array]]) -> Series:
    value, stretch, sample, group = (np.concatenate(column) for column in zip(*rows))
    return Series(value, stretch, sample, group)


def _battery(log: FlightLog) -> dict[str, tuple[Array, Array]]:
    """Times, voltage and current, where a battery monitor has both."""
    if not log.has("BAT"):
        return {}
    table = log.stream("BAT", 0)
    if not len(table) or table["Volt"].min() <= 0.0 or table["Curr"].max() <= 0.0:
        return {}
    return {name: (table.time, table[field]) for name, field in (("voltage", "Volt"), ("current", "Curr"))}


def _is_whole(time: Array, span: Span) -> bool:
    inside = time[(time >= span.begin) & (time <= span.end)]
    return len(inside) > 2 and float(np.diff(np.concatenate([[span.begin], inside, [span.end]])).max()) < _GAP_S


def _near(at: float, time: Array, value: Array) -> float:
    return float(np.interp(at, time, value))
