# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles with an autopilot, each at the other end of MAVLink's bytes: what all ways to have them share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from sitl.client.connection import Connection
from sitl.core.geodesy import offset_ne
from sitl.physics.engines import BACKENDS, NATIVE
from sitl.simulation import Simulation
from sitl.vehicles import Airframe
from sitl.vehicles.figures.figure import Figure
from sitl.worlds import World

from ..mavlink import px4, setpoints
from ..mavlink.preparation import INTERVAL_US, prepare
from ..options import EnvOptionError
from .autopilot_kinds import PX4_KIND, Kind
from .robot import Floats, Pose

INPROCESS = "inprocess"
_AT_REST = (1500.0, 1500.0, 1500.0, 1500.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Ready:
    """A vehicle at a moment, and what its client has heard until then; can be pickled."""

    simulation: Any
    heard: Any
    origin: tuple[float, float, float]
    """NED in the world of the origin of the vehicle's local positions [m]."""
    began_us: int
    """Simulated time at which the episode began [us]."""
    setpoint: str
    """Kind that the vehicle's mode is for; "" before the first."""
    interval_us: int
    """Of telemetry."""


NOWHERE = Ready(None, None, (0.0, 0.0, 0.0), 0, "", INTERVAL_US)


@dataclass(frozen=True)
class Seat:
    """What vehicles are made of."""

    options: Mapping[str, Any]
    """Of the robot, by name."""
    airframe: Airframe
    kind: Kind
    world: World
    angles: Floats
    """Of the lidar's readings [rad]."""


class Vehicles(ABC):
    """As many vehicles as the options say, and the connections to them.

    Args:
        seat: what they are made of.

    Raises:
        EnvOptionError: options that cannot be taken.
    """

    simulates: ClassVar[bool] = True
    """Whether their physics is ours, with figures that may be changed."""
    has_snapshots: ClassVar[bool] = False
    shortest_step: ClassVar[float] = 0.005
    """A step of an environment is a whole number of these at least [s]: longer loops of an autopilot count more."""

    def __init__(self, seat: Seat) -> None:
        self.seat, self.options = seat, seat.options
        physics, count = self.options["physics"], self.options["count"]
        if physics not in BACKENDS or (physics != NATIVE and not self.simulates):
            raise EnvOptionError(f"physics {physics!r}: it is one of {', '.join(BACKENDS)}, of a vehicle in process")
        self.links: list[Connection | None] = [None] * count
        """To each of them, once it was needed."""
        self.changed: list[dict[str, float]] = [{} for _ in range(count)]
        """Figures of each that are not the airframe's, by name."""

    @property
    def surroundings(self) -> Mapping[str, Figure]:
        """Figures that may be changed besides the airframe's."""
        return {}

    @property
    @abstractmethod
    def where(self) -> str:
        """For people: which option has led to them."""

    @abstractmethod
    def begin(self, index: int, pose: Pose, seed: int) -> Ready:
        """Bring one to where an episode begins, its link open.

        Raises:
            EnvOptionError, LinkLostError, NotReadyError: that cannot be done.
        """

    @abstractmethod
    def time_us(self, index: int) -> int:
        """Simulated time of one, by a clock that goes on in an episode [us]."""

    def snapshot(self, index: int, now: Ready) -> Ready:
        """One as it is, with what is known of its episode."""
        raise EnvOptionError(f"{self.where}: only vehicles in process have snapshots")

    def restore(self, index: int, ready: Ready) -> None:
        """Put one back."""
        raise EnvOptionError(f"{self.where}: only vehicles in process have snapshots")

    def simulation(self, index: int) -> Simulation:
        """One itself, to look at what MAVLink does not tell."""
        raise EnvOptionError(f"{self.where}: only vehicles in process can be looked into")

    def photograph(self, index: int, width: int, height: int) -> Any:
        """A picture by the renderer of its physics; None when it has none."""
        return None

    def close(self) -> None:
        """Let go of all links."""
        for index, link in enumerate(self.links):
            if link is not None:
                link.close()
            self.links[index] = None

    # ------------------------------------------------------------------ for the ways to have them

    def prepare(self, link: Connection, pose: Pose) -> tuple[float, float, float]:
        """Get one ready that has just booted; returns NED of its local origin in the world."""
        kind, heard = self.seat.kind, link.inbox
        take_off = self.options["take_off"] if self.seat.airframe.kind == "copter" else 0.0

        def hold_sticks() -> None:
            link.endpoint.send_payload(*setpoints.override(_AT_REST, heard, ()))

        if kind is PX4_KIND:
            px4.prepare(link, take_off)
        else:
            prepare(link, kind.guided, take_off, hold_sticks)
        assert heard.origin is not None
        lat, lon = (round(1e7 * angle) for angle in self.options["home"][:2])
        north, east = offset_ne(lat, lon, *heard.origin[:2])
        return north, east, -pose[2]

    def begun(self, index: int, origin: tuple[float, float, float]) -> Ready:
        """An episode that begins now."""
        return Ready(None, None, origin, self.time_us(index), "", INTERVAL_US)
