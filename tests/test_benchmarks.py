# SPDX-License-Identifier: BSD-3-Clause
"""The benchmarks run and print what they measure; how fast is not asked here."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from sitl.simulation import Core, load_core
from sitl.vehicle.kinds import KINDS

ROOT = Path(__file__).parents[1]


@pytest.mark.slow
def test_every_figure_of_both_vehicles_is_printed(core: Core) -> None:
    load_core(KINDS["rover"])
    command = [sys.executable, "-m", "benchmarks", "--repeats", "1"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    factors = [float(x) for x in re.findall(r"(\d+)x   \(", result.stdout)]
    assert len(factors) == 10 and all(f > 0 for f in factors), result.stdout
    assert len(re.findall(r"restore +[\d.]+ us", result.stdout)) == 2
