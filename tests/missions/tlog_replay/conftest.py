# SPDX-License-Identifier: BSD-3-Clause
"""One log, made once."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.simulation import Core
from tests.missions.tlog_replay.logged_flights import fly_mission


@pytest.fixture(scope="session")
def flight_log(core: Core, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of a copter's mission."""
    return fly_mission(tmp_path_factory.mktemp("logged"), core)
