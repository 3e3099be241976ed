# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the tests of recordings: one flight, flown once."""

from __future__ import annotations

import pytest

from sitl.simulation import Core
from tests.recording.recorded_flights import Recorded, hop


@pytest.fixture(scope="session")
def hopped(core: Core, tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """A recorded flight of 62 s."""
    return hop(tmp_path_factory.mktemp("hop") / "hop.rec", core)
