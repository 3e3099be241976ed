# SPDX-License-Identifier: BSD-3-Clause
"""A flight and a drive that several tests look at."""

from __future__ import annotations

import pytest

from tests.logs.dataflash.logged_run import Run


@pytest.fixture(scope="session", params=["copter", "rover"])
def driven(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A short flight and a short drive, logged and closed."""
    run = Run(tmp_path_factory.mktemp("dataflash"), request.param)
    run.drive()
    run.simulation.close()
    return run
