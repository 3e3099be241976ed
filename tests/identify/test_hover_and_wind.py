# SPDX-License-Identifier: BSD-3-Clause
"""What an accelerometer's bias does to hover and wind: nothing to the one, and the other's interval knows it."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.constants import GRAVITY
from sitl.identify import drag, hover
from sitl.identify.log_streams import FlightLog


@pytest.fixture
def log(flown):
    return FlightLog(flown)


def biased(log: FlightLog, **by: float) -> FlightLog:
    """The same log with an accelerometer that shows so much more."""
    raw = log.columns["IMU"].raw
    for axis, more in by.items():
        raw[axis] = raw[axis] + np.float32(more)
    return log


def test_the_hover_output_is_that_of_an_accelerometer_without_bias(flown) -> None:
    outputs = [hover.hover([biased(FlightLog(flown), AccZ=more)])[0].value for more in (0.0, 0.2, -0.2)]
    assert outputs[1:] == pytest.approx([outputs[0]] * 2, rel=5e-4), "0.2 m/s^2 are a hundredth of the output"


def test_what_the_vehicle_gains_upward_is_no_bias() -> None:
    rows = np.column_stack([np.full(20, x) for x in (0.5, GRAVITY + 0.3, 12.0, 10.0, 0.0)])
    part = hover.Hover(rows, np.full((20, 4), 0.5), np.full(20, 0.3))
    assert hover._without_bias([part])[0].rows[:, 1] == pytest.approx(np.full(20, GRAVITY + 0.3))
    still = part._replace(climb=np.zeros(20))
    assert hover._without_bias([still])[0].rows[:, 1] == pytest.approx(np.full(20, GRAVITY))


def test_the_wind_has_an_interval_by_what_the_bias_may_be(log, monkeypatch) -> None:
    usual = {estimate.name: estimate for estimate in drag.drag([log])}["wind_speed"]
    monkeypatch.setattr(drag, "_WIND", 0.0)
    knows = {estimate.name: estimate for estimate in drag.drag([log])}["wind_speed"]
    fitted = drag._fitted
    monkeypatch.setattr(drag, "_fit", lambda rows: fitted(rows, np.zeros(2), np.zeros(2)))
    without = {estimate.name: estimate for estimate in drag.drag([log])}["wind_speed"]
    assert without.value == knows.value == usual.value
    assert without.high < knows.high < usual.high
