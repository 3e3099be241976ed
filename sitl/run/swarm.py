# SPDX-License-Identifier: BSD-3-Clause
"""Runs a swarm with clients on sockets, against the wall clock or as far as clients grant time."""

from __future__ import annotations

from collections.abc import Callable

from ..swarm import Swarm
from .pacing import Pacing
from .runner import Pace
from .standstill import SLICE_US

_WAIT_S = 0.2
_WAITS_A_HEARTBEAT = 5


class SwarmPacing:
    """As ``Pacing``, for a swarm.

    Args:
        pacing: how fast; or the speed-up itself, None: as fast as it can.
    """

    def __init__(self, pacing: Pacing | float | None) -> None:
        self._pacing = pacing if isinstance(pacing, Pacing) else Pacing(pacing)
        self.slice_us = self._pacing.slice_us

    def after_slice(self, simulation: Swarm) -> None:
        """Wait until the next slice is due, and answer clients meanwhile."""
        self._pacing.listen(simulation, simulation.time_us)
        self.slice_us = self._pacing.slice_us


def serve_swarm(
    swarm: Swarm,
    pace: Pace[Swarm],
    *,
    until_us: int | None = None,
    running: Callable[[], bool] = lambda: True,
    on_slice: Callable[[], None] = lambda: None,
) -> None:
    """Advance until simulated time ``until_us`` (None: without end) or until ``running()`` is false."""
    while running() and (until_us is None or swarm.time_us < until_us):
        target = swarm.time_us + pace.slice_us
        swarm.advance_to(target if until_us is None else min(target, until_us))
        on_slice()
        pace.after_slice(swarm)


def serve_swarm_lockstep(
    swarm: Swarm,
    *,
    until_us: int | None = None,
    running: Callable[[], bool] = lambda: True,
    on_slice: Callable[[], None] = lambda: None,
) -> None:
    """Go as far as clients grant, until simulated time ``until_us`` (None: without end) or ``running()`` is false.

    A client grants time to one vehicle or to several; all go as far as each of these may.
    """
    grants = [vehicle.bridge.push_clock() for vehicle in swarm.vehicles]
    waits = 0

    def granted() -> int:
        return min((grant.until_us for grant in grants if grant.until_us > 0), default=0)

    while running() and (until_us is None or swarm.time_us < until_us):
        swarm.advance_to(swarm.time_us)  # hears clients; a reboot that they ask for happens here, too
        goal = min(granted(), swarm.time_us + SLICE_US)
        if goal > swarm.time_us:
            swarm.advance_to(goal if until_us is None else min(goal, until_us))
        for vehicle, grant in zip(swarm.vehicles, grants, strict=True):
            grant.answer(vehicle.bridge)
        swarm.router.flush()
        on_slice()
        if granted() <= swarm.time_us:
            if waits % _WAITS_A_HEARTBEAT == 0:
                for vehicle in swarm.vehicles:
                    vehicle.bridge.beat()
                swarm.router.flush()
            waits = 1 if swarm.wait(_WAIT_S) else waits + 1
