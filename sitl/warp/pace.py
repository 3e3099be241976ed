# SPDX-License-Identifier: BSD-3-Clause
"""Paces a simulator in slices and publishes the clock after each."""

from __future__ import annotations

import ctypes
import math
import sys
import time

from sitl.warp.build import preload_library
from sitl.warp.page import ClockPage

# How late [s of wall time] the simulator may be and still catch up by running faster than asked for a
# moment. Small: a script must never see more than a blink of simulated time go by while it had no chance to
# run.
CATCH_UP_S = 0.002

# "max": the fastest the clock runs while the script waits, and while it works.
MAX_SPEEDUP = 200.0
MAX_BUSY_SPEEDUP = 1.0

# Wall time [s] between two looks at a script that is at work.
LOOK_S = 0.00003


class Pacer:
    """Keeps simulated time at `speedup` times wall time, and behind what the scripts can follow.

    The caller advances its simulation by :attr:`slice_us`, then calls :meth:`pace`. Time lost (a slow
    slice, a busy machine) is not made up beyond 2 ms: the simulation slows down, and the scripts' clock
    with it.

    With `busy_speedup`, simulated time goes no faster than that while any thread of a script is at work,
    and at `speedup` while all of them wait. At 1 a script's own computing takes as much simulated time as
    it would at 1x, so that it cannot notice the difference, and only its waits are short.
    """

    def __init__(
        self,
        page: ClockPage,
        speedup: float | str,
        slice_us: int | None = None,
        busy_speedup: float | None = None,
    ) -> None:
        """`speedup`: simulated seconds per wall second, above 0, or "max": 200 while scripts wait, 1 while
        they work.

        `slice_us`: simulated time per slice [us]; by default 1 to 10 ms, as fits half a millisecond of wall
        time. `busy_speedup`: see above; None for the same as `speedup`. Needs the compiled library: raises
        CannotBuild.
        """
        if speedup == "max":
            speedup = MAX_SPEEDUP
            busy_speedup = MAX_BUSY_SPEEDUP if busy_speedup is None else busy_speedup
        if isinstance(speedup, str) or not 0 < speedup < math.inf:
            raise ValueError(f'speedup {speedup!r} must be a number above 0, or "max"; 1 is real time')
        if busy_speedup is not None and not 0 < busy_speedup < math.inf:
            raise ValueError(f"busy_speedup {busy_speedup} must be above 0; 1 is real time")
        self.page = page
        self.speedup = float(speedup)
        self.busy_speedup = min(busy_speedup or self.speedup, self.speedup)
        self.slice_us = int(slice_us or min(max(self.speedup * 500, 1000), 10000))
        self._started = self._due = time.monotonic()
        self._library = None
        if self.busy_speedup < self.speedup:
            self._library = ctypes.CDLL(str(preload_library()))
        if sys.platform == "linux":
            # Linux may end a sleep 50 us late to save power, a quarter of a slice at 50x; ask for no such
            # favour.
            ctypes.CDLL(None).prctl(29, 1, 0, 0, 0)

    def publish(self, sim_us: int) -> None:
        """Publish simulated time `sim_us` [us] and grant the scripts one more slice."""
        now = time.monotonic()
        self._started = now
        self._due = max(self._due, now - CATCH_UP_S) + self.slice_us / 1e6 / self.speedup
        self.page.publish(sim_us, self.speedup, self.slice_us)

    def remaining(self) -> float:
        """Wall time [s] until the next slice is due; 0 when it is. For simulators that wait on
        sockets meanwhile.
        """
        now = time.monotonic()
        if now < self._due:
            return self._due - now
        if self._library and now < self._started + self.slice_us / 1e6 / self.busy_speedup and self.busy():
            self._due = now
            return LOOK_S
        return 0.0

    def pace(self, sim_us: int) -> None:
        """Publish, then sleep until the next slice is due."""
        self.publish(sim_us)
        while remaining := self.remaining():
            time.sleep(remaining)

    def busy(self) -> bool:
        """Whether any thread of a script on this clock is at work, not waiting. Only with `busy_speedup`."""
        if self._library is None:
            return False
        for pid in self.page.clients():
            state = self._library.sitl_clock_busy(pid)
            if state > 0:
                return True
            if state < 0:
                self.page.forget(pid)
        return False
