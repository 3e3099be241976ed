# SPDX-License-Identifier: BSD-3-Clause
"""What the page needs to know of a kind of vehicle: its part "view" (``sitl.vehicle.kind``)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..core.vectors import Vec3
from ..vehicle.kind import Kind, MissingPartError
from ..vehicle.kinds import KINDS
from ..vehicles.airframe import Airframe, apply
from ..vehicles.turtlebot import TurtlebotAirframe
from . import turtlebot_model
from .shape import Shape, plain


class Motion(NamedTuple):
    """What moves on a vehicle (fields of ``Frame``)."""

    rotors: tuple[float, ...] = ()
    steering: float = 0.0
    rolled: tuple[float, float] = (0.0, 0.0)
    ground_hits: tuple[int, float, int] = (0, 0.0, 0)
    """Impacts on the ground so far; speed of the last one [m/s] and when it was [us]."""


@dataclass(frozen=True)
class KindView:
    """A kind of vehicle as it is shown."""

    shape: Callable[[Any], Shape]
    """Of a record of properties (``v.physics.airframe``)."""
    motion: Callable[[Any], Motion]
    """What moves on a vehicle ``v``."""
    set_point: Callable[[Any], Vec3 | None]
    """Position that the controllers of ``v`` follow, NED from the estimator's origin [m]; None: none at present."""


def _outline(airframe: Any) -> Shape:
    radius = max(airframe.contact_radius, 0.2)
    return plain(2.0 * radius, 1.4 * radius, max(airframe.contact_top + airframe.contact_bottom, 0.5 * radius))


PLAIN = KindView(_outline, lambda v: Motion(), lambda v: None)
"""Of a kind that has no part of its own."""


def shape_of(airframe: Airframe) -> Shape:
    """What an airframe looks like, whatever flies it."""
    if isinstance(airframe, TurtlebotAirframe):
        return turtlebot_model.shape(airframe)
    kind = KINDS[airframe.kind]
    v = kind.record.of(kind.record.fleet(1), 0)
    apply(airframe, v)
    return of(kind).shape(v.physics.airframe)


def of(kind: Kind) -> KindView:
    """How a kind of vehicle is shown."""
    try:
        return kind.part("view", KindView)
    except MissingPartError:
        if "view" in kind.parts:
            raise
        return PLAIN
