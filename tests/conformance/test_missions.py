# SPDX-License-Identifier: BSD-3-Clause
"""What is told of each command in a mission, as ArduPilot tells it: ``--scan missions``."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_every_command(vehicle: str) -> None:
    assert compare_kept("missions", vehicle) == []
