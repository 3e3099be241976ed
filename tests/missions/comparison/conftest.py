# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the tests of comparisons: golden flights, flown once."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.missions.comparison.compared_flights import fly_square


@pytest.fixture(scope="session")
def squares(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a copter's and a rover's flight as .rec, .tlog and .bin each."""
    folder = tmp_path_factory.mktemp("squares")
    for kind in ("copter", "rover"):
        fly_square(folder / f"{kind}.rec", kind, logs=True)
    return folder
