# SPDX-License-Identifier: BSD-3-Clause
"""Shared by all tests: the compiled core is loaded once a process."""

from __future__ import annotations

import pytest

from sitl.simulation import Core, load_core


@pytest.fixture(scope="session")
def core() -> Core:
    """The compiled core (from the cache; the first process builds what is missing)."""
    return load_core()
