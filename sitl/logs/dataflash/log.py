# SPDX-License-Identifier: BSD-3-Clause
"""The on-board logger: an observer that keeps DataFlash logs of a vehicle in files, and hands them out.

LOG_BACKEND_TYPE, LOG_DISARMED and LOG_BITMASK decide, as in ArduPilot: unless LOG_DISARMED says so, a log begins with
the first arming and pauses 15 s after each disarming. A reboot begins another.
"""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import BinaryIO, NamedTuple

from ..tlog import LogError
from .book import Book, Vehicle
from .samples import place

PERSIST_US = 15_000_000
"""Logging goes on for so long after disarming."""
POLL_US = 100_000
"""How often a logger that is not logging looks whether it should."""
_ALWAYS, _KEEP_FLIGHTS = (1, 2, 3), 3
_COUNT, _ARMED, _ARMED_US = "autopilot.events.count", "autopilot.arming.armed", "autopilot.arming.armed_us"


class Entry(NamedTuple):
    """A log that can be read."""

    number: int
    """From 1 on."""
    time_utc: int
    """When it began [s, Unix]."""
    size: int
    """[bytes] so far"""


class _File:
    def __init__(self, path: Path, unix_us: int) -> None:
        self.path, self.time_utc, self.size = path, unix_us // 1_000_000, 0
        self.flown = False
        self.handle: BinaryIO | None = path.open("xb")

    def append(self, data: bytes) -> None:
        if self.handle is None or not data:
            return
        try:
            self.handle.write(data)
            self.handle.flush()
        except OSError as error:
            self.close()
            raise LogError(f"log {str(self.path)!r} cannot be written: {error.strerror or error}") from None
        self.size += len(data)

    def close(self) -> None:
        handle, self.handle = self.handle, None
        if handle is not None:
            with contextlib.suppress(OSError):
                handle.close()


