# SPDX-License-Identifier: BSD-3-Clause
"""Makes the vehicles of one test, and closes them when it ends.

Each set-up boots once a process; later tests begin from its snapshot.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, overload

from sitl.bridge.links import LinkFaults
from sitl.foreign.choice import NATIVE as OURS
from sitl.physics.engines import NATIVE
from sitl.vehicle.kinds import KINDS

from .golden import GoldenStore
from .logs import keep
from .moments import RecordedMoment
from .setup import Defaults, Setup, setup
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
    is_kept = setup.physics in EXACT and setup.autopilot == OURS and _is_hashable(beginning)
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


class VehicleFactory:
    """``vehicle_factory("rover", world="maze")``: it is ready to arm; ``setup.setup`` says what is taken."""

    def __init__(self, defaults: Defaults, golden: GoldenStore, logs: Path) -> None:
        self.defaults, self.golden, self.logs = defaults, golden, logs
        self.vehicles: list[Vehicle] = []

    @overload
    def __call__(self, kind: Literal["copter"], **options: Any) -> Copter: ...
    @overload
    def __call__(self, kind: Literal["rover"], **options: Any) -> Rover: ...
    @overload
    def __call__(self, kind: str | None = None, **options: Any) -> Vehicle: ...
    def __call__(
        self,
        kind: str | None = None,
        *,
        ready: bool = True,
        after: Prepare | None = None,
        name: str | None = None,
        link_faults: LinkFaults | None = None,
        **options: Any,
    ) -> Vehicle:
        """A vehicle of this test's own.

        Args:
            kind: "copter" or "rover".
            ready: wait until it is ready to arm; else it is at power-on.
            after: a function of the vehicle, flown before the test begins: once a process; all tests that name the same
                function begin from its end. It uses nothing but the vehicle.
            name: for messages and logs.
            link_faults: of its link to the test, from when it is ready on.
            options: frame, home, seed, estimator, params, world, start, physics, autopilot, wind, mission.
        """
        wanted = setup(self.defaults, kind, **options)
        name = name or wanted.kind
        taken = sum(vehicle.name == name or vehicle.name.startswith(f"{name}-") for vehicle in self.vehicles)
        name = f"{name}-{taken + 1}" if taken else name
        vehicle = new(wanted, name)
        vehicle.golden, vehicle.folders = self.golden, self.defaults.folders
        self.vehicles.append(vehicle)
        if ready or after is not None:
            begin(vehicle, wanted, after)
        if link_faults is not None:
            vehicle.set_link_faults(link_faults)
        return vehicle

    def judge_faults(self) -> list[tuple[str, list[str]]]:
        """What became of the faults of all vehicles: (vehicle, a line for each)."""
        return [(vehicle.name, vehicle.judge_faults()) for vehicle in self.vehicles if vehicle.failures]

    def idle_faults(self) -> list[str]:
        """Why faults that must act have not, by vehicle."""
        return [f"{vehicle.name}: {text}" for vehicle in self.vehicles for text in vehicle.idle_faults]

    def keep_logs(self, error: BaseException | None) -> list[tuple[str, list[str]]]:
        """Logs of all vehicles: (vehicle, what there is to say)."""
        return [(vehicle.name, keep(vehicle, self.logs, vehicle.name, error)) for vehicle in self.vehicles]

    def close(self) -> None:
        """Close all vehicles."""
        for vehicle in self.vehicles:
            vehicle.close()
