# SPDX-License-Identifier: BSD-3-Clause
"""Two flights of a mission in step: by the beginnings of its items, also where the twin is late on it."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from sitl.missions.twin.agreement import Window
from sitl.missions.twin.flight_log import FlightLog
from sitl.missions.twin.legs import Begun, Item, Step, begun, begun_in, late, steps, windows
from sitl.missions.twin.twin import Twin
from tests.missions.twin.test_agreement import TIME, agreement


def test_items_begin_with_their_texts_and_commands_of_no_time_count_as_the_last() -> None:
    texts = [
        (-1.0, "Mission: 1 Takeoff"), (0.1, "Mission: 1 Takeoff"), (5.0, "Reached command #1"), (5.0, "Mission: 2 WP"),
        (9.0, "Mission: 3 CondYaw"), (9.0, "Mission: 4 WP"), (12.0, "Mission: 2 WP"),
    ]  # fmt: skip
    assert begun(texts) == [
        Begun(0.1, Item(1, 1)), Begun(5.0, Item(2, 1)), Begun(9.0, Item(4, 1)), Begun(12.0, Item(2, 2)),
    ]  # fmt: skip


def test_a_late_twin_is_told_by_its_latest_item() -> None:
    found = [Step(1.0, 1.05, Item(2, 1)), Step(20.0, 20.3, Item(3, 1)), Step(30.0, 29.5, Item(4, 1))]
    (text,) = late(found)
    assert text.startswith("the twin begins mission item 4 0.5 s earlier than the log's vehicle")
    assert "from item 3 on (20 s)" in text
    assert late(found[:1]) == [] and late([]) == []


def test_a_window_with_a_shift_compares_the_same_moment_of_the_mission() -> None:
    late_by = 0.5
    logged, flown = np.sin(TIME), np.sin(TIME - late_by)
    apart = agreement(logged, flown, [Window(0.0, 9.0)])
    in_step = agreement(logged, flown, [Window(0.0, 9.0, late_by)])
    assert apart.vaf < 90.0 and in_step.rms == pytest.approx(0.0, abs=1e-9)


def test_the_twin_of_a_mission_is_compared_item_by_item(own_log: Path, own_twin: Twin) -> None:
    log = FlightLog(own_log)
    assert [one.item.number for one in begun_in(log)] == [1, 2, 3, 4]
    both = steps(log, own_twin.flown)
    assert [step.item.number for step in both if step.item is not None] == [1, 2, 3, 4]
    found = windows(log, own_twin.flown)
    assert all(one.end <= after.begin + 1e-9 for one, after in pairwise(found))
    assert sum(one.end - one.begin for one in found) > 0.9 * log.span.length
    metrics = own_twin.metrics()
    for name in ("roll_rate", "pitch_rate", "position", "roll", "climb"):  # the twin is 0.09 s early from item 3 on
        assert metrics[f"legs.{name}.rms"] < 0.75 * metrics[f"{name}.rms"], name
