# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles that have booted: each set-up boots once a process, later tests begin from its snapshot."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from sitl.physics.engines import NATIVE
from sitl.vehicle.kinds import KINDS

from .moments import RecordedMoment
from .setup import Setup
from .vehicle import Copter, Rover, Vehicle

__tracebackhide__ = True

KEPT = 32
"""As many beginnings are kept; each is a few dozen kB."""
EXACT = (NATIVE, "pybullet")
"""Physics whose snapshots leave no trace; with others every test boots."""
Prepare = Callable[[Any], object]
"""What a vehicle does before its test begins."""
Beginning = tuple[Setup, Prepare | None]
_kept: OrderedDict[Beginning, RecordedMoment] = OrderedDict()


def new(setup: Setup, name: str) -> Vehicle:
    """A vehicle at power-on."""
    return (Copter if KINDS[setup.kind].flies else Rover)(setup.build, name)


def begin(vehicle: Vehicle, setup: Setup, after: Prepare | None = None) -> None:
    """Bring a vehicle from power-on to where its test begins: ready to arm, and ``after`` has been done.

    The first one of a set-up boots; what comes later goes on from there, the same to the bit.
    """
    beginning = (setup, after)
    is_kept = setup.physics in EXACT and _is_hashable(beginning)
    if is_kept and beginning in _kept:
        _kept.move_to_end(beginning)
        vehicle.restore(_kept[beginning])
        return
    if after is None:
        vehicle.wait_ready()
    else:
        begin(vehicle, setup)
        after(vehicle)
    if is_kept:
        _kept[beginning] = vehicle.snapshot()
        if len(_kept) > KEPT:
            _kept.popitem(last=False)


def _is_hashable(beginning: Beginning) -> bool:
    """An airframe or world of the test's own may not be."""
    try:
        hash(beginning)
    except TypeError:
        return False
    return True
