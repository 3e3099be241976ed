# SPDX-License-Identifier: BSD-3-Clause
"""The clock page: one small shared file through which a simulator tells scripts what time it is.

The simulator writes straight pieces of a clock, "simulated time was `sim` at wall time `wall` and runs at
`rate` up to `ceiling`". Every process of the script reads it (``preload/line.h`` holds the same layout in
C)::

    warped(wall) = min(sim + rate * (wall - wall_0), ceiling)

The clock therefore *follows* the simulation: when the simulator cannot keep up, is paused, or has not
started, the script's clock stops with it, and no time-out of the script can run out early.

All times in the page are integer nanoseconds: simulated time since the vehicle's boot, wall time as
CLOCK_MONOTONIC.
"""

from __future__ import annotations

import contextlib
import mmap
import os
import struct
import tempfile
import time
from pathlib import Path

MAGIC = 0x3150524157495453
PAGE_BYTES = 4096
LINE_OFFSET = 64
PIDS_OFFSET = 192
PID_SLOTS = 256
FOREVER_NS = 2**63 - 1

WAITING, RUNNING, RELEASED = 0, 1, 2
CLOCK_PAGE = "SITL_WARP_PAGE"
"""Environment variable of a program that is on the clock of a page: the page's path."""

_PREFIX, _SUFFIX = "sitl-clock-", ".page"

_HEADER = struct.Struct("<QQqqq")
_LINE = struct.Struct("<QqqdqQQ")
_WORDS = struct.Struct("<7Q")
_PIDS = struct.Struct(f"<{PID_SLOTS}i")


class ClockPage:
    """The simulator's end of the clock page: creates the file, publishes the clock, and in the end releases
    it.

    Use as a context manager. On leaving, the clock is released (it goes on at 1x, so that no script is left
    waiting for a simulator that is gone) and the file is removed.
    """

    def __init__(self, epoch_ns: int | None = None, uptime_ns: int | None = None, folder: str | None = None) -> None:
        """Make a page whose clock stands at simulated time zero until the first :meth:`publish`.

        `epoch_ns`: what scripts read as the date (CLOCK_REALTIME, ns) at simulated time zero; the present
        by default. `uptime_ns`: what they read as CLOCK_MONOTONIC [ns] there; the machine's present by
        default. `folder`: where the file is made; shared memory where the system has it.
        """
        if folder is None:
            folder = "/dev/shm" if os.access("/dev/shm", os.W_OK) else tempfile.gettempdir()
        _remove_orphans(folder)
        file, self.path = tempfile.mkstemp(prefix=_PREFIX, suffix=_SUFFIX, dir=folder)
        try:
            os.ftruncate(file, PAGE_BYTES)
            self._map = mmap.mmap(file, PAGE_BYTES)
        finally:
            os.close(file)
        self._count = 0
        self._wall_ns = time.monotonic_ns()
        self._sim_ns = 0
        self._rate = 0.0
        self._ceiling_ns = 0
        self._write(WAITING)
        epoch_ns = time.time_ns() if epoch_ns is None else epoch_ns
        uptime_ns = self._wall_ns if uptime_ns is None else uptime_ns
        _HEADER.pack_into(self._map, 0, MAGIC, PAGE_BYTES, epoch_ns, uptime_ns, os.getpid())

    def publish(self, sim_us: int, rate: float, grant_us: int = 0) -> None:
        """Say how far the simulation has come; call after each slice of simulated time.

        `sim_us`: simulated time reached [us]. `rate`: simulated seconds per wall second the clock runs at
        from here; 0 pauses it. `grant_us`: how much further [us] the clock may run before the next call,
        usually the length of the next slice: the clock is smooth and never more than this ahead of the
        simulation. With 0 it moves in steps, at the calls.

        The clock never goes back: where it has already passed `sim_us` it waits for the simulation.
        """
        if rate < 0 or grant_us < 0:
            raise ValueError(f"clock page: rate {rate} and grant_us {grant_us} must be 0 or more; 0 stops the clock")
        wall_ns = time.monotonic_ns()
        start_ns = max(self._at(wall_ns), sim_us * 1000)
        self._ceiling_ns = max(start_ns, (sim_us + grant_us) * 1000)
        self._wall_ns, self._sim_ns, self._rate = wall_ns, start_ns, float(rate)
        self._write(RUNNING)

    def now_us(self) -> float:
        """Simulated time [us] as the scripts read it at this moment."""
        return self._at(time.monotonic_ns()) / 1000

    def clients(self) -> list[int]:
        """Process ids of the scripts' processes that have attached to this clock and not left it."""
        return [pid for pid in _PIDS.unpack_from(self._map, PIDS_OFFSET) if pid > 0]

    def forget(self, pid: int) -> None:
        """Take a process that has ended without saying so off the list of clients."""
        slots = _PIDS.unpack_from(self._map, PIDS_OFFSET)
        if pid in slots:
            struct.pack_into("<i", self._map, PIDS_OFFSET + 4 * slots.index(pid), 0)

    def release(self) -> None:
        """Let the clock go on at 1x without the simulator, for good: scripts that still wait come
        to their end.
        """
        wall_ns = time.monotonic_ns()
        self._sim_ns, self._wall_ns = self._at(wall_ns), wall_ns
        self._rate, self._ceiling_ns = 1.0, FOREVER_NS
        self._write(RELEASED)

    def close(self) -> None:
        """Release the clock and remove the file. Processes that have it open keep reading it."""
        if self._map.closed:
            return
        self.release()
        self._map.close()
        with contextlib.suppress(FileNotFoundError):  # somebody has tidied up
            os.unlink(self.path)

    def __enter__(self) -> ClockPage:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _at(self, wall_ns: int) -> int:
        ahead_ns = int((wall_ns - self._wall_ns) * self._rate)
        return min(self._sim_ns + max(ahead_ns, 0), max(self._ceiling_ns, self._sim_ns))

    def _write(self, state: int) -> None:
        self._count += 1
        line = _LINE.pack(self._count, self._wall_ns, self._sim_ns, self._rate, self._ceiling_ns, state, 0)
        # Readers do not lock. They retry until the last word is the exclusive-or of the others, so a page
        # read in the middle of this write is noticed on any processor, whatever order it makes its stores
        # visible in.
        check = MAGIC
        for word in _WORDS.unpack(line):
            check ^= word
        self._map[LINE_OFFSET : LINE_OFFSET + _LINE.size] = line[:-8] + check.to_bytes(8, "little")


