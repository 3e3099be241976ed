# SPDX-License-Identifier: BSD-3-Clause
"""Compiled cores of both kinds, loaded once a process."""

from __future__ import annotations

import pytest

from sitl.kinds import KINDS
from sitl.simulation import Core, load_core


@pytest.fixture(scope="session")
def cores() -> dict[str, Core]:
    return {name: load_core(kind) for name, kind in KINDS.items()}
