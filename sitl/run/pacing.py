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
_SHORTEST_US, _LONGEST_US = TICK_US, 20000
_CATCH_UP_S = 0.05
_QUIET_SLICE_WALL_S = 0.001
_STOPPED_WALL_S = 0.02
"""While time is stopped, clients and requests are looked at so often [s]."""
LONGEST_STEP_US = 60_000_000
"""Of time that stands, by one request [us]."""
_QUIET = 10
"""A slice is no longer than this part of the simulated time since clients said something."""


class SpeedupError(SitlError, ValueError):
    """A speed-up that is neither a positive number nor "max", or a step of time that is none."""


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
    if not 0.0 < value <= 100000.0:
        raise SpeedupError(f"speed-up {text!r} is not a number above 0 (up to 100000) or 'max'")
    return value


class Listener(Protocol):
    """What hears clients; a bridge does."""

    @property
    def heard(self) -> int:
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
    time since somebody did, and to 1 ms of wall time. So a client that answers is heard nearly as soon as ever, and one
    that only reads is sent much at once.

    Time lost to a busy machine is caught up over the next slices, up to 50 ms of wall time; what is more is given up,
    so that a suspended laptop does not resume in a rush.
    """

    def __init__(self, speedup: float | None, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.set_speedup(speedup)

    def set_speedup(self, speedup: float | None) -> None:
        """Another speed-up from now on."""
        self.speedup = speedup
        self._due = self._clock()
        slice_us = _LONGEST_US if speedup is None else int(speedup * _SLICE_WALL_S * 1e6)
        self._least_us = min(max(slice_us, _SHORTEST_US), _LONGEST_US)
        self.slice_us = self._least_us
        """Simulated time to advance between two looks at the wall clock [us]."""
        self._heard, self._quiet_us, self._looked = 0, 0, self._clock()

    def after_slice(self, simulation: Simulation) -> None:
        """Wait until the next slice is due, and answer clients meanwhile: none of them can hurry the clock."""
        self.listen(simulation.bridge)

    def listen(self, listener: Listener) -> None:
        """The same for what hears clients."""
        wait = self.wait_s()
        self._fit_slice(listener.heard)
        while wait > 0.0:
            if listener.wait(wait):
                listener.receive()
            wait = self._due - self._clock()

    def _fit_slice(self, heard: int) -> None:
        """Choose the next slice.

        Args:
            heard: how often clients have said something so far.
        """
        now = self._clock()
        took, self._looked = now - self._looked, now
        if heard != self._heard:
            self._heard, self._quiet_us = heard, 0
        else:
            self._quiet_us += self.slice_us
        if self.speedup is None:
            longest = int(self.slice_us * min(_QUIET_SLICE_WALL_S / max(took, 1e-6), 2.0))
        else:
            longest = int(self.speedup * _QUIET_SLICE_WALL_S * 1e6)
        self.slice_us = max(min(longest, self._quiet_us // _QUIET), self._least_us)

    def wait_s(self) -> float:
        """Account for one slice; returns the wall time [s] to wait before the next, 0 for none."""
        if self.speedup is None:
            return 0.0
        now = self._clock()
        self._due = max(self._due + self.slice_us * 1e-6 / self.speedup, now - _CATCH_UP_S)
        return max(0.0, self._due - now)


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

    def listen(self, listener: Listener) -> None:
        if not self.is_stopped:
            super().listen(listener)
            return
        self.slice_us, self._step_us = self._step_us, 0
        if self.slice_us == 0 and listener.wait(_STOPPED_WALL_S):
            listener.receive()
