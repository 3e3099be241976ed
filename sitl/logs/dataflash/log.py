# SPDX-License-Identifier: BSD-3-Clause
"""The on-board logger keeps DataFlash logs of a vehicle in files, and hands them out.

LOG_BACKEND_TYPE, LOG_DISARMED and LOG_BITMASK decide, as in ArduPilot: unless LOG_DISARMED says so, a log begins with
the first arming, or attempt at it, and pauses 15 s after each disarming or refusal. A reboot begins another; with
LOG_FILE_DSRMROT so does the arming after a disarming.
"""

from __future__ import annotations

import contextlib
from collections import deque
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from ...autopilot.arming_checks import ARMING_REFUSED
from ...autopilot.events import EVENT_RING
from ...autopilot.shell_parameters import rotates_logs
from ...core.constants import NEVER
from ...vehicle.sampler import LONGEST_US, next_row_us
from ...version import __version__
from ..tlog import LogError
from . import board
from .encoder import LogEncoder, Vehicle
from .samples import located

PERSIST_US = 15_000_000
"""Time after disarming, or a refused arming, during which logging continues [us]."""
POLL_US = LONGEST_US
"""Period at which a logger that is not logging checks whether it should [us]."""
_COMMANDS = 32
"""Commands that are kept for a log that begins with one of them."""
_ALWAYS, _KEEP_FLIGHTS = (1, 2, 3), 3
_COUNT, _ARMED, _ARMED_US = "autopilot.events.count", "autopilot.arming.armed", "autopilot.arming.armed_us"


class Entry(NamedTuple):
    """A log in the list that LOG_REQUEST_LIST gives."""

    number: int
    """Number of the log, from 1."""
    time_utc: int
    """Start of the log [s, Unix]."""
    size: int
    """Size so far [bytes]."""


class LogFile:
    """A log that is being written, or was."""

    def __init__(self, path: Path, unix_us: int) -> None:
        self.path, self.time_utc, self.size = path, unix_us // 1_000_000, 0
        self.flown = False
        self.handle: BinaryIO | None = path.open("xb")

    def append(self, data: bytes) -> None:
        """Write bytes at its end; LogError when that fails."""
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
        """No more is written."""
        handle, self.handle = self.handle, None
        if handle is not None:
            with contextlib.suppress(OSError):
                handle.close()


