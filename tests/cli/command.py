# SPDX-License-Identifier: BSD-3-Clause
"""The ``sitl`` command in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def sitl(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """What a user gets who types it in ``folder``."""
    command = [sys.executable, "-m", "sitl", *arguments]
    return subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True, timeout=300)
