# SPDX-License-Identifier: BSD-3-Clause
"""docs/extending.md: every example is run as it stands, in a process and a folder of its own."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs/extending.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```python ?(\S*)\n(.*?)^```$", re.M | re.S)
EXAMPLES = {
    title: blocks
    for title, text in (section.split("\n", 1) for section in PAGE.split("\n## ")[1:])
    if (blocks := BLOCK.findall(text))
}
CORE = ("A mode", "A fault", "A parameter")
"""They compile a core of their own."""


@pytest.mark.parametrize(
    "title", [pytest.param(t, marks=pytest.mark.slow) if t in CORE else t for t in EXAMPLES], ids=lambda t: t
)
def test_an_example_does_what_it_says(title: str, tmp_path: Path) -> None:
    *files, (name, program) = EXAMPLES[title]
    assert not name, "the last block is the program"
    for file, text in files:
        (tmp_path / file).write_text(text)
    environment = {k: v for k, v in os.environ.items() if not k.startswith("SITL_M") and k != "SITL_PARAMETERS"}
    environment["PYTHONPATH"] = os.pathsep.join((str(tmp_path), str(ROOT)))
    ran = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=900
    )
    assert ran.returncode == 0, ran.stderr[-3000:]


def test_every_way_in_has_an_example_or_a_test() -> None:
    rows = [line.split("|")[1].strip() for line in PAGE.splitlines() if line.startswith("| a ")]
    assert len(rows) == 8
    assert set(EXAMPLES) == {
        "A mode", "A parameter", "A message that is sent", "A message that is taken", "A fault", "A physics engine",
        "A task of environments",
    }  # fmt: skip
    assert (ROOT / "tests/vehicle/test_kinds.py").exists()
