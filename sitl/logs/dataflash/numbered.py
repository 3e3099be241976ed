# SPDX-License-Identifier: BSD-3-Clause
"""On-board logs numbered over all runs of a folder, as ArduPilot's simulator keeps them.

00000001.BIN, 00000002.BIN, ...; LASTLOG.TXT holds the number of the last one. Clients see all that are there.
"""

from __future__ import annotations

import contextlib
from pathlib import Path

from .log import DataFlash, Entry, LogError, LogFile

LAST = "LASTLOG.TXT"


class NumberedLogs(DataFlash):
    """A logger whose ``path`` is a folder."""

    def _new_file(self, unix_us: int) -> LogFile:
        last = self.path / LAST
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            number = self._last_number() + 1
            path = self._path(number)
            path.unlink(missing_ok=True)
            file = LogFile(path, unix_us)
            last.write_bytes(b"%d\r\n" % number)
        except OSError as error:
            self._on = False  # say it once
            raise LogError(f"log in {str(self.path)!r} cannot be written: {error.strerror or error}") from None
        self._files.append(file)
        return file

    def _path(self, number: int) -> Path:
        return self.path / f"{number:08d}.BIN"

    def _last_number(self) -> int:
        with contextlib.suppress(OSError, ValueError):
            return int((self.path / LAST).read_text().strip())
        return max((int(path.stem) for path in self._present()), default=0)

    def _present(self) -> list[Path]:
        """Logs of this and other runs, the oldest first."""
        if not self.path.is_dir():
            return []
        return sorted(path for path in self.path.glob("*.BIN") if len(path.stem) == 8 and path.stem.isdigit())

    # ------------------------------------------------------------------ handing out

    def entries(self) -> list[Entry]:
        self._flush()
        stats = [path.stat() for path in self._present()]
        times = {file.path: file.time_utc for file in self._files}
        return [
            Entry(k + 1, times.get(path, int(stat.st_mtime)), stat.st_size)
            for k, (path, stat) in enumerate(zip(self._present(), stats, strict=True))
        ]

    def read(self, number: int, offset: int, count: int) -> bytes:
        present = self._present()
        if not 0 < number <= len(present):
            return b""
        try:
            with present[number - 1].open("rb") as file:
                file.seek(offset)
                return file.read(count)
        except OSError:
            return b""

    def erase(self) -> None:
        """Remove all logs of the folder, and start a new one if one was being written."""
        super().erase()
        with contextlib.suppress(OSError):
            for path in (*self._present(), self.path / LAST):
                path.unlink(missing_ok=True)
