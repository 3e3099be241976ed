# SPDX-License-Identifier: BSD-3-Clause
"""Logs of runs: names that nobody else has, and what happens when there is no room."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.logs.tlog import LogError, TlogWriter
from sitl.runner import new_file


def test_two_runs_never_share_a_log(tmp_path: Path) -> None:
    names = [new_file(tmp_path, "copter").name for _ in range(3)]
    assert names == ["copter.tlog", "copter-2.tlog", "copter-3.tlog"]
    with pytest.raises(LogError, match="cannot be written: No such file"):
        new_file(tmp_path / "absent", "copter")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs Linux's device without room")
def test_a_full_disk_is_named_once() -> None:
    writer = TlogWriter("/dev/full", 0)
    writer.frame(0, b"frame")
    with pytest.raises(LogError, match="'/dev/full' cannot be written: No space left"):
        writer.flush()
    writer.frame(1, b"frame")
    writer.close()
