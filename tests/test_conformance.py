# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.conformance`` on a suite of three tests that this file writes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.conformance import processes

ROOT = Path(__file__).parents[1]
SUITE = """
import os, subprocess, sys, threading
from pathlib import Path
from types import SimpleNamespace


class AutoTestCopter:
    def __init__(self, binary, speedup, _show_test_timings):
        self.binary, self.speedup = binary, speedup

    def autotest(self, tests, allow_skips):
        self.fail_list = []
        for test in tests:
            try:
                test()
            except Exception as error:
                self.fail_list.append(SimpleNamespace(exception=error))
        return not self.fail_list

    def Good(self):
        assert self.speedup == 7 and Path.cwd() == Path(os.environ["BUILDLOGS"]), self.speedup
        said = subprocess.run([self.binary, "--help"], capture_output=True, text=True, check=True).stdout
        assert "usage: arducopter" in said, said

    def Bad(self):
        raise ValueError("neither this\\n nor | that")

    def Hangs(self):
        words = "import threading; threading.Event().wait()"
        left = subprocess.Popen([sys.executable, "-c", words], start_new_session=True)
        Path("left").write_text(str(left.pid))
        threading.Event().wait()
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the driver is for Linux")
@pytest.mark.slow
def test_a_table_of_what_passes_fails_and_hangs(tmp_path: Path) -> None:
    (tmp_path / "suite" / "Tools" / "autotest").mkdir(parents=True)
    (tmp_path / "suite" / "Tools" / "autotest" / "arducopter.py").write_text(SUITE)
    names = tmp_path / "names.txt"
    names.write_text("# tests\nBad a remark\n\nGood\n")
    out, folder = tmp_path / "table", tmp_path / "runs"
    words = ["--suite", str(tmp_path / "suite"), "--speedup", "7", "--timeout", "20", "--jobs", "2", "--out", str(out)]
    words += ["--folder", str(folder), "copter", "Hangs", f"@{names}"]
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.conformance", *words],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 1, done.stderr
    told = {test["test"]: test for test in json.loads(out.with_suffix(".json").read_text())["tests"]}
    assert {name: test["result"] for name, test in told.items()} == {"Hangs": "timeout", "Bad": "fail", "Good": "pass"}
    assert told["Bad"]["cause"] == "ValueError: neither this nor | that"
    assert told["Bad"]["where"].startswith("arducopter.py:") and "raise ValueError" in told["Bad"]["where"]
    text = out.with_suffix(".md").read_text()
    assert text.startswith("1 of 3 pass (`sitl arducopter`, speed-up 7).") and "nor \\| that" in text
    left = Path("/proc") / (folder / "copter" / "Hangs" / "left").read_text()
    assert not left.exists() or not (left / "cmdline").read_bytes(), "it is gone, or nobody has asked how it ended"


def test_a_suite_that_is_not_there_is_named(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.conformance", "--suite", str(tmp_path), "rover", "Any"],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 1 and "there is no folder Tools/autotest" in done.stderr


def test_processes_are_found_by_their_mark() -> None:
    assert processes.marked("nobody has this mark") == []
