# SPDX-License-Identifier: BSD-3-Clause
"""Processes of a test: a network of their own where that is allowed, and none of them left when the test is over."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import uuid
from collections.abc import Sequence
from pathlib import Path

NAMESPACES = (("unshare", "--net"), ("unshare", "--net", "--map-root-user"))
MARK = "SITL_CONFORMANCE_TEST"
"""Environment variable by which the processes of a test know each other, whatever session they are in."""


def namespace() -> tuple[str, ...]:
    """Words that give a command a network namespace of its own; none where that is not allowed."""
    for words in NAMESPACES:
        try:
            if subprocess.run([*words, "true"], capture_output=True, timeout=10).returncode == 0:
                return words
        except (OSError, subprocess.TimeoutExpired):
            continue
    return ()


def run(command: Sequence[str], folder: Path, log: Path, timeout_s: float, environment: dict[str, str]) -> int | None:
    """Run a command and end all that it started; returns its exit code, None when the time was not enough."""
    mark = uuid.uuid4().hex
    environment = {**environment, MARK: mark}
    with log.open("wb") as out:
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
            start_new_session=True,
        )  # fmt: skip
        try:
            return process.wait(timeout_s)
        except subprocess.TimeoutExpired:
            return None
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
            while left := marked(mark):  # one that is killed goes on until it has been given processor time to end
                for pid in left:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(pid, signal.SIGKILL)


def marked(mark: str) -> list[int]:
    """Processes that carry the mark (Linux; elsewhere they end with their parents)."""
    if not sys.platform.startswith("linux"):
        return []
    wanted = f"{MARK}={mark}".encode()
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if wanted in (entry / "environ").read_bytes().split(b"\0"):
                    found.append(int(entry.name))
            except OSError:
                continue
    return found
