# SPDX-License-Identifier: BSD-3-Clause
"""Puts a logger on board of a vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ... import __version__
from .log import DataFlash


def attach(simulation: Any, path: Path) -> DataFlash:
    """Keep on-board logs (.bin) at ``path``, as LOG_BACKEND_TYPE and LOG_DISARMED say; clients can download them.

    A logger that is there already ends.
    """
    bridge = simulation.bridge
    before = bridge.logs
    if before is not None:
        before.close()
        simulation.observers[:] = [each for each in simulation.observers if each is not before]
        bridge.listeners[:] = [each for each in bridge.listeners if each is not before]
    logger = DataFlash(simulation, path, bridge.epoch_us, f"gym-sitl {__version__}")
    simulation.observers.append(logger)
    bridge.listeners.append(logger)
    bridge.logs = logger
    if bridge.board.journal is not None:
        bridge.board.journal.logs()
    return logger
