# SPDX-License-Identifier: BSD-3-Clause
"""Client scripts in simulated time (``sitl exec``), and vehicles for clients of the test process (``sitl run``)."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

from sitl.simulation import Core
from tests.ports import free_port


@pytest.fixture
def fly(core: Core, tmp_path: Path) -> Fly:
    """``fly(script, url, *options)``: see ``run_script``."""
    return partial(run_script, tmp_path)


ROOT = Path(__file__).parents[2]
SCRIPTS = Path(__file__).parent / "scripts"
EXAMPLES = ROOT / "examples"
SPEEDUP = "20"
FASTEST = "max"
WALL_S = 300
"""A script that takes longer has hung: on two idle cores it takes 3 to 10 s."""

Fly = Callable[..., str]


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def run_script(
    logs: Path,
    script: Path,
    url: str,
    *options: str,
    vehicle: str = "copter",
    speedup: str = SPEEDUP,
    folder: Path = ROOT,
) -> str:
    """Run a script in a folder, against a vehicle of its own (on the ground it drives); what it printed.

    Fails when the script does; where scripts run in real time alone, the test is skipped. ``PORT`` in ``url`` becomes
    the UDP port that the vehicle sends to.
    """
    if sys.platform != "linux":
        pytest.skip("scripts follow simulated time on Linux alone")
    port = str(free_port())
    command = [sys.executable, "-m", "sitl", "exec", "--vehicle", vehicle, "--quiet", "--speedup", speedup]
    command += ["--tcp", "0", "--out", f"udp:127.0.0.1:{port}", "--log-dir", str(logs), *options]
    command += ["--", sys.executable, str(script), url.replace("PORT", port)]
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment(), text=True, timeout=WALL_S,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
    except subprocess.TimeoutExpired as late:
        pytest.fail(f"{script.name} has not ended after {WALL_S:g} s; it printed:\n{(late.stdout or b'').decode()}")
    assert done.returncode == 0, done.stdout
    return done.stdout


@contextmanager
def serve(logs: Path, *options: str, vehicle: str = "copter") -> Iterator[int]:
    """A vehicle served in real time (or as the options say) on a TCP port of this machine, which is given."""
    command = [sys.executable, "-m", "sitl", "run", vehicle, "--quiet", "--tcp", "0", "--out", "none"]
    command += ["--log-dir", str(logs), *options]
    process = subprocess.Popen(command, cwd=ROOT, env=environment(), stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        said = process.stdout.readline()
        found = re.search(r"tcp:127\.0\.0\.1:(\d+)", said)
        assert found is not None, said
        yield int(found.group(1))
    finally:
        process.terminate()
        process.wait(60)
