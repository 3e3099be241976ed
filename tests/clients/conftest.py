# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures of the tests with real client libraries."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from sitl.simulation import Core
from tests.clients import drive


@pytest.fixture
def fly(core: Core, tmp_path: Path) -> drive.Fly:
    """``fly(script, url, *options)``: see ``drive.fly``."""
    return partial(drive.fly, tmp_path)
