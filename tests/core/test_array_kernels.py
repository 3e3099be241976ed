# SPDX-License-Identifier: BSD-3-Clause
"""Kernels: compiled once, loaded from the cache, and never stale."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

LAWS = """
from sitl.core.kernels import law
@law
def grow(x):
    return 2.0 * x
"""
KERNEL = """
import numpy as np
from sitl.core.kernels import law
from sitl.core.array_kernels import Kernel, Line
from toy_room import grow

@law
def grow_all(values: Line) -> None:
    for k in range(values.shape[0]):
        values[k] = grow(values[k])

grown = Kernel(grow_all)
values = np.ones(3)
grown(values)
print(values.tolist())
"""


def run(folder: Path) -> str:
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join((str(Path(__file__).parents[2]), str(folder))),
        "SITL_CACHE_DIR": str(folder / "cache"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    command = [sys.executable, "-c", "import toy_kernel"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_an_edit_of_a_law_elsewhere_is_noticed(tmp_path: Path) -> None:
    (tmp_path / "toy_room.py").write_text(LAWS)
    (tmp_path / "toy_kernel.py").write_text(KERNEL)
    assert run(tmp_path) == "[2.0, 2.0, 2.0]"
    machine_code = {p: p.stat().st_mtime_ns for p in (tmp_path / "cache").rglob("*.nbc")}
    assert len(machine_code) == 1
    assert run(tmp_path) == "[2.0, 2.0, 2.0]"
    assert {p: p.stat().st_mtime_ns for p in (tmp_path / "cache").rglob("*.nbc")} == machine_code, (
        "loaded, not compiled"
    )
    (tmp_path / "toy_room.py").write_text(LAWS.replace("2.0", "3.0"))
    assert run(tmp_path) == "[3.0, 3.0, 3.0]"
    assert len(list((tmp_path / "cache").glob("*/built"))) == 2
