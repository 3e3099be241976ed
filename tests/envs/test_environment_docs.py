# SPDX-License-Identifier: BSD-3-Clause
"""The examples of docs/environments.md run, and its tables name what there is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from sitl import envs
from sitl.envs.observations import OBSERVATIONS
from sitl.envs.tasks import TASKS

PAGE = (Path(__file__).parents[2] / "docs/environments.md").read_text()
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES, ids=range(len(EXAMPLES)))
def test_examples_run(example):
    exec(compile(example, "docs/environments.md", "exec"), {})


def test_page_names_every_environment_and_piece():
    for name in (*envs.PAPER, *(f'"{n}"' for n in (*OBSERVATIONS, *TASKS))):
        assert name in PAGE, name
