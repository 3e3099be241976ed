# SPDX-License-Identifier: BSD-3-Clause
"""What arming checks say of parameters as a real ArduPilot does (tests/conformance/kept/arming-*.json)."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.slow
@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_arming_is_as_kept(vehicle: str) -> None:
    assert compare_kept("arming", vehicle) == []
