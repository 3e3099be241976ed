# SPDX-License-Identifier: BSD-3-Clause
"""Positions of switches, and when a move counts."""

from __future__ import annotations

import pytest

from sitl.autopilot.aux_functions import COMMON, by_number
from sitl.autopilot.aux_switch import AUX_SWITCH, HIGH, LOW, MIDDLE, position, watch
from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.events import Events
from sitl.autopilot.state import Arming, Radio


@pytest.mark.parametrize(
    ("pulse", "place"),
    [(0, 0), (800, 0), (801, LOW), (1199, LOW), (1200, MIDDLE), (1800, MIDDLE), (1801, HIGH), (2199, HIGH), (2200, 0)],
)
def test_three_positions(pulse: int, place: int) -> None:
    assert position(pulse) == place


def test_a_switch_counts_when_it_has_stayed() -> None:
    rc, arming, events = Radio(), Arming(), Events()
    params = TABLE.record()
    params["RC7_OPTION"] = 7.0
    for time_ms, pulse in ((0, 1000), (200, 1000), (300, 2000), (400, 1000), (500, 1000), (600, 2000), (800, 2000)):
        rc.channels[6] = pulse
        watch(rc, arming, events, time_ms * 1000, params)
    told = [(int(events.code[k]), int(events.a[k]), int(events.b[k])) for k in range(events.count)]
    assert told == [(AUX_SWITCH, 7, -LOW), (AUX_SWITCH, 7, HIGH)], "first found low, then moved; a short pulse is none"
    assert not arming.interlock_used


def test_a_function_is_listed_once() -> None:
    with pytest.raises(ValueError, match="listed twice"):
        by_number((COMMON[0], COMMON[0]))
