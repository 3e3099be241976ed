# SPDX-License-Identifier: BSD-3-Clause
"""``sitl cache``: all that is compiled is found by it."""

from __future__ import annotations

import re
from pathlib import Path

import sitl
from sitl.cli.cache import KERNEL_MODULES
from sitl.core.array_kernels import build_kernels, missing_kernels
from sitl.core.build_work import FIRST_LINE, ProgressLines

PACKAGE = Path(sitl.__file__).parent


def test_every_module_that_makes_kernels_is_listed() -> None:
    making = {
        "sitl." + ".".join(file.relative_to(PACKAGE).with_suffix("").parts)
        for file in PACKAGE.rglob("*.py")
        if re.search(r"^\w.*= .*\bKernel\(", file.read_text(encoding="utf-8"), re.M)
    }
    assert making == set(KERNEL_MODULES)


def test_kernels_are_compiled_beforehand(no_library, monkeypatch, tmp_path) -> None:
    monkeypatch.setenv("SITL_CACHE_DIR", str(tmp_path))
    (task,) = missing_kernels(["sitl.envs.tasks"])
    told = []
    build_kernels(["sitl.envs.tasks"], lambda name, done, total: told.append(name))
    assert set(told) == {task.partition(":")[2]}
    assert not missing_kernels(["sitl.envs.tasks"])


def test_progress_without_a_terminal_is_lines(capsys) -> None:
    now = [0.0]
    lines = ProgressLines(lambda: now[0])
    for k in range(41):
        now[0] = float(k)
        lines("a.unit", k / 2, 40.0)
    lines("b.unit", 0.0, 10.0)
    assert capsys.readouterr().err.splitlines() == [
        FIRST_LINE, "   19 % after 15 s (a.unit)", "   38 % after 30 s (a.unit)",
    ]  # fmt: skip
