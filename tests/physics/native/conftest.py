# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles for the tests of physics: laws and the step run as plain Python."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.physics.native.physics_rig import Rig


@pytest.fixture
def rig() -> Callable[..., Rig]:
    return Rig


@pytest.fixture(scope="session")
def rig_factory() -> Callable[..., Rig]:
    """As ``rig``, for property tests, which must not use fixtures of one test."""
    return Rig
