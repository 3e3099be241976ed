# SPDX-License-Identifier: BSD-3-Clause
"""When parameters act that are set in motion, as with a real ArduPilot (tests/conformance/kept/in-flight-*.json)."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.slow
@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_in_flight_is_as_kept(vehicle: str) -> None:
    assert compare_kept("in-flight", vehicle) == []
