# SPDX-License-Identifier: BSD-3-Clause
"""What environments need to know of a kind of vehicle: modes, set-points, usual actions; part "environments" of
``sitl.vehicle.kind.Kind``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.client.connection import Connection
from sitl.vehicle.kinds import KINDS
from sitl.vehicles import Airframe

from ..actions import Action, Continuous, Discrete, Setpoint
from ..mavlink.target_messages import Encode
from ..options import EnvOptionError
from .robot import Floats, Volume

Rows = Mapping[str, tuple[float, ...]]
Limits = tuple[tuple[float, ...], tuple[float, ...], tuple[int, ...]]
"""Low limits, high limits, and the columns of the set-point that they belong to."""


@dataclass(frozen=True)
class RobotKind:
    """A kind of vehicle with an autopilot, as environments drive it."""

    setpoints: tuple[Setpoint, ...]
    modes: Mapping[str, int]
    """Flight mode for each kind of set-point."""
    guided: int
    encode: Mapping[str, Encode]
    tick: float
    """Period of its autopilot's loop [s]."""
    crash_range: float
    """Range below which a reading is a crash, as in the paper [m]."""
    discrete: Mapping[str, Rows]
    continuous: Mapping[str, Limits]
    agile: Mapping[str, Limits]
    """Limits of "normalised" actions where they are not those of ``continuous``."""
    takes_off: bool
    """An episode begins in the air."""
    feels_wind: bool
    """Wind is among the properties that may be changed."""
    parameters: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    """Kind of set-point -> parameter and the bit of it that the vehicle must have."""
    drive: Callable[[Any, npt.NDArray[np.int64], Floats], None] | None = None
    """Writes the controls of ``actions.MOTORS`` into a fleet's records: ``drive(records, rows, commands)``; None:
    motors cannot be driven directly."""
    repeat_us: int = 0
    """Time after which a set-point is sent again within a step; 0: it holds until the next one [us]."""
    before_mode: Mapping[str, Callable[[Connection], None]] = field(default_factory=dict)
    """Kind of set-point -> what makes the vehicle ready for its mode."""
    with_px4: RobotKind | None = None
    """The same when PX4 controls it; None: environments do not drive it then."""
    with_betaflight: RobotKind | None = None
    """The same when Betaflight does."""
    prepares: Callable[[Connection, float], None] | None = None
    """Brings a vehicle from power-on to a height [m] in a way of its own; None: as ``guided`` says."""

    def are_alike(self, one: str, other: str) -> bool:
        """Whether a vehicle that is ready for one kind of set-point takes the other one, too, as it is."""
        modes, parameters = self.modes, self.parameters
        return one in modes and modes[one] == modes[other] and parameters.get(one) == parameters.get(other)

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """The default actions of a form, "discrete", "continuous" or "agile", for a kind of set-point."""
        if form == "discrete":
            if setpoint.name not in self.discrete:
                allowed = ", ".join(self.discrete)
                raise EnvOptionError(f"no discrete actions for setpoint {setpoint.name!r}; there are for {allowed}")
            return Discrete(setpoint, self.discrete[setpoint.name])
        limits = self.agile if form == "agile" else {}
        return Continuous(setpoint, *limits.get(setpoint.name, self.continuous[setpoint.name]))


def robot_kind(name: str) -> RobotKind:
    """Of a kind of vehicle, by its name.

    Raises:
        UnknownKindError, MissingPartError: there is no such kind, or environments cannot drive it.
    """
    return KINDS[name].part("environments", RobotKind)


def volume(airframe: Airframe, climbs: float) -> Volume:
    """The volume of a vehicle, extended upwards by the height that it climbs [m]."""
    reach = max(abs(x) for x in airframe.value("contact_along")) if airframe.value("contact_discs") > 1 else 0.0
    return Volume(
        float(reach + airframe.value("contact_radius")),
        0.0 - float(airframe.value("contact_bottom")),
        float(airframe.value("contact_top")) + climbs,
    )


def pulses(one: int, two: int, three: int) -> tuple[float, ...]:
    """A row of RC_OVERRIDE: channels 1 to 3 [us], the others released."""
    return (one, two, three, 0.0, 0.0, 0.0, 0.0, 0.0)


FAR = 10_000.0
"""A limit that no position reaches [m]."""
