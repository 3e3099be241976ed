# SPDX-License-Identifier: BSD-3-Clause
"""Which controls of PX4 ask for a step of the physics: its clock goes by HIL_SENSOR, from the first that it got on."""

from __future__ import annotations

from ...core.constants import TICK_US
from .controls import Controls

LATE = 400
"""After so many late answers the clock must be another one than we think."""


class ForeignClock:
    """Of one connection.

    What PX4 answers first may be a tick of some time ago, with others under way. Were each late answer a step, that
    many ticks would stay under way for good and its controls would always be so old: a step is only asked for once the
    present tick is answered. Until then time has to go on by itself.
    """

    def __init__(self) -> None:
        self._first_us = self._answered_us = -1
        self._late = 0
        self._is_in_step, self._is_lockstep = False, True

    @property
    def holds(self) -> bool:
        """Whether time waits for its controls."""
        return self._is_in_step and self._is_lockstep

    def sent(self, now_us: int) -> None:
        """It got the tick of this time [us]."""
        if self._first_us < 0:
            self._first_us = now_us

    def asks_for_step(self, given: Controls, now_us: int) -> bool:
        """Whether controls that come at this time [us] are the answer to the present tick, for the first time."""
        self._is_lockstep = given.is_lockstep
        is_new, self._answered_us = given.time_us > self._answered_us, max(given.time_us, self._answered_us)
        if not self._is_in_step:
            late_us = now_us - self._first_us - given.time_us
            if late_us > 0 and late_us % TICK_US == 0 and self._late < LATE:
                self._late += 1
                return False
            self._is_in_step = True
        return is_new and given.is_lockstep
