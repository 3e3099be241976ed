# SPDX-License-Identifier: BSD-3-Clause
"""Tables of scans: our vehicles beside what a real ArduPilot does, as it is kept (tests/conformance/kept)."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.readers import READERS
from benchmarks.conformance.scans.run import compare_kept

TABLES = (
    "acks",
    "fields",
    "items",
    "logs",
    "missions",
    pytest.param("arming", marks=pytest.mark.slow),
    pytest.param("in-flight", marks=pytest.mark.slow),
)


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
@pytest.mark.parametrize("table", TABLES)
def test_it_is_as_kept(table: str, vehicle: str) -> None:
    assert compare_kept(table, vehicle) == []


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
@pytest.mark.parametrize("reader", READERS)
def test_readers_find_in_our_log_what_they_find_in_ardupilots(reader: str, vehicle: str) -> None:
    pytest.importorskip(reader)
    assert compare_kept("readers", vehicle, f"{reader} *") == []


def test_a_speed_of_legs_acts_on_the_way_home_as_soon_as_it_is_set() -> None:
    assert compare_kept("in-flight", "copter", "WPNAV_SPEED in RTL") == []