class PageReader:
    """A read-only view of a clock page from an ordinary, unwarped Python process: what time do the
    scripts have?
    """

    def __init__(self, path: str) -> None:
        """Open the page at `path`; raises ValueError if the file is not one."""
        with open(path, "rb") as file:
            self._map = mmap.mmap(file.fileno(), PAGE_BYTES, access=mmap.ACCESS_READ)
        magic, size, self.epoch_ns, self.uptime_ns, self.writer = _HEADER.unpack_from(self._map, 0)
        if magic != MAGIC or size != PAGE_BYTES:
            raise ValueError(f"clock page {path}: starts with {magic:#x}, not {MAGIC:#x}; pass the path of a ClockPage")

    def line(self) -> tuple[int, int, int, float, int, int]:
        """The piece published last: (count, wall_ns, sim_ns, rate, ceiling_ns, state)."""
        while True:
            data = self._map[LINE_OFFSET : LINE_OFFSET + _LINE.size]
            check = MAGIC
            for word in _WORDS.unpack(data):
                check ^= word
            if check == 0:
                return _LINE.unpack(data)[:6]

    def now_us(self) -> float:
        """Simulated time [us] now."""
        _, wall_ns, sim_ns, rate, ceiling_ns, state = self.line()
        if state == WAITING:
            return sim_ns / 1000
        return min(sim_ns + max(time.monotonic_ns() - wall_ns, 0) * rate, max(ceiling_ns, sim_ns)) / 1000


def _remove_orphans(folder: str) -> None:
    """Remove the pages of simulators that were killed before they could."""
    for path in Path(folder).glob(f"{_PREFIX}*{_SUFFIX}"):
        with contextlib.suppress(ValueError, OSError):  # just being made, or another user's
            if not _is_alive(PageReader(str(path)).writer):
                path.unlink()


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True
