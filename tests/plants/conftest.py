# SPDX-License-Identifier: BSD-3-Clause
"""Compiled cores of both kinds, loaded once a process."""

from __future__ import annotations

import pytest

from sitl.vehicle.core_entry import Core, load_core
from sitl.vehicle.kinds import KINDS


@pytest.fixture(scope="session")
def cores() -> dict[str, Core]:
    return {name: load_core(kind) for name, kind in KINDS.items()}
