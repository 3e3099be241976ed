# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

from tests.bridge.fakes import Bench, FakeRover


@pytest.fixture
def bench() -> Bench:
    """A fresh bench with a copter; no time has passed."""
    return Bench()


@pytest.fixture
def rover_bench() -> Bench:
    """The same with a rover."""
    return Bench(FakeRover())
