# SPDX-License-Identifier: BSD-3-Clause
"""The compiled units and the same functions as plain Python give the same bits."""

from __future__ import annotations

import pytest

from sitl.autopilot.estimation import update
from sitl.core.kernels import jit_disabled
from sitl.core.records import first_difference
from tests.autopilot.estimation import synthetic_flight as sf


@pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")
def test_plain_python_agrees_with_compiled(tick) -> None:
    """A second of flight with all sensors, from the same record."""
    truth = sf.fly(57.0, 50.0)
    flight = sf.sense(truth, 50.0, 1)
    compiled = sf.new()
    plain = None
    n = len(truth.t)
    for k in range(n):
        sf.load_tick(compiled[0]["sensors"], flight, k)
        compiled["time_us"] = 2500 * (k + 1)
        compiled["autopilot"]["arming"]["armed"] = 1 if truth.t[k] > 50 else 0
        if k == n - 400:
            plain = compiled.copy()
        elif k > n - 400:
            plain["sensors"], plain["time_us"] = compiled["sensors"], compiled["time_us"]
        tick(compiled)
        if plain is not None:
            update.update({0: sf.Copter.of(plain, 0)}, 0)
    assert plain is not None
    difference = first_difference(plain[0], compiled[0])
    assert difference is None
