# SPDX-License-Identifier: BSD-3-Clause
"""Which of two GPS receivers is used."""

from __future__ import annotations

import pytest

from sitl.autopilot import gps_receivers as receivers
from sitl.autopilot.arming_checks import RECEIVERS, receiver_checks, receiver_texts
from sitl.autopilot.copter.parameters import TABLE, Parameters
from sitl.core.border import Sensors

NOW = 60_000_000


def sensors(first: int = 3, second: int = 3, satellites: tuple[int, int] = (10, 10)) -> Sensors:
    """Both receivers have just been heard, with these fixes."""
    s = Sensors()
    for seen, fix, count in ((s, first, satellites[0]), (s.gps2, second, satellites[1])):
        seen.gps_count, seen.gps_time_us, seen.gps_fix, seen.gps_satellites = 1, NOW, fix, count
        seen.gps_lat, seen.gps_lon, seen.gps_alt = -353632620, 1491652370, 584000
    return s


def params(**values: float) -> Parameters:
    p = Parameters()
    TABLE.set_defaults(p)
    p["GPS2_TYPE"] = 1
    for name, value in values.items():
        p[name] = value
    return p


@pytest.mark.parametrize(
    ("switch", "primary", "fixes", "used", "wanted"),
    [
        (1, 0, (3, 3), 0, 0),  # no better one
        (1, 0, (3, 3), 1, 1),  # it stays
        (1, 0, (1, 3), 0, 1),
        (1, 0, (0, 3), 0, 1),
        (1, 0, (3, 1), 1, 0),
        (0, 0, (1, 3), 0, 0),  # GPS_PRIMARY whatever comes
        (0, 1, (3, 0), 0, 1),
        (4, 0, (3, 3), 1, 0),  # back to GPS_PRIMARY as soon as it has a fix
        (4, 0, (1, 3), 0, 1),
        (4, 1, (3, 3), 0, 1),
    ],
)
def test_gps_auto_switch(switch: int, primary: int, fixes: tuple[int, int], used: int, wanted: int) -> None:
    choice = receivers.GpsChoice()
    choice.primary, choice.changed_us = used, NOW
    receivers.choose(choice, sensors(*fixes), params(GPS_AUTO_SWITCH=switch, GPS_PRIMARY=primary), NOW)
    assert choice.primary == wanted


@pytest.mark.parametrize(
    ("more", "after", "changes"), [(1, 19.9, False), (1, 20.0, True), (2, 4.9, False), (2, 5.0, True)]
)
def test_more_satellites_count_after_a_time(more: int, after: float, changes: bool) -> None:
    choice = receivers.GpsChoice()
    choice.changed_us = NOW - round(1e6 * after)
    receivers.choose(choice, sensors(satellites=(10, 10 + more)), params(), NOW)
    assert (choice.primary == 1) == changes and (choice.changed_us == NOW) == changes


def test_a_silent_receiver_is_left() -> None:
    choice, s = receivers.GpsChoice(), sensors()
    s.gps_time_us = NOW - receivers.SILENCE_US
    receivers.choose(choice, s, params(), NOW)
    assert choice.primary == 0
    s.gps_time_us -= 1
    receivers.choose(choice, s, params(), NOW)
    assert choice.primary == 1


def test_checks_before_arming() -> None:
    def said(s, p) -> str | None:
        return receiver_texts(s, p)[RECEIVERS] if receiver_checks(s, p) == RECEIVERS else None

    assert said(sensors(second=1), params()) == "GPS 2: Bad fix"
    assert said(sensors(second=1), params(GPS2_TYPE=0)) is None
    assert said(sensors(), params()) is None
    assert said(sensors(), params(GPS_AUTO_SWITCH=2)) == "GPS blending unhealthy"
    s = sensors()
    s.gps2.gps_lat += 4000  # 44.5 m
    assert said(s, params()) is None
    s.gps2.gps_alt += 30000
    assert said(s, params()) == "GPS positions differ by 53.7m"
