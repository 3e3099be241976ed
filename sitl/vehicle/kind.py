# SPDX-License-Identifier: BSD-3-Clause
"""A kind of vehicle: everything in which two kinds differ, or where it is found, in one object."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, TypeVar

from ..autopilot.firmware import Firmware
from ..errors import OptionError
from ..vehicles import Airframe
from .record import Vehicle

T = TypeVar("T")


class MissingPartError(OptionError):
    """A kind of vehicle lacks what a package needs of it; the message says what would have to be given."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Kind:
    """One kind of vehicle.

    What other packages need of it (its face on MAVLink, its messages in logs, its robot in environments ...) is in
    ``parts``: objects, or "module:NAME" of objects that are loaded when they are first asked for.
    """

    firmware: Firmware
    """Its autopilot. The kind has the firmware's name."""
    airframe: type[Airframe]
    """Class of its airframes; its ``kind`` is the kind's name."""
    record: type[Vehicle]
    """Its record."""
    advance: Callable[[Any, int, int], None]
    """Unit ``advance(fleet, index, ticks)``: native physics and autopilot (``sitl.vehicle.advance``)."""
    fly: Callable[[Any, int], None]
    """Unit of one tick of its autopilot alone."""
    step: Callable[[Any, int], None]
    """Unit of one tick of its native physics alone."""
    move: Callable[[Any, int, int, int, int], None] | None = None
    """Unit ``move(fleet, index, count, orders, ranging)``: puts vehicles elsewhere (``sitl.vehicle.move``); None: they
    cannot be."""
    meet: Callable[[Any, int, int, int], None] | None = None
    """Unit ``meet(fleet, index, mover, shows)``: a vehicle shows itself to those that share its world, or takes over
    what came of meeting them (``sitl.vehicle.traffic``); None: it cannot share one."""
    pieces: Any
    """Module of the units ``begin``, ``load`` and ``sense``: a tick without the motion (``sitl.physics.engine``); None:
    only native physics simulates it."""
    init_physics: Callable[..., None]
    """``init(v, airframe, home, seed)``: power-on of its physics."""
    apply_sim_parameters: Callable[[Any], None]
    """Brings the physics of a vehicle in line with its SIM_ parameters."""

    default_frame: str
    """Airframe that is taken when none is named."""
    mav_type: int
    """MAV_TYPE of its HEARTBEAT."""
    other_mav_types: tuple[int, ...] = ()
    """MAV_TYPEs of vehicles that the same firmware controls: their missions and logs are of this kind, too."""
    outputs: Callable[[Any], Sequence[int] | None] = lambda airframe: None
    """Which outputs of an airframe drive a motor or a servo that can fail, from 1; None: nobody knows."""
    idle_parameters: Callable[[Any], tuple[str, ...]] = lambda airframe: ()
    """Beginnings of the SIM_ parameters that do nothing to an airframe."""
    flies: bool
    """It takes off, and lands at the end; else it stays on the ground."""
    has_reversible_outputs: bool
    """Its actuator controls are -1 .. 1 (servos, motors of wheels), not 0 .. 1 (rotors)."""
    motor_output: Callable[[Any], float]
    """Mean control of the motors of a vehicle ``v``, of the full range."""
    engines: Mapping[str, str] = field(default_factory=dict)
    """Physics engine -> "module:FUNCTION" that makes it for a vehicle (``sitl.physics.engines.find``)."""
    demo_script: str | None = None
    """Example that ``sitl demo`` runs."""
    programs: Mapping[str, str] = field(default_factory=dict)
    """Foreign autopilot -> usual name of its program for this kind."""
    ardupilot_parameters: Mapping[str, float] = field(default_factory=dict)
    """What ArduPilot's own firmware has to be told besides the airframe's parameters."""
    ardupilot_models: Mapping[str, str] = field(default_factory=dict)
    """ArduPilot SITL's names of frames (``--model``) -> our airframes; the first is taken when none is given."""
    flight_parameters: tuple[str, ...] = ()
    """Beginnings of the parameters that say how missions and commands are flown: those are taken over from logs. Gains,
    sensors and failsafes are the airframe's."""
    parts: Mapping[str, Any] = field(default_factory=dict)
    """Name of a part -> the object, or "module:NAME"."""

    @property
    def name(self) -> str:
        """As it is registered and named in options: "copter", "rover" ..."""
        return self.firmware.name

    @property
    def mav_types(self) -> tuple[int, ...]:
        """Every MAV_TYPE whose vehicles are of this kind."""
        return (self.mav_type, *self.other_mav_types)

    @property
    def record_path(self) -> str:
        """Where its record is: the core is compiled for it."""
        return f"{self.record.__module__}.{self.record.__qualname__}"

    def part(self, name: str, of: type[T]) -> T:
        """What a package needs of the kind.

        Args:
            name: of the part.
            of: class that it is of.

        Raises:
            MissingPartError: the kind has no such part, or one of another class.
        """
        found = self.parts.get(name)
        wanted = f"part {name!r}, a {of.__module__}.{of.__qualname__}"
        if found is None:
            raise MissingPartError(
                f"vehicle {self.name!r} has no {wanted}; it has {', '.join(self.parts) or 'no parts'}"
            )
        found = load(found) if isinstance(found, str) else found
        if not isinstance(found, of):
            raise MissingPartError(f"vehicle {self.name!r}: {found!r} is no {wanted}")
        return found


def load(path: str) -> Any:
    """The object at "module:NAME"."""
    module, _, name = path.partition(":")
    return getattr(import_module(module), name)
