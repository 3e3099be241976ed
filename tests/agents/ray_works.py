# SPDX-License-Identifier: BSD-3-Clause
"""Works that workers of other processes do for tests of the backends."""

from __future__ import annotations

import os
import signal

from sitl.agents.runs import folder as keeper
from sitl.agents.runs.training import train_one


def train_eagerly(path, tell, stopped):
    """Report the process first; then train with checkpoints all the time."""
    tell(os.getpid())
    keeper._FIRST_S, keeper.PERIOD_S, keeper._REPORT_S = 0.02, 0.02, 0.02
    return train_one(path, tell, stopped)


def die(item, tell, stopped):
    """End the process at once."""
    os.kill(os.getpid(), signal.SIGKILL)


def threads(item, tell, stopped):
    return os.environ.get("OMP_NUM_THREADS")


class OddError(Exception):
    """Cannot be pickled."""

    def __init__(self, a, b):
        super().__init__(f"{a} and {b}")


def fail_oddly(item, tell, stopped):
    raise OddError("this", "that")


def write_and_list(item, tell, stopped):
    """Write in a folder, forget a file of it; returns where that was, and what was there."""
    folder, word = item
    there = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    (folder / "inner").mkdir(exist_ok=True)
    (folder / "inner" / "new").write_text(word)
    (folder / "old").unlink()
    tell(word)
    return str(folder), there
