# SPDX-License-Identifier: BSD-3-Clause
"""The rover's compiled core, loaded once a process."""

from __future__ import annotations

import pytest

from sitl.simulation import Core, load_core
from sitl.vehicle.kinds import KINDS


@pytest.fixture(scope="session")
def core() -> Core:
    """The compiled core of rovers (from the cache; the first process builds what is missing)."""
    return load_core(KINDS["rover"])
