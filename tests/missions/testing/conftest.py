# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles without the plugin's fixtures: whether the plugin is installed does not matter to these tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults


@pytest.fixture
def store(tmp_path: Path) -> GoldenStore:
    return GoldenStore(folder=tmp_path, test="this test")


@pytest.fixture
def make(tmp_path: Path, store: GoldenStore) -> Iterator[VehicleFactory]:
    factory = VehicleFactory(Defaults(folders=(tmp_path,)), store, tmp_path / "logs")
    yield factory
    factory.close()


@pytest.fixture
def project(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    """A project of its own, where pytest has our plugin whether or not it is installed."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[3]))
    monkeypatch.setenv("PYTEST_ADDOPTS", "-p sitl.missions.testing.plugin")
    return pytester
