# SPDX-License-Identifier: BSD-3-Clause
"""Metrics of agreement, by hand: root mean square, variance accounted for, windows; and their limits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sitl.errors import OptionError
from sitl.missions.twin import limits
from sitl.missions.twin.agreement import Window, compare
from sitl.missions.twin.streams import Quantity, Stream

TIME = np.arange(0.0, 10.0, 0.1)
WHOLE = (Window(0.0, 10.0),)


def agreement(logged: Any, flown: Any, windows: Any = WHOLE, each: bool = False, **options: Any) -> Any:
    streams = iter(
        [Stream(TIME, np.reshape(logged, (len(TIME), -1))), Stream(TIME, np.reshape(flown, (len(TIME), -1)))]
    )
    quantity = Quantity("one", "one", "m", 0.1, lambda log: next(streams), **options)
    return compare(quantity, None, None, windows, each=each)  # type: ignore[arg-type]


def test_a_shift_is_a_bias_and_leaves_the_variance() -> None:
    found = agreement(np.sin(TIME), np.sin(TIME) + 0.5)
    assert (found.rms, found.bias, found.vaf) == pytest.approx((0.5, 0.5, 100.0))


def test_half_the_movement_accounts_for_three_quarters_of_its_variance() -> None:
    assert agreement(np.sin(TIME), 0.5 * np.sin(TIME)).vaf == pytest.approx(75.0)


def test_the_largest_difference_has_its_time() -> None:
    flown = np.sin(TIME)
    flown[42] += 3.0
    found = agreement(np.sin(TIME), flown)
    assert (found.worst, found.worst_at) == pytest.approx((3.0, 4.2))


def test_of_what_did_not_move_nothing_is_accounted_for() -> None:
    assert math.isnan(agreement(0.01 * np.sin(TIME), np.zeros(len(TIME))).vaf)


def test_angles_differ_by_the_shorter_way() -> None:
    found = agreement(np.full(len(TIME), 359.0), np.full(len(TIME), 1.0), is_angle=True)
    assert (found.rms, found.bias) == pytest.approx((2.0, 2.0))


def test_a_place_differs_by_its_distance() -> None:
    found = agreement(np.zeros((len(TIME), 2)), np.tile([3.0, 4.0], (len(TIME), 1)), is_vector=True)
    assert (found.rms, found.worst) == pytest.approx((5.0, 5.0))


def test_segments_count_each_by_itself() -> None:
    drift = 0.1 * np.floor(TIME / 2.0)  # each segment begins with an error of its own
    windows = tuple(Window(2.0 * k, 2.0 * k + 1.95) for k in range(5))
    found = agreement(np.sin(TIME), np.sin(TIME) + drift, windows, each=True)
    assert found.vaf == pytest.approx(100.0) and found.rms > 0.1
    assert agreement(np.sin(TIME), np.sin(TIME) + drift, windows, each=True, adds_up=True).rms == pytest.approx(0.0)


def test_limits() -> None:
    metrics = {"height.rms": 0.4, "height.max": 2.0, "height.bias": -0.3, "height.vaf": 70.0, "roll.vaf": math.nan}
    wanted = dict(limits.parse(text) for text in ("height=0.5", "height.max=1", "height.bias=0.2", "height.vaf=80"))
    assert [(v.name, v.ok) for v in limits.judge(metrics, wanted)] == [
        ("height.rms", True), ("height.max", False), ("height.bias", False), ("height.vaf", False)
    ]  # fmt: skip
    (untold,) = limits.judge(metrics, {"roll.vaf": 80.0})
    assert not untold.ok and "hardly moved" in untold.words
    with pytest.raises(OptionError, match=r"limit 'heigt' is of no metric of this flight; did you mean 'height.rms'"):
        limits.judge(metrics, {"heigt": 1.0})
    with pytest.raises(OptionError, match="is not NAME=VALUE"):
        limits.parse("height")
