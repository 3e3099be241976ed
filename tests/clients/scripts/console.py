# SPDX-License-Identifier: BSD-3-Clause
"""A MAVProxy console on the other end of a pipe, for the scripts of these tests."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

TROUBLE = re.compile(r"unable|timed out|timeout|traceback|error|breach|unknown|failed|denied", re.IGNORECASE)
MODULES = "log,wp,rally,fence,ftp,param,arm,mode,rc,cmdlong,misc,output,link"


class Console:
    """MAVProxy as it is started at a prompt, with a folder of its own."""

    def __init__(self, master: str) -> None:
        self.folder = Path(tempfile.mkdtemp())
        command = [
            sys.executable, str(Path(sys.executable).parent / "mavproxy.py"), f"--master={master}", "--streamrate=5",
            f"--state-basedir={self.folder}", f"--default-modules={MODULES}",
        ]  # fmt: skip
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1,
            start_new_session=True, cwd=self.folder,
        )  # fmt: skip
        self._said: list[str] = []
        threading.Thread(target=self._listen, daemon=True).start()
        self.expect("parameters (ftp)", 60.0)
        self.check("a quiet start", not self._trouble())
        self.expect("is using GPS", 90.0)

    def _listen(self) -> None:
        for line in self._process.stdout:
            self._said.append(line)
            print(line, end="", flush=True)

    def _trouble(self) -> bool:
        return any(TROUBLE.search(line) for line in self._said)

    def end(self) -> None:
        """At the end of its input MAVProxy would wait for a child of its own."""
        os.killpg(self._process.pid, signal.SIGKILL)

    def check(self, what: str, ok: object) -> None:
        """End the script when it is not so."""
        if not ok:
            print("FAILED:", what, flush=True)
            self.end()
            sys.exit(1)

    def expect(self, text: str, seconds: float = 30.0) -> None:
        """Wait for what MAVProxy says."""
        end = time.monotonic() + seconds
        while not any(text in line for line in self._said) and time.monotonic() < end:
            time.sleep(0.1)
        self.check(text, any(text in line for line in self._said))

    def say(self, line: str, text: str = "", seconds: float = 30.0) -> None:
        """Type a line and wait for what it makes MAVProxy say; some lines it takes without a word."""
        self._said.clear()
        print(">", line, flush=True)
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()
        if text:
            self.expect(text, seconds)
        else:
            time.sleep(2.0)
        self.check(f"no trouble after {line!r}", not self._trouble())
