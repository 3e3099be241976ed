# SPDX-License-Identifier: BSD-3-Clause
"""Steps of a log's outputs, and what of the measured series they change."""

from __future__ import annotations

import numpy as np

from .courses import STEP_S
from .model import Array
from .outputs import Output
from .stretches import Series, Stretches

ANSWERS_S = 2.0
"""After a step, in which its onset changes the vehicle's answer."""


class Step:
    """A step of a log's outputs.

    Args:
        data: in which it is.
        log, channels: of which.
        indices: number of the step of each channel.
    """

    def __init__(self, data: Stretches, log: int, channels: tuple[int, ...], indices: tuple[int, ...]) -> None:
        self.log, self.indices = log, tuple(zip(channels, indices))
        begin = float(data.outputs[log][channels[0]].steps.begin[indices[0]])
        self.rows: list[slice] = []
        """Residuals that it changes."""
        before = 0
        for series in data.measured():
            time = _times(data, series)
            own = np.flatnonzero(series.group == log)
            a, b = np.searchsorted(time[own], (begin, begin + ANSWERS_S))
            self.rows.append(slice(before + own[0] + int(a), before + own[0] + int(b)))
            before += len(time)


def _times(data: Stretches, series: Series) -> Array:
    return data.begin[series.stretch] + STEP_S * (series.sample + 1.0)


def steps_of(
    data: Stretches, together: tuple[tuple[int, ...], ...]
) -> list[tuple[int, tuple[int, ...], tuple[int, ...]]]:
    """(Log, channels, number of the step of each channel) in the order of time; on both channels at once are one."""
    found = []
    for log, pair in enumerate(data.outputs):
        mine: dict[tuple[float, int], list[tuple[int, int]]] = {}
        for number, channels in enumerate(together):
            for channel in channels:
                steps: Output = pair[channel]
                for k, begin in enumerate(steps.steps.begin.tolist()):
                    mine.setdefault((begin, number), []).append((channel, k))
        for _, members in sorted(mine.items()):
            found.append((log, tuple(c for c, _ in members), tuple(k for _, k in members)))
    return found
