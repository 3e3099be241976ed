# SPDX-License-Identifier: BSD-3-Clause
"""Shared by all tests: the compiled core is loaded once a process."""

from __future__ import annotations

import os

import pytest
from hypothesis import HealthCheck, settings

from sitl.simulation import Core, load_core

pytest_plugins = ["pytester"]

# A test has one processor: threads of Torch and of linear algebra that wait for each other on one that is taken use up
# to twenty times the time of what they compute. Torch is loaded later, and workers and children begin with this.
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

# A page that a test serves is not opened in the browser of who runs the tests. Programs of tests have this, too.
os.environ["BROWSER"] = "true"

# How long an example takes is the machine's business: a busy one must not fail a test. Nor does a test that nobody
# touched: examples are the same in each run. Others are drawn by ``pytest --hypothesis-profile default``.
settings.register_profile("any machine", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")


LONGEST = (
    "test_the_site_builds_without_warnings",
    "test_the_examples_that_compile_a_core_do_what_they_say",
    "test_a_tutorial_runs_as_it_stands[your-own-vehicle]",
    "test_all_flights_are_the_same_as_on_other_machines",
)
"""They take a minute and more: at the end one worker would be at them while the others have nothing left."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Slow tests come last: what fails is seen early. The longest of them come first."""
    items.sort(key=lambda item: (item.get_closest_marker("slow") is not None, item.name not in LONGEST))


@pytest.fixture(scope="session")
def core() -> Core:
    """The compiled core (from the cache; the first process builds what is missing)."""
    return load_core()


@pytest.fixture
def no_library(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where no library of machine code came with the package, nor was made: all is compiled here."""
    monkeypatch.setattr("sitl.core.shipped.library.library", lambda: None)
    monkeypatch.setenv("SITL_SHIPPED_DIR", "")  # of programs that it starts
