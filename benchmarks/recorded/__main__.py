# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.recorded``: our flights beside the recorded ones, as Markdown tables."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from sitl import vehicles
from sitl.bridge.links.inprocess import InProcessLink
from sitl.client.endpoint import Inbox
from sitl.envs.mavlink.foreign import Foreign, launch
from sitl.errors import OptionError
from sitl.foreign.choice import ARDUPILOT, FORMS, Choice, choose
from sitl.foreign.process import Cutter
from sitl.physics.engines import NATIVE
from sitl.physics.native.power_on import Home
from sitl.plants.local import stand_alone
from sitl.scenario import ESTIMATORS
from sitl.simulation import Simulation, load_core
from sitl.vehicle.kinds import KINDS

from . import copter, rover
from .metrics import Metric, table
from .pilot import Pilot
from .recording import Recording, recorded

_PATIENCE_S = 30.0


class ForeignVehicle:
    """The part of the ``Simulation`` interface that ``Pilot`` uses.

    Args:
        choice: the autopilot.
        frame: airframe.
        home: where it stands.
        seed: seed of wind and turbulence.
        physics: name of the engine.

    Raises:
        OptionError, LinkLostError: it cannot be started, or does not answer.
    """

    def __init__(self, choice: Choice, frame: str, home: Home, seed: int = 0, physics: str = NATIVE) -> None:
        airframe = vehicles.load(frame)
        plant = stand_alone(airframe, home=home, physics=physics, seed=seed)
        self.kind = KINDS[airframe.kind]
        self.firmware = self.kind.firmware
        self.v = plant.vehicle.v
        """Only the physics in it is valid: the autopilot is the foreign one."""
        self.before_boot_us = 0
        self.connection: Foreign = launch(choice, plant, {}, Inbox(), _PATIENCE_S)
        self.connection.tap = self._tell
        self._links: list[InProcessLink] = []
        self._cutter = Cutter()

    @property
    def bridge(self) -> ForeignVehicle:
        """For ``bridge.add_link``."""
        return self

    def add_link(self, link: InProcessLink) -> None:
        """Add a client in this process."""
        self._links.append(link)

    @property
    def system(self) -> int:
        """MAVLink id of the vehicle."""
        return int(self.connection.inbox.system)

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""
        return self.connection.time_us

    def advance_to(self, time_us: int) -> None:
        """Pass the clients' messages to the autopilot, and advance to a time [us]."""
        for link in self._links:
            for peer in link.peers:
                data = peer.take()
                if data:
                    self.connection.endpoint.link.send(data)
        self.connection.run(max(time_us - self.time_us, 0))

    def _tell(self, data: bytes) -> None:
        for frame in self._cutter.feed(data):
            for link in self._links:
                for peer in link.peers:
                    peer.write(frame)
                    peer.flush()

    def close(self) -> None:
        """End the autopilot and the physics."""
        self.connection.close()


HOME = (-35.363262, 149.165237, 584.0, 0.0)
Script = Callable[[Simulation], Pilot]
Judge = Callable[[Recording, Recording], list[Metric]]

FLIGHTS: dict[str, tuple[str, list[tuple[str, Script, Judge]]]] = {
    "copter": (
        "ardupilot_quad",
        [
            ("copter_guided", copter.guided, copter.guided_metrics),
            ("copter_auto", copter.auto, copter.auto_metrics),
        ],
    ),
    "rover": ("ardupilot_rover", [("rover", rover.drive, rover.drive_metrics)]),
}
"""Airframe, and recording, script and metrics of each flight, by kind of vehicle."""


def metrics(kind: str, estimator: str = "ekf", seed: int = 0, autopilot: str = "native") -> list[Metric]:
    """Fly the recorded scripts of a kind of vehicle on ArduPilot's airframe and compare.

    With an ``autopilot`` other than ours (``sitl.foreign.choice``) that one flies our physics.
    """
    frame, flights = FLIGHTS[kind]
    choice = choose(autopilot, kind)
    if choice is not None:
        if estimator != "ekf":
            raise OptionError(f"estimator {estimator!r}: autopilot {choice.name} has estimators of its own")
        return foreign_metrics(choice, kind, seed)
    core = load_core(KINDS[kind])
    found: list[Metric] = []
    for name, script, judge in flights:
        simulation = Simulation(frame, home=HOME, seed=seed, estimator=estimator, core=core)
        found += judge(script(simulation).recording(), recorded(name))
    return found


def foreign_metrics(choice: Choice, kind: str, seed: int = 0) -> list[Metric]:
    """As ``metrics``, flown by a foreign autopilot that is started for each flight.

    Raises:
        OptionError: one that does not speak ArduPilot's commands.
    """

    if choice.kind != ARDUPILOT:
        raise OptionError(f"autopilot {choice.name}: the recorded scripts are for ArduPilot")
    frame, flights = FLIGHTS[kind]
    found: list[Metric] = []
    for name, script, judge in flights:
        vehicle: Any = ForeignVehicle(choice, frame, HOME, seed)
        try:
            found += judge(script(vehicle).recording(), recorded(name))
        finally:
            vehicle.close()
    return found


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.recorded", description=__doc__)
    parser.add_argument("kind", nargs="?", choices=sorted(FLIGHTS), help="of vehicle (default: all)")
    parser.add_argument("--estimator", choices=ESTIMATORS, default="ekf")
    parser.add_argument("--seed", type=int, default=0, help="of all sensor noise (default 0)")
    parser.add_argument("--autopilot", default="native", help=f"who flies: {FORMS}")
    options = parser.parse_args()
    for kind in [options.kind] if options.kind else sorted(FLIGHTS):
        print(table(metrics(kind, options.estimator, options.seed, options.autopilot)))


if __name__ == "__main__":
    main()
