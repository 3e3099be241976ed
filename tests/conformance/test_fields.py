# SPDX-License-Identifier: BSD-3-Clause
"""Messages, field by field, as a real ArduPilot sends them (tests/conformance/kept/fields-*.json)."""

from __future__ import annotations

import pytest

from benchmarks.conformance.scans.run import compare_kept


@pytest.mark.parametrize("vehicle", ["copter", "rover"])
def test_fields_are_as_kept(vehicle: str) -> None:
    assert compare_kept("fields", vehicle) == []
