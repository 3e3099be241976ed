# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle in a process of its own, for environments that reach it by socket."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys


@contextlib.contextmanager
def vehicle(folder, kind, world, *options):
    """``sitl run`` in ``folder``; gives its TCP port and its process."""
    command = [sys.executable, "-m", "sitl", "run", kind, "--world", world, "--tcp", "0", "--quiet", *options]
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    with subprocess.Popen(command, cwd=folder, env=env, stdout=subprocess.PIPE, text=True) as process:
        try:
            for line in process.stdout:
                if "tcp:" in line:
                    yield int(line.rsplit(":", 1)[1]), process
                    break
        finally:
            process.kill()
