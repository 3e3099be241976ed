# SPDX-License-Identifier: BSD-3-Clause
"""How fast simulated time may go against the wall clock: the only place of a run that reads one."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from ..core.constants import TICK_US
from ..errors import SitlError

if TYPE_CHECKING:
    from ..simulation import Simulation

MAX = "max"
_SLICE_WALL_S = 0.002
_LONGEST_US = 20000
_CATCH_UP_S = 0.05
_QUIET_SLICE_WALL_S = 0.001
_STOPPED_WALL_S = 0.02
"""While time is stopped, clients and requests are looked at so often [s]."""
LONGEST_STEP_US = 60_000_000
"""Of time that stands, by one request [us]."""
_QUIET = 10
"""A slice is no longer than this part of the simulated time since clients said something."""
LONGEST_QUIET_US = 10_000_000
"""No slice is longer, however long clients have been silent and however fast the machine is [us]."""
_LONGEST_WAIT_S = 1.0
"""A wait for sockets takes no longer; what is left is waited for after it [s]."""
SLOWEST, FASTEST = 0.001, 100000.0
"""Speed-ups that can be asked for."""


class SpeedupError(SitlError, ValueError):
    """A speed-up that is neither a number within the limits nor "max", or a step of time that is none."""


def parse_speedup(text: str) -> float | None:
    """The number of simulated seconds a wall second, or None for "max".

    Raises:
        SpeedupError: anything else.
    """
    if text == MAX:
        return None
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not SLOWEST <= value <= FASTEST:
        raise SpeedupError(f"speed-up {text!r} is not a number from {SLOWEST:g} to {FASTEST:g} or 'max'")
    return value


class Listener(Protocol):
    """What hears clients; a bridge does."""

    @property
    def received(self) -> int:
        """How often clients have said something, so far."""
        ...

    def wait(self, seconds: float) -> bool:
        """Sleep until a socket has something to read, at most ``seconds`` of wall time. True when one has."""
        ...

    def receive(self) -> None:
        """Read all links and act on every frame."""
        ...


class Pacing:
    """Holds simulated time at ``speedup`` times the wall clock, or lets it go (None).

    A slice, the simulated time between two looks at clients and clock, lasts up to 2 ms of wall time and 20 ms of
    simulated time. While no client says anything it grows, where simulated time is quick: to a tenth of the simulated
    time since somebody did, to 1 ms of wall time, and to 10 s. So a client that answers is read nearly as soon as
    ever, and one that only reads is sent much at once. Slices are whole ticks, from one tick to ``LONGEST_QUIET_US``.

    What counts is the simulated time that went by: the caller may advance by less than a slice.

    Time lost to a busy machine is caught up over the next slices, up to 50 ms of wall time; what is more is given up,
    so that a suspended laptop does not resume in a rush.

    Args:
        speedup: simulated seconds a wall second, from ``SLOWEST`` to ``FASTEST``; others count as the nearest of them.
        clock: gives the wall time [s].
    """

    def __init__(self, speedup: float | None, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._time_us: int | None = None
        """Simulated time after the last slice [us]; None: there was none."""
        self.set_speedup(speedup)

    def set_speedup(self, speedup: float | None) -> None:
        """Another speed-up from now on.

        Raises:
            SpeedupError: it is not a number above 0.
        """
        if speedup is not None and not speedup > 0.0:
            raise SpeedupError(f"speed-up {speedup!r} is not a number from {SLOWEST:g} to {FASTEST:g} or None")
        self.speedup = None if speedup is None else min(max(speedup, SLOWEST), FASTEST)
        self._due = self._clock()
        slice_us = _LONGEST_US if self.speedup is None else int(self.speedup * _SLICE_WALL_S * 1e6)
        self._least_us = whole_ticks(min(slice_us, _LONGEST_US))
        self.slice_us = self._least_us
        """Simulated time to advance between two looks at the wall clock [us]."""
        self._received, self._quiet_us, self._looked = 0, 0, self._clock()

    def after_slice(self, simulation: Simulation) -> None:
        """Wait until the next slice is due, and answer clients meanwhile: none of them can hurry the clock."""
        self.listen(simulation.bridge, simulation.time_us)

    def listen(self, listener: Listener, time_us: int) -> None:
        """The same for what hears clients; ``time_us``: simulated time now."""
        passed_us = self._passed(time_us)
        wait = self.wait_s(passed_us)
        self._fit_slice(listener.received, passed_us)
        while wait > 0.0:
            if listener.wait(min(wait, _LONGEST_WAIT_S)):
                listener.receive()
            wait = self._due - self._clock()

    def _passed(self, time_us: int) -> int:
        """Simulated time since the last slice [us]; no more than a slice and a tick: time may jump, at a snapshot."""
        before = time_us - self.slice_us if self._time_us is None else self._time_us
        self._time_us = time_us
        return min(max(time_us - before, 0), self.slice_us + TICK_US)

    def _fit_slice(self, received: int, passed_us: int) -> None:
        """Choose the next slice.

        Args:
            received: how often clients have said something so far.
            passed_us: simulated time since the last slice.
        """
        now = self._clock()
        took, self._looked = now - self._looked, now
        if received != self._received:
            self._received, self._quiet_us = received, 0
        else:
            self._quiet_us = min(self._quiet_us + passed_us, _QUIET * LONGEST_QUIET_US)
        if self.speedup is None:
            longest = min(passed_us * _QUIET_SLICE_WALL_S / max(took, 1e-6), 2.0 * self.slice_us)
        else:
            longest = self.speedup * _QUIET_SLICE_WALL_S * 1e6
        self.slice_us = max(whole_ticks(min(int(longest), self._quiet_us // _QUIET)), self._least_us)

    def wait_s(self, passed_us: int) -> float:
        """Account for simulated time that went by [us]; returns the wall time [s] to wait before more, 0 for none."""
        if self.speedup is None:
            return 0.0
        now = self._clock()
        self._due = max(self._due + passed_us * 1e-6 / self.speedup, now - _CATCH_UP_S)
        return max(0.0, self._due - now)


def whole_ticks(us: int) -> int:
    """Whole ticks in a time [us], one at least: vehicles advance by whole ticks."""
    return max(us // TICK_US, 1) * TICK_US


class StoppablePacing(Pacing):
    """Pacing that a user can stop, and let go on by steps. Clients are heard while time stands."""

    is_stopped = False
    """Whether time stands, but for steps."""
    _step_us = 0
    """Of the next slice, while time stands."""

    def stop(self) -> None:
        """Let time stand from now on."""
        self.is_stopped, self.slice_us = True, 0

    def go_on(self) -> None:
        """Let time go on, as fast as before."""
        self.is_stopped = False
        self.set_speedup(self.speedup)

    def step(self, us: int) -> None:
        """Let a simulated time [us] go by, then stand.

        Raises:
            SpeedupError: it is nothing, or longer than LONGEST_STEP_US.
        """
        if not 0 < us <= LONGEST_STEP_US:
            raise SpeedupError(f"step {us} us is outside 1 .. {LONGEST_STEP_US}")
        self.stop()
        self._step_us = us

    def set_speedup(self, speedup: float | None) -> None:
        super().set_speedup(speedup)
        if self.is_stopped:
            self.slice_us = 0

    def listen(self, listener: Listener, time_us: int) -> None:
        if not self.is_stopped:
            super().listen(listener, time_us)
            return
        self._time_us = time_us
        self.slice_us, self._step_us = self._step_us, 0
        if self.slice_us == 0 and listener.wait(_STOPPED_WALL_S):
            listener.receive()
