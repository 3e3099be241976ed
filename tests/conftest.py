# SPDX-License-Identifier: BSD-3-Clause
"""Shared by all tests: the compiled core is loaded once a process."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, settings

from sitl.simulation import Core, load_core

pytest_plugins = ["pytester"]

# How long an example takes is the machine's business: a busy one must not fail a test.
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Slow tests come last: what fails is seen early."""
    items.sort(key=lambda item: item.get_closest_marker("slow") is not None)


@pytest.fixture(scope="session")
def core() -> Core:
    """The compiled core (from the cache; the first process builds what is missing)."""
    return load_core()
