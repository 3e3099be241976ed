# SPDX-License-Identifier: BSD-3-Clause
"""``sitl/Navigate-v0`` as tests make it."""

from __future__ import annotations

import gymnasium as gym

import sitl.envs  # noqa: F401 (registers the environments)

NAVIGATE = "sitl/Navigate-v0"


def make(**options):
    return gym.make(NAVIGATE, **options).unwrapped
