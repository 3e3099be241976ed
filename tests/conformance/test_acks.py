# SPDX-License-Identifier: BSD-3-Clause
"""Results of commands as a real ArduPilot gives them (tests/conformance/kept/acks-*.json)."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_commands_are_answered_as_kept(vehicle: str) -> None:
    assert compare_kept("acks", vehicle) == []
