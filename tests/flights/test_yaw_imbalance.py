# SPDX-License-Identifier: BSD-3-Clause
"""Yaw imbalance, as ArduCopter 4.7 tells it: motors 1 and 2, which turn the same way, keep 87 % of their pulse.

With a limit of the yaw rate loop's integrator (ATC_RAT_YAW_IMAX) a little above what it comes to in the end, the first
text comes 13.9 s after on this physics, then one each ten seconds, with 6, 8, 8 and 8 %; with FLIGHT_OPTIONS 2, and
while thrust is lost, there is none.
"""

from __future__ import annotations

import re

import pytest

from sitl.simulation import Core
from tests.flights.aviator import Aviator

LIMIT = {"ATC_RAT_YAW_IMAX": 0.0777}


def told(p: Aviator) -> list[tuple[float, int]]:
    """Time [s] and percentage of each text."""
    found = [(text.time, re.fullmatch(r"Yaw Imbalance (\d+)%", text.text)) for text in p.texts]
    return [(time, int(match[1])) for time, match in found if match]


def weak(core: Core, share: float, **params: float) -> tuple[Aviator, float]:
    """A flight of 50 s with weak motors, and when they became weak."""
    p = Aviator(core, "ardupilot_quad", **params).hover()
    p.set_parameter("SIM_ENGINE_MUL", share)
    p.set_parameter("SIM_ENGINE_FAIL", 3)
    start = p.simulation.time_us * 1e-6
    p.fly(50.0)
    return p, start


def test_told_every_ten_seconds(core: Core) -> None:
    p, start = weak(core, 0.87, **LIMIT)
    times = [time - start for time, _ in told(p)]
    assert times == pytest.approx([13.9, 23.9, 33.9, 43.9], abs=0.7)
    assert [share for _, share in told(p)] == [6, 8, 8, 8]
    assert p.armed and abs(p.height - 10.0) < 0.5


@pytest.mark.parametrize("params", [{}, {**LIMIT, "FLIGHT_OPTIONS": 2.0}])
def test_not_told(core: Core, params: dict[str, float]) -> None:
    assert told(weak(core, 0.87, **params)[0]) == []


def test_not_told_while_thrust_is_lost(core: Core) -> None:
    p, _ = weak(core, 0.3, **LIMIT)
    assert p.said("Potential Thrust Loss") and told(p) == []
