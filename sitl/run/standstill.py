# SPDX-License-Identifier: BSD-3-Clause
"""While simulated time stands: bytes of clients are read, and they find the vehicle by a HEARTBEAT about once a wall
second.

Simulations whose clock clients push (``sitl run --lockstep``): the wall clock decides nothing they see.
"""

from __future__ import annotations

from collections.abc import Callable

from ..bridge.services.statustext import StatusTextService
from ..core.mavlink import MavSeverity
from ..plants.plant import PhysicsLostError
from ..simulation import Simulation

_WAIT_S = 0.2
_WAITS_A_HEARTBEAT = 5


class Standstill:
    """Waits with a vehicle whose time may not go on."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._waits = 0

    def wait(self) -> None:
        """Wait a moment, or until a client says something."""
        bridge = self._simulation.bridge
        if self._waits % _WAITS_A_HEARTBEAT == 0:
            bridge.beat()
        self._waits = 1 if bridge.wait(_WAIT_S) else self._waits + 1


class Patience:
    """Goes on with a simulation whose physics may go and come back; says so once each time."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._standstill = Standstill(simulation)
        self._is_lost = False

    def advance_to(self, time_us: int) -> bool:
        """As ``Simulation.advance_to``; False when time stands because the physics has gone: call it again."""
        before = self._simulation.time_us
        try:
            self._simulation.advance_to(time_us)
        except PhysicsLostError as error:
            if not self._is_lost:
                self._say(MavSeverity.CRITICAL, str(error))
            self._is_lost = True
            self._standstill.wait()
            return False
        if self._is_lost and self._simulation.time_us > before:  # a call that only hears clients tells nothing
            self._say(MavSeverity.INFO, "Physics is back")
            self._is_lost = False
        return True

    def _say(self, severity: int, text: str) -> None:
        bridge = self._simulation.bridge
        bridge.get(StatusTextService).say(severity, text)
        bridge.dropped.append(text)  # for people, beside the clients that were lost
        bridge.flush()


SLICE_US = 500_000
"""Longest simulated time between two looks at what else happens [us]."""


def serve_lockstep(
    simulation: Simulation,
    *,
    until_us: int | None = None,
    running: Callable[[], bool] = lambda: True,
    on_slice: Callable[[], None] = lambda: None,
) -> None:
    """Go as far as clients grant, until simulated time ``until_us`` (None: without end) or ``running()`` is false.

    While time stands a HEARTBEAT goes out about once a wall second: a client that waits for one finds the vehicle.
    """
    grants = simulation.bridge.push_clock()
    standstill, patience = Standstill(simulation), Patience(simulation)
    while running() and (until_us is None or simulation.time_us < until_us):
        patience.advance_to(simulation.time_us)  # hears clients; a reboot that they ask for happens here, too
        goal = min(grants.until_us, simulation.time_us + SLICE_US)
        if goal > simulation.time_us:
            patience.advance_to(goal if until_us is None else min(goal, until_us))
        grants.answer(simulation.bridge)
        on_slice()
        if grants.until_us <= simulation.time_us:
            standstill.wait()
