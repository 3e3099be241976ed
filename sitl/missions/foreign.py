# SPDX-License-Identifier: BSD-3-Clause
"""A foreign autopilot on our physics with the interface of a simulation, so that scripts can fly it."""

from __future__ import annotations

from sitl import vehicles
from sitl.bridge.links.inprocess import InProcessLink
from sitl.envs.mavlink.foreign import Foreign, launch
from sitl.foreign.choice import Choice
from sitl.foreign.process import Cutter
from sitl.physics.engines import NATIVE
from sitl.physics.native.power_on import Home
from sitl.plants.local import stand_alone
from sitl.vehicle.kinds import KINDS

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
        self.v = plant.craft.v
        """Only the physics in it is valid: the autopilot is the foreign one."""
        self.before_boot_us = 0
        self.connection: Foreign = launch(choice, plant, {}, 0, _PATIENCE_S)
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
