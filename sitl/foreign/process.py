# SPDX-License-Identifier: BSD-3-Clause
"""A foreign autopilot's program as a child process in its own folder, which never outlives this process."""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..bridge.frame import CHECKSUM, HEADER_V1, HEADER_V2, MARK_V1, MARK_V2, SIGNATURE, SIGNED
from ..errors import OptionError, SitlError

OUTPUT = "output.txt"
GRACE_S = 3.0
_LAST_LINES = 6


class AutopilotEndedError(SitlError, RuntimeError):
    """The autopilot's program has ended by itself; the message has its exit code or signal and its last output."""


class AutopilotProcess:
    """A running program.

    Args:
        command: program and arguments; "{folder}" in an argument becomes the folder.
        files: files to write into the folder first: name -> text or bytes.
        environment: environment variables added to ours; "{folder}" in a value becomes the folder.
        folder: working folder; None: a temporary one that is deleted at the end.
        grace_s: wall time that it has to end when it is asked to [s]; 0: it is killed at once.
        descriptors: open files that it inherits.

    Raises:
        OptionError: it cannot be started.
    """

    def __init__(
        self,
        command: Sequence[str],
        files: Mapping[str, str | bytes],
        environment: Mapping[str, str],
        folder: Path | None = None,
        grace_s: float = GRACE_S,
        descriptors: Sequence[int] = (),
    ) -> None:
        self._owned, self._grace_s = folder is None, grace_s
        # Whole: the program is started in it, and is given paths in it.
        self.folder = Path(tempfile.mkdtemp(prefix="gym-sitl-")) if folder is None else folder.resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.command = [word.replace("{folder}", str(self.folder)) for word in command]
        added = {name: value.replace("{folder}", str(self.folder)) for name, value in environment.items()}
        for name, content in files.items():
            (self.folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
        try:
            with (self.folder / OUTPUT).open("wb") as output:
                self._process = subprocess.Popen(
                    self.command, cwd=self.folder, env={**os.environ, **added}, stdin=subprocess.DEVNULL,
                    stdout=output, stderr=subprocess.STDOUT, start_new_session=True, pass_fds=descriptors,
                )  # fmt: skip
        except OSError as error:
            self._forget_folder()
            why = error.strerror or error
            raise OptionError(f"autopilot {self.command[0]!r} cannot be started: {why}") from None
        self._watch = self._watched()
        atexit.register(self.stop)  # also when the caller forgets to stop it

    def _watched(self) -> subprocess.Popen[bytes]:
        """A shell that kills the program's process group when this process is killed, because its input ends then."""
        script = ["/bin/sh", "-c", 'read _; kill -9 "-$0"', str(self._process.pid)]
        silent = subprocess.DEVNULL
        return subprocess.Popen(script, stdin=subprocess.PIPE, stdout=silent, stderr=silent, start_new_session=True)

    def _watch_no_more(self) -> None:
        """Stop watching before the number of its process group can be reused."""
        self._watch.kill()
        self._watch.wait()
        if self._watch.stdin is not None:
            self._watch.stdin.close()

    @property
    def pid(self) -> int:
        """Process id, which is also the id of its process group."""
        return self._process.pid

    def is_running(self) -> bool:
        """Whether the process is running."""
        return self._process.poll() is None

    def ended(self, seconds: float = 0.0) -> int | None:
        """Its exit code, or less a signal, once it has ended, which is waited for so long [s]; None: it goes on."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self._process.wait(timeout=seconds)
        return None

    def check(self) -> None:
        """Raise AutopilotEndedError if it has ended."""
        code = self._process.poll()
        if code is not None:
            self._watch_no_more()
            how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
            raise AutopilotEndedError(f"autopilot {self.command[0]} {how}; it said: {self.last_output()}")

    def output(self) -> str:
        """All that it has said."""
        try:
            return (self.folder / OUTPUT).read_text(errors="replace")
        except OSError:
            return ""

    def last_output(self) -> str:
        """The last lines of its output."""
        lines = self.output().split("\n")
        return " / ".join([line.strip() for line in lines if line.strip()][-_LAST_LINES:]) or "nothing"

    def stop(self) -> None:
        """End the process and its children; may be called twice."""
        atexit.unregister(self.stop)
        if self._process.poll() is None and self._grace_s > 0.0:
            self._signal(signal.SIGTERM)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(timeout=self._grace_s)
        self._watch_no_more()
        self._signal(signal.SIGKILL)  # also what is left of its group
        self._process.wait()
        self._forget_folder()

    def _signal(self, number: int) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, number)

    def _forget_folder(self) -> None:
        if self._owned:
            shutil.rmtree(self.folder, ignore_errors=True)


_STARTS = bytes((MARK_V1, MARK_V2))


class Cutter:
    """Splits a stream into frames by start mark and length. TCP loses nothing, so that it stays in step; what
    does not begin with a start mark is left out."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[bytes]:
        """The frames completed by ``data``."""
        buffer = self._rest + data
        frames: list[bytes] = []
        at, end = 0, len(buffer)
        while at < end:
            if buffer[at] not in _STARTS:
                at += 1
                continue
            header = HEADER_V2 if buffer[at] == MARK_V2 else HEADER_V1
            if at + header > end:
                break
            size = header + buffer[at + 1] + CHECKSUM
            if header == HEADER_V2 and buffer[at + 2] & SIGNED:
                size += SIGNATURE
            if at + size > end:
                break
            frames.append(buffer[at : at + size])
            at += size
        self._rest = buffer[at:]
        return frames


HOST = "127.0.0.1"


def free_tcp_run(length: int) -> int:
    """The first of ``length`` TCP ports in a row that nobody listens on.

    Raises:
        OptionError: none are to be had.
    """
    for _ in range(64):
        with contextlib.ExitStack() as stack:
            first = 0
            try:
                for k in range(length):
                    probe = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_STREAM))
                    probe.bind((HOST, first + k if first else 0))
                    first = first or probe.getsockname()[1]
            except (OSError, OverflowError):
                continue
            return first
    raise OptionError(f"there are no {length} free TCP ports in a row on this machine")


def free_udp_port() -> int:
    """A UDP port of this machine that nobody has."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])