class DataFlash:
    """The logger of a simulation (``simulation.logger``), a listener and the log store of its bridge.

    The core takes the samples (``sitl.vehicle.sampler``); the logger itself looks when something has happened.

    Args:
        vehicle: the simulation.
        path: path of the first log (.bin); later ones get ``.2``, ``.3``, ... before the ending.
        epoch_us: Unix time of the start of the simulation [us].
        version: text that says which program this is.
    """

    def __init__(self, vehicle: Vehicle, path: str | Path, epoch_us: int, version: str = "gym-sitl") -> None:
        self.path, self.epoch_us = Path(path), epoch_us
        self._vehicle, self._version = vehicle, version
        self._files: list[LogFile] = []
        self._started = 0
        words = memoryview(vehicle.fleet.view("<i8").reshape(len(vehicle.fleet), -1)[vehicle.index])
        self._words = words
        at = {name: located(vehicle.fleet.dtype, name)[0] // 8 for name in ("time_us", _COUNT, _ARMED, _ARMED_US)}
        self._time_at, self._count_at, self._armed_at, self._armed_us_at = at.values()
        self._closed = False
        self._core_samples_armed = False
        """Whether the core takes samples of an armed vehicle."""
        self._boot()

    def _boot(self) -> None:
        self._boot_us = self._vehicle.before_boot_us
        self._encoder: LogEncoder | None = None
        self._file: LogFile | None = None
        self._paused = self._rotates_next = False
        self._disarmed_us = self._refused_us = -PERSIST_US
        self._since_us = self._read = 0
        self._texts: list[tuple[int, str]] = []
        self._commands: deque[tuple[int, tuple[Any, ...]]] = deque(maxlen=_COMMANDS)
        self._count = 0
        self._settings()
        self._find_due()

    def _settings(self) -> None:
        params = self._vehicle.v.autopilot.params
        self._on = int(params.LOG.BACKEND_TYPE) & 1 != 0 and not self._closed
        self._disarmed = int(params.LOG.DISARMED)
        self._rotates = rotates_logs(self._vehicle.parameters)
        if self._encoder is not None:
            self._encoder.set_bitmask(int(params.LOG.BITMASK))

    @property
    def _now_us(self) -> int:
        """Simulated time since boot [us]."""
        return int(self._words[self._time_at])

    # ------------------------------------------------------------------ looking at the vehicle

    def before_run(self, in_core: bool) -> tuple[int, int]:
        """What ``sitl.simulation.Logger`` says."""
        encoder = self._running
        self._core_samples_armed = False
        if encoder is None:
            if self._is_idle():
                self._due_us = NEVER
                return 0, NEVER
            if self._due_us == NEVER:
                self._find_due()
        elif in_core and self._core_samples(encoder):
            self._core_samples_armed = bool(self._words[self._armed_at])
            return encoder.sampler_address, NEVER
        return 0, self._next_us

    @property
    def paths(self) -> list[Path]:
        """Of the logs that are kept, oldest first."""
        return [file.path for file in self._files]

    def after_run(self) -> None:
        """What ``sitl.simulation.Logger`` says."""
        encoder = self._running
        if encoder is not None:
            if self._core_samples_armed:
                self._disarmed_us = max(self._disarmed_us, encoder.sampler.row_us)
            if encoder.is_full:
                self._flush()
        elif self._due_us == NEVER and not self._is_idle():
            if self._elapsed_us % POLL_US == 0:
                self._due_us = self._elapsed_us
            else:
                self._find_due()
        if self._next_us <= self._vehicle.time_us:
            self._look()

    @property
    def _running(self) -> LogEncoder | None:
        """What encodes the log that is being written; None while nothing is logged."""
        return None if self._paused else self._encoder

    @property
    def _elapsed_us(self) -> int:
        """Simulated time since the boot that the log is of [us]."""
        return self._vehicle.time_us - self._boot_us

    @property
    def _next_us(self) -> int:
        """When to look next: simulated time since the start of the simulation [us]."""
        encoder = self._running
        return self._boot_us + (self._due_us if encoder is None else encoder.sampler.due_us)

    def _is_idle(self) -> bool:
        """Whether no log can begin before something happens."""
        return not (self._texts or (self._on and (self._is_awake() or self._disarmed in _ALWAYS)))

    def _is_awake(self) -> bool:
        """Whether the vehicle is armed, was until lately, or has lately refused to be."""
        words = self._words
        now, count = int(words[self._time_at]), int(words[self._count_at])
        if count != self._read:
            ring = self._vehicle.v.autopilot.events
            for k in range(max(self._read, count - EVENT_RING), count):
                if ring.code[k % EVENT_RING] == ARMING_REFUSED:
                    self._refused_us = int(ring.time_us[k % EVENT_RING])
            self._read = count
        return bool(words[self._armed_at]) or now - max(self._disarmed_us, self._refused_us) < PERSIST_US

    def _core_samples(self, encoder: LogEncoder) -> bool:
        """Whether the core can take samples until something happens: there is nothing else to be logged before."""
        armed = self._words[self._armed_at]
        if self._vehicle.before_boot_us != self._boot_us or not (self._on and (armed or self._disarmed in _ALWAYS)):
            return False
        return self._words[self._count_at] == self._count and self._vehicle.mission is encoder.mission

    def _find_due(self) -> None:
        encoder = self._running
        if encoder is None:
            self._due_us = (self._elapsed_us // POLL_US + 1) * POLL_US
        else:
            encoder.sampler.due_us = next_row_us(encoder.sampler, self._now_us)

    def _look(self) -> None:
        """Take a sample, or start a log when it is due."""
        self._follow()
        armed = self._words[self._armed_at]
        now = self._words[self._time_at]
        if armed:
            self._disarmed_us = now
        wanted = self._on and (self._disarmed in _ALWAYS or self._is_awake())
        if self._encoder is None or self._paused:
            if wanted:
                self._begin(now)
            else:
                self._texts.clear()
        elif not wanted:
            self._paused, self._since_us = True, now
            self._flush()
            if self._rotates_next:
                self._rotate()
        encoder = self._encoder
        if encoder is not None and not self._paused:
            if self._words[self._count_at] != self._count:
                self._count = self._words[self._count_at]
                encoder.read_events()
            if self._vehicle.mission is not encoder.mission:
                encoder.mission_changed(now)
            encoder.row()
            if encoder.pending:
                self._flush()
        if armed and self._file is not None:
            self._file.flown = True
        self._find_due()

    def _rotate(self) -> None:
        """End the log: another one begins with the next arming."""
        self._end()
        self._encoder = self._file = None
        self._rotates_next = False

    def _follow(self) -> None:
        """End the log at a reboot, or at an arming for which another one is wanted."""
        if self._vehicle.before_boot_us != self._boot_us:
            self._end()
            self._boot()
            return
        if not self._words[self._armed_at]:
            self._rotates_next = self._rotates and self._file is not None and self._file.flown
            return
        if self._rotates_next:
            self._rotate()
        if self._file is not None:
            self._file.flown = True

    def _begin(self, now: int) -> None:
        """Start a log or continue one, from the events since arming (or since boot, where LOG_DISARMED says so)."""
        since = 0 if self._disarmed in _ALWAYS else self._refused_us
        if self._words[self._armed_at]:
            since = max(since, self._words[self._armed_us_at])
        since = max(since, self._since_us)
        if self._encoder is None:
            unix_us = self.epoch_us + self._boot_us
            bitmask = int(self._vehicle.v.autopilot.params.LOG.BITMASK)
            self._file = self._new_file(unix_us + now)
            self._encoder = LogEncoder(self._vehicle, unix_us, bitmask, self._version)
            self._encoder.begin(min(since, now))
        self._paused = False
        self._encoder.skip_events_before(since)
        self._count = -1
        waiting = [(time_us, partial(self._encoder.command, time_us, numbers)) for time_us, numbers in self._commands]
        waiting += [(time_us, partial(self._encoder.text, time_us, text)) for time_us, text in self._texts]
        for time_us, write in sorted(waiting, key=lambda each: each[0]):
            if time_us >= since:
                write()
        self._texts.clear()
        self._commands.clear()

    def _new_file(self, unix_us: int) -> LogFile:
        while True:
            self._started += 1
            k = self._started
            path = self.path if k == 1 else self.path.with_name(f"{self.path.stem}.{k}{self.path.suffix}")
            try:
                if path.exists():
                    continue
                path.parent.mkdir(parents=True, exist_ok=True)
                file = LogFile(path, unix_us)
            except OSError as error:
                self._on = False  # say it once
                raise LogError(f"log {str(path)!r} cannot be written: {error.strerror or error}") from None
            self._files.append(file)
            return file

    # ------------------------------------------------------------------ listening

    def said(self, severity: int, text: str) -> None:
        """Log a status text that the vehicle sent."""
        self._follow()
        now = self._now_us
        if self._encoder is None or self._paused:
            self._texts.append((now, text))
            if self._is_awake():
                self._due_us = min(self._due_us, now)  # the log begins with the next tick
            return
        self._catch_up()
        self._encoder.text(now, text)

    def parameter_set(self, name: str) -> None:
        """A parameter was set."""
        self._follow()
        if self._encoder is not None and not self._paused:
            self._catch_up()
            self._encoder.parameter(self._now_us, name)
        if name.startswith("LOG_"):
            before = self._disarmed
            self._settings()
            if self._disarmed in _ALWAYS and before not in _ALWAYS:
                self._since_us = self._now_us  # not what has happened since boot
            self._find_due()

    def reached(self, seq: int) -> None:
        """A mission item was reached: not logged, CMD and the status text say it."""

    def commanded(self, fields: Any, frame: int, is_location: bool, sender: tuple[int, int], result: int) -> None:
        """Log a command that was answered."""
        self._follow()
        numbers = board.command(fields, frame, is_location, sender, result)
        if self._encoder is None or self._paused:
            self._commands.append((self._now_us, numbers))
            return
        self._catch_up()
        self._encoder.command(self._now_us, numbers)

    def _catch_up(self) -> None:
        """Log the events of the autopilot before the texts about them."""
        if self._encoder is not None:
            self._count = self._words[self._count_at]
            self._encoder.read_events()

    # ------------------------------------------------------------------ handing out

    def write_out(self) -> None:
        """Write what is pending: others read the file while it grows."""
        self._flush()

    def entries(self) -> list[Entry]:
        """All logs, after writing what is pending."""
        self._flush()
        return [Entry(k + 1, file.time_utc, file.size) for k, file in enumerate(self._files)]

    def read(self, number: int, offset: int, count: int) -> bytes:
        """``count`` bytes of log ``number`` from ``offset`` on; fewer at its end, none when there is no such log."""
        if not (0 < number <= len(self._files)):
            return b""
        try:
            with self._files[number - 1].path.open("rb") as file:
                file.seek(offset)
                return file.read(count)
        except OSError:
            return b""

    def erase(self) -> None:
        """Empty the list of logs and start a new one if one was being written. The files stay on disk."""
        self._end()
        self._files.clear()
        self._since_us = self._now_us
        self._encoder = self._file = None
        self._find_due()

    def close(self) -> None:
        """Write everything and close the file; nothing is logged after that."""
        if not self._closed:
            self._closed = True
            self._end()
            self._encoder = None
            self._on = False

    def _flush(self) -> None:
        if self._encoder is not None and self._file is not None:
            self._file.append(self._encoder.take_bytes())

    def _end(self) -> None:
        """Close the log being written."""
        self._flush()
        file = self._file
        if file is None:
            return
        file.close()
        if self._disarmed == _KEEP_FLIGHTS and not file.flown and file in self._files:
            self._files.remove(file)
            with contextlib.suppress(OSError):
                file.path.unlink()


def attach(simulation: Any, path: Path, kind: type[DataFlash] | None = None) -> DataFlash:
    """Keep on-board logs (.bin) at ``path``, as LOG_BACKEND_TYPE and LOG_DISARMED say; clients can download them.

    A logger that is there already ends. ``kind``: another class of loggers, which knows what ``path`` is.
    """
    bridge = simulation.bridge
    before = bridge.logs
    if before is not None:
        before.close()
        bridge.listeners[:] = [each for each in bridge.listeners if each is not before]
    logger = (kind or DataFlash)(simulation, path, bridge.epoch_us, f"gym-sitl {__version__}")
    simulation.logger = logger
    bridge.listeners.append(logger)
    bridge.logs = logger
    if bridge.board.journal is not None:
        bridge.board.journal.logs()
    return logger
