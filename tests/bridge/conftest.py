# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest
from fakes import Bench


@pytest.fixture
def bench() -> Bench:
    """A fresh bench; no time has passed."""
    return Bench()
