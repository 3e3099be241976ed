# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles without the plugin's fixtures: whether the plugin is installed does not matter to these tests."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from sitl.core.code_cache import cache_folder
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults
from sitl.vehicle.kind import load
from sitl.vehicle.kinds import KINDS

CACHE = str(cache_folder())


@pytest.fixture
def store(tmp_path: Path) -> GoldenStore:
    return GoldenStore(folder=tmp_path, test="this test")


@pytest.fixture
def make(tmp_path: Path, store: GoldenStore) -> Iterator[VehicleFactory]:
    factory = VehicleFactory(Defaults(folders=(tmp_path,)), store, tmp_path / "logs")
    yield factory
    factory.close()


@pytest.fixture(scope="session")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> None:
    """What vehicles load is loaded. A pytest within this one forgets the modules that it was the first to load, and
    the next one would load them a second time, beside the classes that the kinds of vehicles hold."""
    folder = tmp_path_factory.mktemp("loaded")
    factory = VehicleFactory(Defaults(folders=(folder,)), GoldenStore(folder=folder, test="loaded"), folder / "logs")
    for kind in ("copter", "rover"):
        factory(kind)
        for part in KINDS[kind].parts.values():
            load(part)
    factory.close()


@pytest.fixture
def project(loaded: None, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    """A project of its own, where pytest has our plugin whether or not it is installed."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[3]))
    monkeypatch.setenv("SITL_CACHE_DIR", CACHE)  # pytester moves the home folder, and with it the compiled core
    monkeypatch.setenv("PYTEST_ADDOPTS", "-p sitl.missions.testing.plugin")
    return pytester
