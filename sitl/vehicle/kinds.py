# SPDX-License-Identifier: BSD-3-Clause
"""The kinds of vehicles: which record, physics, firmware and compiled core belong together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..autopilot.copter.firmware import FIRMWARE as COPTER_FIRMWARE
from ..autopilot.firmware import Firmware
from ..autopilot.rover.firmware import FIRMWARE as ROVER_FIRMWARE
from ..physics.native.copter import pieces as copter_pieces
from ..physics.native.copter.init import init as init_copter
from ..physics.native.copter.step import step as step_copter
from ..physics.native.rover import pieces as rover_pieces
from ..physics.native.rover.init import init as init_rover
from ..physics.native.rover.step import step as step_rover
from . import advance, sim_parameters
from .record import Copter, Rover, Vehicle


@dataclass(frozen=True)
class Kind:
    """One kind of vehicle."""

    firmware: Firmware
    record: type[Vehicle]
    """Its record."""
    advance: Callable[[Any, int, int], None]
    """Entry of its core (``sitl.vehicle.advance``): native physics and autopilot."""
    fly: Callable[[Any, int], None]
    """Unit of one tick of its autopilot alone."""
    step: Callable[[Any, int], None]
    """Unit of one tick of its native physics alone."""
    pieces: Any
    """Module of the units ``begin``, ``load`` and ``sense``: a tick without the motion (``sitl.physics.engine``)."""
    init_physics: Callable[..., None]
    """``init(v, airframe, home, seed)``: power-on of its physics."""
    apply_sim_parameters: Callable[[Any], None]
    """Brings the physics of a vehicle in line with its SIM_ parameters."""

    @property
    def name(self) -> str:
        """ "copter" or "rover"."""
        return self.firmware.name

    @property
    def record_path(self) -> str:
        """Where its record is: the core is compiled for it."""
        return f"{self.record.__module__}.{self.record.__qualname__}"


COPTER = Kind(
    COPTER_FIRMWARE,
    Copter,
    advance.advance_copter,
    advance.fly_copter,
    step_copter,
    copter_pieces,
    init_copter,
    sim_parameters.apply_to_copter,
)
ROVER = Kind(
    ROVER_FIRMWARE,
    Rover,
    advance.advance_rover,
    advance.fly_rover,
    step_rover,
    rover_pieces,
    init_rover,
    sim_parameters.apply_to_all,
)
KINDS = {kind.name: kind for kind in (COPTER, ROVER)}
