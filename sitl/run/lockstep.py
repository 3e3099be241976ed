# SPDX-License-Identifier: BSD-3-Clause
"""Runs a simulation whose clock clients push (``sitl run --lockstep``): the wall clock decides nothing they see."""

from __future__ import annotations

from collections.abc import Callable

from ..simulation import Simulation
from .standstill import Patience, Standstill

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
