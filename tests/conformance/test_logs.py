# SPDX-License-Identifier: BSD-3-Clause
"""On-board logs as a real ArduPilot writes them (tests/conformance/kept/logs-*.json)."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_logs_are_as_kept(vehicle: str) -> None:
    assert compare_kept("logs", vehicle) == []
