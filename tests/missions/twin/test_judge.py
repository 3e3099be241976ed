# SPDX-License-Identifier: BSD-3-Clause
"""What metrics of agreement say of model and autopilot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from sitl.missions.twin.agreement import Agreement
from sitl.missions.twin.judge import findings
from sitl.missions.twin.streams import COPTER


def agreement(name: str, mean: tuple[float, float], vaf: float = 100.0) -> Agreement:
    """Of a quantity whose logged and flown means are these."""
    quantity = next(one for one in COPTER if one.name == name)
    logged, flown = (np.full((10, 1), value) for value in mean)
    return Agreement(quantity, np.arange(10.0), logged, flown, 10.0, 5.0, 0.0, 5.0, 0.0, vaf)


@pytest.mark.parametrize(("vaf", "told"), [(95.0, True), (20.0, False)])
def test_throttle_of_segments_tells_of_thrust_where_the_copter_leans_as_the_logs(vaf: float, told: bool) -> None:
    whole = [agreement("throttle", (37.4, 37.5)), agreement("motors", (37.4, 37.5))]
    segments = [agreement("throttle", (37.4, 40.4)), agreement("roll", (0.0, 0.0), vaf), agreement("pitch", (0.0, 0.0))]
    found = findings(whole, segments, [])
    assert any("the thrust over weight of the airframe is less" in text for text in found) == told


def test_without_open_segments_the_motion_is_judged_in_step() -> None:
    bad, good = replace(agreement("speed", (5.0, 3.0), 40.0), rms=2.0), agreement("speed", (5.0, 5.0))
    (text,) = findings([good], [], [], [bad])
    assert text.startswith("ground speed in step by mission items accounts for 40 % of its variance")
    (text,) = findings([bad], [], [])
    assert "over the whole flight" in text
    assert findings([bad], [good], [], [bad]) == [], "open segments tell more"


@pytest.mark.parametrize(("vaf", "judged"), [(95.0, True), (10.0, False)])
def test_rates_of_segments_are_judged_only_where_the_twin_wants_the_angles_of_the_log(vaf: float, judged: bool) -> None:
    segments = [agreement("roll_rate", (0.0, 9.0), 5.0), agreement("asked_roll", (0.0, 9.0), vaf)]
    segments = [replace(one, rms=9.0) for one in segments]
    found = findings([], segments, [])
    assert any("roll rate in open segments accounts for 5 %" in text for text in found) == judged
    assert any(text.startswith("not judged: roll rate in open segments") for text in found) != judged
    assert any("desired roll, from the same state" in text for text in found) != judged
