# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark of environments prints a row for each, with its ratio to CartPole-v1's."""

from __future__ import annotations

import re
import sys

import pytest

from benchmarks import envs as benchmark
from sitl import envs

pytest.importorskip("pygame")


def test_every_environment_has_a_row(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["benchmarks.envs", "--repeats", "1", "--steps", "2000"])
    monkeypatch.setattr(benchmark, "VECTORS", (16,))
    benchmark.main()
    out = capsys.readouterr().out
    for name in (benchmark.CARTPOLE, *envs.PAPER):
        row = re.search(rf"^{name} +([\d,]+) +([\d,]+)x +([\d.]+) ", out, re.MULTILINE)
        assert row, f"no row of {name} in\n{out}"
        assert float(row[2].replace(",", "")) > 0.0 and float(row[3]) > 0.0
    assert re.search(r", reset +[\d.]+ us", out)
