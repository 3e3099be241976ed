# SPDX-License-Identifier: BSD-3-Clause
"""What a test needs of the operating system."""

from __future__ import annotations

import sys

import pytest

on_linux = pytest.mark.skipif(
    sys.platform != "linux", reason="programs and scripts follow simulated time on Linux alone"
)
