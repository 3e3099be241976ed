# SPDX-License-Identifier: BSD-3-Clause
"""Where a vehicle of a fleet is put, and how it is then: ``Fleet.move``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import Any

from .core.elementary import atan2, cos, sin
from .core.vectors import Vec2, Vec3
from .deprecation import renamed
from .errors import OptionError, did_you_mean
from .vehicle.kind import Kind
from .vehicle.move import MoveOrder
from .vehicle.walks import walk
from .vehicles import Airframe
from .vehicles.airframe import Value
from .vehicles.properties.property import Property

WIND = (
    Property("wind_speed", "m/s", "of the steady wind", 0.0, 50.0, 0.0),
    Property("wind_direction", "deg", "where it comes from", 0.0, 360.0, 180.0),
    Property("wind_turbulence", "m/s", "standard deviation", 0.0, 20.0, 0.0),
)
"""The numbers of ``Move.wind``."""
_FARTHEST = 100_000.0
_HIGHEST = 10_000.0
_FASTEST = 100.0
_MISSION_RUNS = 1
_MOST_SIGMA = 10.0
_known: dict[type[Airframe], dict[str, Property]] = {}


@renamed("figures", "properties", since="0.2", removed_in="0.4")
@dataclass(frozen=True)
class Move:
    """Where a vehicle is put, and how it is then; None: as it is.

    Everything that the vehicle knows of positions moves along: home, origin, targets.

    Args:
        north, east: of the body's origin, from the world's origin, without a world from where the vehicles were
            powered on, up to 100 km [m].
        height: over the floor, above 0 up to 10 km [m]; of a vehicle in the air.
        heading: from north towards east [rad].
        velocity: north, east, down, up to 100 m/s [m/s]; of a vehicle in the air, or along a rover's nose.
        wind: speed [m/s], where it comes from [deg], turbulence [m/s].
        properties: of the airframe that are numbers or vectors of three: name -> value.
        seed: of the noise of all sensors from now on.
        walks: slow error of the receiver north and east, in standard deviations, before the heading is changed: as if
            it had walked there, so that the estimate has it, too.
    """

    north: float | None = None
    east: float | None = None
    height: float | None = None
    heading: float | None = None
    velocity: tuple[float, float, float] | None = None
    wind: tuple[float, float, float] | None = None
    properties: Mapping[str, Value] = field(default_factory=dict)
    seed: int | None = None
    walks: tuple[float, float] | None = None

    def check(self, airframe: Airframe) -> None:
        """Look at all numbers.

        Raises:
            OptionError: one that cannot be taken, named, with what is allowed.
        """
        limits = -_FARTHEST, _FARTHEST
        _number("north", self.north, *limits, "m")
        _number("east", self.east, *limits, "m")
        if self.height is not None:
            _number("height", self.height, 1e-3, _HIGHEST, "m")
        _number("heading", self.heading, -1e6, 1e6, "rad")
        for name, value in zip(("north", "east", "down"), _three("velocity", self.velocity)):
            _number(f"velocity {name}", value, -_FASTEST, _FASTEST, "m/s")
        for prop, value in zip(WIND, _three("wind", self.wind)):
            _number(prop.name, value, prop.low, prop.high, prop.unit)
        for name, value in zip(("north", "east"), _some("walks", self.walks, 2)):
            _number(f"walks {name}", value, -_MOST_SIGMA, _MOST_SIGMA, "standard deviations")
        if self.properties:
            known = _numbers(type(airframe))
            for name, value in self.properties.items():
                if name not in known:
                    raise OptionError(f"property {name!r} cannot be changed by a move{did_you_mean(name, known)}")
                prop = known[name]
                elements: Any = (value,) if prop.length == 1 else _some(f"property {name}", value, prop.length)
                for one in elements:
                    _number(f"property {name}", one, prop.low, prop.high, prop.unit)

    def write(self, order: MoveOrder, vehicle: int, v: Any, kind: Kind) -> None:
        """Write it as the order for a vehicle.

        Args:
            order: to write.
            vehicle: its number in the fleet.
            v: its record.
            kind: of vehicle.

        Raises:
            OptionError: this vehicle cannot be moved so now.
        """
        if v.autopilot.modes.nav.mission_state == _MISSION_RUNS:
            raise OptionError(f"vehicle {vehicle} flies a mission, whose items stay where they are: it cannot be moved")
        flies = kind.flies and v.physics.ground.state == 0
        if self.height is not None and not flies:
            raise OptionError(f"height = {self.height!r}: vehicle {vehicle} is not in the air")
        body = v.physics.body
        here = body.pos
        order.vehicle = vehicle
        order.says_position = self.north is not None or self.east is not None or self.walks is not None
        if order.says_position:
            order.position = Vec2(
                here.x if self.north is None else self.north, here.y if self.east is None else self.east
            )
        order.says_height = self.height is not None
        order.height = self.height or 0.0
        if self.walks is not None:
            walk(v, self.walks)
        order.says_heading = self.heading is not None
        order.heading = self.heading or 0.0
        order.says_velocity = self.velocity is not None
        if self.velocity is not None:
            if not flies:
                self._check_along(vehicle, kind, body)
            order.velocity = Vec3(*self.velocity)
        order.says_wind = self.wind is not None
        if self.wind is not None:
            order.wind_speed, order.wind_direction, order.wind_turbulence = self.wind
        order.other_properties = bool(self.properties)

    def _check_along(self, vehicle: int, kind: Kind, body: Any) -> None:
        """Refuse a velocity that a vehicle on the ground cannot have."""
        assert self.velocity is not None
        q = body.q
        heading = self.heading
        if heading is None:
            heading = atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
        north, east, down = self.velocity
        across = east * cos(heading) - north * sin(heading)
        if kind.flies or abs(across) > 1e-6 or down != 0.0:
            allowed = "its motors are off" if kind.flies else "it drives along its nose only"
            raise OptionError(f"velocity = {self.velocity!r}: vehicle {vehicle} is on the ground; {allowed}")


def is_changeable(prop: Property) -> bool:
    """Whether a vehicle that was prepared with one value of a property may go on with another."""
    return prop.length in (1, 3) and not prop.whole


def _numbers(kind: type[Airframe]) -> dict[str, Property]:
    """The properties that may be changed, by name."""
    if kind not in _known:
        _known[kind] = {f.name: f for f in kind.known if is_changeable(f)}
    return _known[kind]


def _number(name: str, value: float | None, low: float, high: float, unit: str) -> None:
    if value is None or (type(value) is float and low <= value <= high):
        return
    if not (isinstance(value, Real) and not isinstance(value, bool) and low <= value <= high):
        raise OptionError(f"{name} = {value!r}; it must be a number, {low:g} .. {high:g} {unit}".rstrip())


def _three(name: str, value: Any) -> Any:
    return _some(name, value, 3)


def _some(name: str, value: Any, count: int) -> Any:
    if value is None:
        return ()
    try:
        found = tuple(value)
    except TypeError:
        found = ()
    if len(found) != count:
        raise OptionError(f"{name} = {value!r}; {'three' if count == 3 else 'two'} numbers are needed")
    return found
