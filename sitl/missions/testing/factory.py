# SPDX-License-Identifier: BSD-3-Clause
"""Makes the vehicles of one test, and closes them when it ends."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal, overload

from . import boots
from .golden import GoldenStore
from .logs import keep
from .setup import Defaults, setup
from .vehicle import Copter, Rover, Vehicle

__tracebackhide__ = True


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
        after: boots.Prepare | None = None,
        name: str | None = None,
        **options: Any,
    ) -> Vehicle:
        """A vehicle of this test's own.

        Args:
            kind: "copter" or "rover".
            ready: wait until it is ready to arm; else it is at power-on.
            after: a function of the vehicle, flown before the test begins: once a process; all tests that name the same
                function begin from its end. It uses nothing but the vehicle.
            name: for messages and logs.
            options: frame, home, seed, estimator, params, world, start, physics, wind, mission.
        """
        wanted = setup(self.defaults, kind, **options)
        name = name or wanted.kind
        taken = sum(vehicle.name == name or vehicle.name.startswith(f"{name}-") for vehicle in self.vehicles)
        name = f"{name}-{taken + 1}" if taken else name
        vehicle = boots.new(wanted, name)
        vehicle.golden, vehicle.folders = self.golden, self.defaults.folders
        self.vehicles.append(vehicle)
        if ready or after is not None:
            boots.begin(vehicle, wanted, after)
        return vehicle

    def keep_logs(self, error: BaseException | None) -> list[tuple[str, list[str]]]:
        """Logs of all vehicles: (vehicle, what there is to say)."""
        return [(vehicle.name, keep(vehicle, self.logs, vehicle.name, error)) for vehicle in self.vehicles]

    def close(self) -> None:
        """Close all vehicles."""
        for vehicle in self.vehicles:
            vehicle.simulation.close()