class DataFlash:
    """An observer of a simulation (``simulation.observers``), a listener and the log store of its bridge.

    Args:
        vehicle: the simulation.
        path: of the first log (.bin); later ones get ``.2``, ``.3``, ... before the ending.
        epoch_us: Unix time of the start of the simulation [us].
        version: text that says which program this is.
    """

    def __init__(self, vehicle: Vehicle, path: str | Path, epoch_us: int, version: str = "gym-sitl") -> None:
        self.path, self.epoch_us = Path(path), epoch_us
        self._vehicle, self._version = vehicle, version
        self._files: list[_File] = []
        self._started = 0
        words = memoryview(vehicle.fleet.view("<i8").reshape(len(vehicle.fleet), -1)[vehicle.index])
        self._words = words
        at = {name: place(vehicle.fleet.dtype, name)[0] // 8 for name in ("time_us", _COUNT, _ARMED, _ARMED_US)}
        self._time_at, self._count_at, self._armed_at, self._armed_us_at = at.values()
        self._closed = False
        self._boot()

    def _boot(self) -> None:
        self._boot_us = self._vehicle.before_boot_us
        self._book: Book | None = None
        self._file: _File | None = None
        self._paused = False
        self._disarmed_us = -PERSIST_US
        self._since_us = 0
        self._said: list[tuple[int, str]] = []
        self._count = 0
        self._settings()
        self._find_due()

    def _settings(self) -> None:
        params = self._vehicle.v.autopilot.params
        self._on = int(params.LOG.BACKEND_TYPE) & 1 != 0 and not self._closed
        self._disarmed = int(params.LOG.DISARMED)
        if self._book is not None:
            self._book.choose(int(params.LOG.BITMASK))

    @property
    def _now_us(self) -> int:
        """Since boot."""
        return int(self._words[self._time_at])

    # ------------------------------------------------------------------ observing

    def _find_due(self) -> None:
        now = self._words[self._time_at]
        if self._book is None or self._paused:
            self.due_us = self._boot_us + (now // POLL_US + 1) * POLL_US
            return
        due = now + POLL_US
        for period in self._book.periods_us:
            due = min(due, (now // period + 1) * period)
        self.due_us = self._boot_us + due

    def observe(self) -> None:
        """Take a sample, or see whether to begin."""
        self._follow_reboot()
        armed = self._words[self._armed_at]
        now = self._words[self._time_at]
        if armed:
            self._disarmed_us = now
        wanted = self._on and (self._disarmed in _ALWAYS or now - self._disarmed_us < PERSIST_US)
        if self._book is None or self._paused:
            if wanted:
                self._begin(now)
            else:
                self._said.clear()
        elif not wanted:
            self._paused, self._since_us = True, now
            self._flush()
        book = self._book
        if book is not None and not self._paused:
            if self._words[self._count_at] != self._count:
                self._count = self._words[self._count_at]
                book.read_events()
            if self._vehicle.mission is not book.mission:
                book.mission_changed(now)
            book.row()
            if book.pending:
                self._flush()
        if armed and self._file is not None:
            self._file.flown = True
        self._find_due()

    def _follow_reboot(self) -> None:
        if self._vehicle.before_boot_us != self._boot_us:
            self._end()
            self._boot()

    def _begin(self, now: int) -> None:
        """Begin a log, or go on with one; with what came since arming, or since boot."""
        armed_us = 0 if self._disarmed in _ALWAYS else self._words[self._armed_us_at]
        since = max(armed_us, self._since_us)
        if self._book is None:
            unix_us = self.epoch_us + self._boot_us
            bitmask = int(self._vehicle.v.autopilot.params.LOG.BITMASK)
            self._file = self._new_file(unix_us + now)
            self._book = Book(self._vehicle, unix_us, bitmask, self._version)
            self._book.begin(min(since, now))
        self._paused = False
        self._book.skip_events_before(since)
        self._count = -1
        for time_us, text in self._said:
            if time_us >= since:
                self._book.said(time_us, text)
        self._said.clear()

    def _new_file(self, unix_us: int) -> _File:
        while True:
            self._started += 1
            k = self._started
            path = self.path if k == 1 else self.path.with_name(f"{self.path.stem}.{k}{self.path.suffix}")
            try:
                if path.exists():
                    continue
                path.parent.mkdir(parents=True, exist_ok=True)
                file = _File(path, unix_us)
            except OSError as error:
                self._on = False  # say it once
                raise LogError(f"log {str(path)!r} cannot be written: {error.strerror or error}") from None
            self._files.append(file)
            return file

    # ------------------------------------------------------------------ listening

    def said(self, severity: int, text: str) -> None:
        """The vehicle told its clients something."""
        self._follow_reboot()
        now = self._now_us
        if self._book is None or self._paused:
            self._said.append((now, text))
            if self._words[self._armed_at]:
                self.due_us = min(self.due_us, self._boot_us + now)  # the log begins with the next tick
            return
        self._catch_up()
        self._book.said(now, text)

    def parameter_set(self, name: str) -> None:
        """A parameter was set."""
        self._follow_reboot()
        if self._book is not None and not self._paused:
            self._catch_up()
            self._book.parameter(self._now_us, name)
        if name.startswith("LOG_"):
            self._settings()
            self._find_due()

    def reached(self, seq: int) -> None:
        """Nothing to this log: it has CMD, and the text."""

    def _catch_up(self) -> None:
        """What the core emitted comes before what is said of it."""
        if self._book is not None:
            self._count = self._words[self._count_at]
            self._book.read_events()

    # ------------------------------------------------------------------ handing out

    def entries(self) -> list[Entry]:
        """All logs, with all that is known by now in them."""
        self._flush()
        return [Entry(k + 1, file.time_utc, file.size) for k, file in enumerate(self._files)]

    def read(self, number: int, offset: int, count: int) -> bytes:
        """Bytes of a log; fewer at its end, none of one that is not there."""
        if not (0 < number <= len(self._files)):
            return b""
        try:
            with self._files[number - 1].path.open("rb") as file:
                file.seek(offset)
                return file.read(count)
        except OSError:
            return b""

    def erase(self) -> None:
        """Forget all logs, and begin another if one was being written. The files stay where they are."""
        self._end()
        self._files.clear()
        self._since_us = self._now_us
        self._book = self._file = None
        self._find_due()

    def close(self) -> None:
        """Write everything and close the file; nothing is logged after that."""
        if not self._closed:
            self._closed = True
            self._end()
            self._book = None
            self._on = False

    def _flush(self) -> None:
        if self._book is not None and self._file is not None:
            self._file.append(self._book.take_bytes())

    def _end(self) -> None:
        """Close the present log."""
        self._flush()
        file = self._file
        if file is None:
            return
        file.close()
        if self._disarmed == _KEEP_FLIGHTS and not file.flown and file in self._files:
            self._files.remove(file)
            with contextlib.suppress(OSError):
                file.path.unlink()
