# SPDX-License-Identifier: BSD-3-Clause
"""The physics side of the border as a simulation sees it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any, ClassVar

import numpy as np

from ..core.constants import NEVER
from ..core.record_reader import RecordReader
from ..errors import OptionError, SitlError
from ..physics.carried import Carried
from ..physics.engines import BACKENDS, backends
from ..scenario import Scenario
from ..vehicle.kind import Kind
from ..vehicles import Airframe


class PhysicsLostError(SitlError, ConnectionError):
    """The physics behind a link does not answer: time stands. Advancing again tries again."""


@dataclass(frozen=True)
class SimulatedVehicle:
    """One vehicle, as its plant finds it."""

    kind: Kind
    airframe: Airframe
    fleet: np.ndarray[Any, Any]
    index: int
    v: Any
    """View of the record ``fleet[index]``, whose memory stays in place."""
    reader: RecordReader
    restarted: Callable[[], None]
    """To be called by a plant whose physics has begun anew by itself: the autopilot reboots before the next tick."""


class Plant(ABC):
    """What moves one vehicle, and what measures it.

    ``run`` lets physics and autopilot go on; the simulation never runs past ``due_us`` and then calls ``measure``. What
    ``runs_in_core`` measures there.
    """

    name: ClassVar[str] = ""
    runs_in_core = False
    """Whether physics and autopilot are one compiled piece, so that the core goes on by itself."""
    has_truth_in_record: ClassVar[bool] = True
    """Whether ``truth`` is what the record says (``sitl.physics.carried``)."""
    idle_parameters: tuple[str, ...] = ()
    """Beginnings of the names of SIM_ parameters that do nothing to this plant."""

    def __init__(self, vehicle: SimulatedVehicle) -> None:
        self.vehicle = vehicle
        self.due_us = NEVER
        """Time since boot at which ``measure`` has to be called [us]."""
        self.ranging = 0
        """Address of what the core needs to measure in a world (``sitl.physics.native.ranging``); 0: nothing."""

    @abstractmethod
    def power_on(self) -> None:
        """Physics to power-on, at time 0 (a link may join later); parameters are kept, first samples are taken.

        Raises:
            PhysicsLostError: nobody is there.
        """

    @abstractmethod
    def run(self, ticks: int) -> None:
        """Physics and autopilot, up to ``ticks`` ticks; back early, at the end of a tick, when something needs Python.

        Raises:
            PhysicsLostError: the physics has gone; the ticks before that have passed and count.
        """

    def measure(self) -> None:
        """Take the measurements that are due now, and set ``due_us``."""
        return

    @abstractmethod
    def truth(self) -> Carried:
        """Where the vehicle really is, as far as MAVLink can tell."""

    def parameter_changed(self, name: str) -> None:
        """A SIM_ parameter was set: the world follows it."""
        self.vehicle.kind.apply_sim_parameters(self.vehicle.v)

    @abstractmethod
    def reseed(self, seed: int) -> None:
        """Another seed for all sensor noise from now on."""

    @abstractmethod
    def snapshot(self) -> bytes:
        """What the record does not hold, for ``restore`` to go on bit for bit.

        Raises:
            EngineError: this plant cannot.
        """

    @abstractmethod
    def restore(self, state: bytes) -> None:
        """Go back to a snapshot; the record has been put back already."""

    def close(self) -> None:
        """Let go of what is open."""
        return


LINKS = {"hil": "sitl.plants.hil", "json": "sitl.plants.json"}
"""Scheme -> module whose ``make(vehicle, address)`` gives a plant at the other end of a link."""
FORMS = (*BACKENDS, "hil:tcp:HOST:PORT", "json:HOST:PORT")


def is_remote(physics: str) -> bool:
    """Whether the physics is at the other end of a link.

    Raises:
        OptionError: no physics of this name.
    """
    if physics in backends():
        return False
    scheme = physics.partition(":")[0] if isinstance(physics, str) else ""
    if scheme in LINKS and ":" in physics:
        return True
    raise OptionError(f"physics {physics!r} is not known; it is one of {', '.join(FORMS)}")


def remote(vehicle: SimulatedVehicle, scenario: Scenario) -> Plant:
    """A plant at the other end of a link.

    Args:
        vehicle: record, airframe and kind.
        scenario: its physics is "SCHEME:ADDRESS". Home, seed, world, start and a true estimate may belong to the
            physics side: the module of the link names those that do not (``OWN``), the others may not be given.

    Raises:
        OptionError: an option that the physics at the other end has to be told, or an address that cannot be read.
    """
    scheme, _, address = scenario.physics.partition(":")
    module = import_module(LINKS[scheme])
    estimator = scenario.estimator if scenario.estimator == "truth" else None
    given = {name: getattr(scenario, name) for name in ("home", "seed", "world", "start")} | {"estimator": estimator}
    own = {name: given[name] for name in getattr(module, "OWN", ())}
    for name, value in given.items():
        if value is not None and name not in own:
            where = scenario.physics
            raise OptionError(f"{name} = {value!r}: with physics {where} it belongs to the other end of the link")
    make: Callable[..., Plant] = module.make
    return make(vehicle, address, **own)
