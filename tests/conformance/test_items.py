# SPDX-License-Identifier: BSD-3-Clause
"""Mission items are answered and read back as ArduPilot's: ``python -m benchmarks.conformance --scan items``."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_every_command(vehicle: str) -> None:
    assert compare_kept("items", vehicle) == []
