# SPDX-License-Identifier: BSD-3-Clause
"""Properties of a rover's drive and steering with which its model drives as the log's vehicle did by its outputs.

Speed, yaw rate and acceleration of all stretches are fitted at once, and when each step of the outputs happened, since
the log has it to a tenth of a second. A limit (of the motors, of the servo, of the grip) is in the model only when the
log's vehicle ran into it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product

import numpy as np
from scipy import optimize

from ...core.constants import GRAVITY
from ..regression import GUSTS_S, Fit, least_squares
from .courses import STEP_S, Courses
from .model import CAR, DRIVE, LEAST, LIMITS, MOST, SKID, Array, Model, base_of
from .steps import Step, steps_of
from .stretches import Stretches

_ONSETS = np.linspace(0.05, 0.95, 10)
_SHIFT = 0.1
"""Of an onset, by which its slope is found."""
_GAIN = 0.002
"""Part of the squares that a limit must explain to be in the model."""
_WORSE = 1.1
"""With the other properties as they were, a limit may first be worse by this factor."""
_SEARCHES, _SETTLED = 8, 0.99
"""So many searches in a row, as long as each leaves no more than this part of the squares."""
_SERVO_S = (0.05, 0.1, 0.2, 0.4)
_SHARES = (0.9, 0.75, 0.6, 0.45, 0.3)
_LAGS_S = (0.05, 0.2, 0.6, 2.0)
_OUTLIER = 3.0
"""Residuals beyond so many of their typical size count less."""


class DriveFit:
    """The best properties.

    Args:
        data: what was measured.
    """

    def __init__(self, data: Stretches) -> None:
        self.data, self.base = data, base_of(data.skids)
        self.names: tuple[str, ...] = (*DRIVE, *(SKID if data.skids else CAR))
        self.sizes = np.array([max(float(np.std(series.value)), 1e-6) for series in data.measured()])
        # What steers a skidding vehicle, both motors, happens at once.
        self._together = ((0, 1),) if data.skids else ((0,), (1,))
        self._steps = [Step(data, log, channels, k) for log, channels, k in steps_of(data, self._together)]
        self._onsets = np.full(len(self._steps), 0.5)
        p = self._search(self._start())
        self._reweigh(p)
        self._find_onsets(p)
        p = self._search(p)
        self._reweigh(p)
        for limit in (*LIMITS, *LIMITS):  # once more: one may show only when another is in the model
            if limit not in self.names:
                p = self._try(limit, p)
        p = self._settle(p)
        self._reweigh(p)
        q = self._with_onsets(p)
        low, high = self._limits()
        groups = np.concatenate([1000 * k + series.group for k, series in enumerate(data.measured())])
        lag = int(GUSTS_S * len(groups) / data.seconds / len(data.measured()))
        self.fit: Fit = least_squares(self._residuals, q, groups, lag, self._scale(q), (low, high), self._slopes)
        self.model = self._model(self.fit.value)
        self._set_onsets(self.fit.value)
        self.courses: Courses = self.model.courses(self.data, self.base)

    def interval(self, name: str) -> tuple[float, float]:
        """A property and its standard error."""
        k = self.names.index(name)
        return float(self.fit.value[k]), float(self.fit.error[k])

    def of(self, function: Callable[[Model], float]) -> tuple[float, float]:
        """A number that follows from a model, and its standard error."""
        p = self.fit.value
        value: float = function(self._model(p))
        slope = np.zeros(len(p))
        for k, step in enumerate(1e-4 * self._scale(p)[: len(self.names)]):
            there = p.copy()
            there[k] += step
            slope[k] = (function(self._model(there)) - value) / step
        return value, math.sqrt(max(float(slope @ self.fit.covariance @ slope), 0.0))

    # ------------------------------------------------------------------ parameters: properties, then onsets

    def _model(self, p: Array) -> Model:
        return Model(dict(zip(self.names, p.tolist())), self.data.skids)

    def _with_onsets(self, p: Array) -> Array:
        low, high = self._limits()
        return np.clip(np.concatenate([p[: len(self.names)], self._onsets]), low + 1e-9, high - 1e-9)

    def _set_onsets(self, p: Array) -> None:
        onsets = p[len(self.names) :]
        if np.array_equal(onsets, self._onsets):
            return
        self._onsets = onsets.copy()
        self._move(onsets)

    def _move(self, onsets: Array) -> None:
        pairs = [[one.steps.onset.copy() for one in pair] for pair in self.data.outputs]
        for step, onset in zip(self._steps, onsets):
            for channel, index in step.indices:
                pairs[step.log][channel][index] = onset
        moved = [
            (pair[0].with_onset(first), pair[1].with_onset(second))
            for pair, (first, second) in zip(self.data.outputs, pairs)
        ]
        self.data = self.data.with_outputs(moved)

    def _scale(self, p: Array) -> Array:
        typical = {"speed": p[0], "back": p[0], "lag": 0.3, "loss": 0.05 * p[0], "shape": 0.5, "trim": 0.05}
        typical |= {"differ": 0.05, "servo": 0.1}
        sizes = [max(typical.get(name, abs(x)), 1e-3) for name, x in zip(self.names, p)]
        return np.concatenate([sizes, np.full(len(self._steps), 0.3)])

    def _limits(self) -> tuple[Array, Array]:
        count = len(self._steps)
        low = [*(LEAST[name] for name in self.names), *(0.0,) * count]
        return np.array(low), np.array([*(MOST[name] for name in self.names), *(1.0,) * count])

    # ------------------------------------------------------------------ residuals

    def _parts(self, p: Array) -> list[Array]:
        """Residuals of speed, yaw rate, acceleration by their sizes."""
        made = self.data.modelled(self._model(p).courses(self.data, self.base))
        parts = [series.value - model for series, model in zip(self.data.measured(), made)]
        parts[1:] = [series.free(part) for series, part in zip(self.data.measured()[1:], parts[1:])]
        return [part / size for part, size in zip(parts, self.sizes)]

    def _residuals(self, p: Array) -> Array:
        self._set_onsets(p)
        return np.concatenate(self._parts(p))

    def _slopes(self, p: Array) -> Array:
        """Of the residuals by properties, and by onsets: of every second step at once, since each acts for a while."""
        at = self._residuals(p)
        found = np.zeros((len(at), len(p)))
        _, high = self._limits()
        for k, step in enumerate(1e-5 * self._scale(p)[: len(self.names)]):
            there = p.copy()
            there[k] += step if p[k] + step < high[k] else -step
            found[:, k] = (self._residuals(there) - at) / (there[k] - p[k])
        for parity in (0, 1):
            turn = range(parity, len(self._steps), 2)
            ends = []
            for sign in (1.0, -1.0):
                there = p.copy()
                for k in turn:
                    there[len(self.names) + k] += sign * _SHIFT
                ends.append(self._residuals(there))
            slope = (ends[0] - ends[1]) / (2.0 * _SHIFT)
            for k in turn:
                for part in self._steps[k].rows:
                    found[part, len(self.names) + k] = slope[part]
        self._set_onsets(p)
        return found

    def _cost(self, p: Array) -> float:
        size = abs(np.concatenate(self._parts(p)))
        return float(np.sum(np.where(size <= _OUTLIER, size * size, _OUTLIER * (2.0 * size - _OUTLIER))))

    def _search(self, p: Array) -> Array:
        q = self._with_onsets(p)
        found = optimize.least_squares(
            self._residuals,
            q,
            self._slopes,
            self._limits(),
            loss="huber",
            f_scale=_OUTLIER,
            x_scale=self._scale(q),
            max_nfev=10,
            ftol=1e-4,
        )
        self._set_onsets(found.x)
        return np.asarray(found.x[: len(self.names)])

    def _settle(self, p: Array) -> Array:
        """Search on until that gains little: else the last bits of sums decide where a search of few steps ends."""
        for _ in range(_SEARCHES):
            before = self._cost(p)
            p = self._search(p)
            if self._cost(p) > _SETTLED * before:
                break
        return p

    def _reweigh(self, p: Array) -> None:
        spread = [1.4826 * float(np.median(abs(part - np.median(part)))) for part in self._parts(p)]
        self.sizes = self.sizes * np.maximum(spread, 1e-3)

    # ------------------------------------------------------------------ beginnings

    def _start(self) -> Array:
        """By proportion: speed to throttle, yaw rate to speed and steering."""
        data = self.data
        first, second = data.inputs()
        throttle = 0.5 * (first + second) if data.skids else second
        c, v = data.speed.of(throttle), data.speed.value
        top = max(float(c @ v) / max(float(c @ c), 1e-9), 0.05)
        turn, r = data.yaw_rate.of(first - second if data.skids else first), data.yaw_rate.value
        if data.skids:
            track = top * float(turn @ turn) / max(float(turn @ r), 1e-6)
            steerings: list[tuple[float, ...]] = [(factor * min(max(track, 0.05), 9.0), 0.0) for factor in (1.0, 1.4)]
        else:
            at, known = (1e4 * series.stretch + series.sample for series in (data.yaw_rate, data.speed))
            x = np.interp(at, known, v) * turn
            bend = min(max(float(x @ r) / max(float(x @ x), 1e-9), 1e-3), 40.0)
            steerings = [(factor * bend, shape, 0.0) for factor in (1.0, 1.3) for shape in (0.4, -0.4)]
        trials = [
            np.array([factor * top, factor * top, lag, 0.02 * top, *steering])
            for steering, lag, factor in product(steerings, _LAGS_S, (1.0, 1.4, 2.0))
        ]
        return min(trials, key=self._cost)

    def _find_onsets(self, p: Array) -> None:
        """Of each step, when the vehicle's answer fits best."""
        costs = np.zeros((len(_ONSETS), len(self._steps)))
        for row, onset in zip(costs, _ONSETS):
            self._move(np.full(len(self._steps), onset))
            squares = np.minimum(np.concatenate(self._parts(p)) ** 2, 400.0)
            row[:] = [sum(float(squares[part].sum()) for part in step.rows) for step in self._steps]
        self._onsets = _ONSETS[costs.argmin(0)] if len(self._steps) else self._onsets
        self._move(self._onsets)

    # ------------------------------------------------------------------ limits

    def _try(self, limit: str, p: Array) -> Array:
        """With a limit, if it explains much."""
        if limit == "servo" and self.data.skids:
            return p
        names, onsets, before = self.names, self._onsets, self._cost(p)
        candidates = _SERVO_S if limit == "servo" else tuple(1.0 / x for x in self._reached(limit, p))
        if not candidates:
            return p
        self.names = (*names, limit)
        best = min((np.append(p, value) for value in candidates), key=self._cost)
        if self._cost(best) < _WORSE * before:
            found = self._search(best)
            without = np.append(found[:-1], 0.0)
            if self._cost(found) < (1.0 - _GAIN) * min(before, self._cost(without)):
                self._reweigh(found)
                return found
        self.names = names
        self._set_onsets(np.concatenate([p, onsets]))
        return p

    def _reached(self, limit: str, p: Array) -> list[float]:
        """Values that are less than what the model reaches without a limit."""
        courses = self._model(p).courses(self.data, self.base)
        if limit == "slip":
            most = float(np.percentile(abs(courses.speed * courses.yaw_rate), 99.9)) / GRAVITY
        else:
            most = float(np.percentile(abs(np.diff(courses.speed)), 99.9)) / STEP_S
            if self.data.skids:  # each side has motors of its own, and both turn it
                turn = float(np.percentile(abs(np.diff(courses.yaw_rate)), 99.9)) / STEP_S
                most = max(most, 0.5 * self._model(p).value("track") * turn)
        return [share * most for share in _SHARES if most > 1e-3]
