# SPDX-License-Identifier: BSD-3-Clause
"""What docs/vehicles.md says of how well the rovers drive is what they do."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.simulation import Core
from tests.drives.rover_driver import AIRFRAMES, metrics

PAGE = Path(__file__).parents[2] / "docs" / "vehicles.md"
ABSOLUTE, RELATIVE = 0.03, 0.1
"""How far a metric may be off what the page says; GPS, which is chance, by half."""


def written(frame: str) -> dict[str, float]:
    """The airframe's column of the table."""
    rows = [[cell.strip(" `") for cell in line.strip("|\n").split("|")] for line in PAGE.open() if line.startswith("|")]
    header = next(k for k, row in enumerate(rows) if row[0] == "metric")
    column = rows[header].index(frame)
    return {row[0]: float(row[column]) for row in rows[header + 2 :] if len(row) == len(rows[header])}


@pytest.mark.parametrize("frame", AIRFRAMES)
def test_the_page_is_right(core: Core, frame: str) -> None:
    said, found = written(frame), metrics(core, frame)
    assert said.keys() == found.keys()
    for name, value in found.items():
        share = 0.5 if "GPS" in name else RELATIVE
        assert value == pytest.approx(said[name], rel=share, abs=0.5 if name == "overshoot" else ABSOLUTE), name
