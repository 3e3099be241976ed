# SPDX-License-Identifier: BSD-3-Clause
"""Fingerprints are the same in every process, or machine code would be made again by each."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from sitl.core.constant_tables import constant_table
from sitl.core.fingerprint import _walk

SHOW = """
import sys
from sitl.core.fingerprint import _code
def law(x):
    return {"within": x in {"a", "b", "c", "d"}, "later": lambda y: y + 2.5}
print(_code(law.__code__))
"""


def test_code_within_code_and_sets_are_written_alike_in_every_process() -> None:
    texts = set()
    for seed in ("1", "2", "3"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(__file__).parents[2])}
        command = [sys.executable, "-c", f"pad = [object()] * {seed}000\n{SHOW}"]
        texts.add(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)
    assert len(texts) == 1
    assert "2.5" in texts.pop()


def test_the_numbers_of_a_table_count() -> None:
    def looks_up(*numbers: float) -> list[str]:
        lines: list[str] = []
        _walk(constant_table(*numbers), set(), set(), lines)
        return lines

    assert looks_up(1.0, 2.0) == looks_up(1.0, 2.0) != looks_up(1.0, 2.5)


def test_every_kernel_has_one_fingerprint_in_all_processes() -> None:
    show = (
        "from importlib import import_module\n"
        "from sitl.cli.cache import KERNEL_MODULES\n"
        "from sitl.core import array_kernels as k\n"
        "for name in {order}(KERNEL_MODULES): import_module(name)\n"
        "print(*sorted(k._folder(x, k._signature(x.law)).name for x in k.KERNELS.values()), sep='\\n')"
    )
    printed = set()
    for order in ("sorted", "reversed"):
        environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
        command = [sys.executable, "-c", show.format(order=order)]
        printed.add(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)
    (names,) = printed
    assert len(names.split()) > 30
