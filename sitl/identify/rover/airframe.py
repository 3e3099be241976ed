# SPDX-License-Identifier: BSD-3-Clause
"""A rover's airframe by the properties of its logs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ... import vehicles
from ...autopilot.rover.parameters import TABLE
from ...vehicles import RoverAirframe
from ...vehicles.properties.ground_vehicle import STEERING_TURNING_CIRCLE
from ..log_streams import FlightLog, IdentifyError
from ..shared import NOISES, Found, battery, kept
from .model import BASES
from .outputs import is_skid

_KEPT = ("ATC_", "CRUISE_", "MANUAL_", "MOT_", "PSC_", "SPEED_MAX", "TURN_RADIUS", "WP_")
"""Parameters of the log that the airframe takes over, as far as the firmware has them."""
_LENGTHS = ("track", "rear_axle", "wheel_radius", "centre_height", "contact_radius", "contact_top", "base_along")
_LEAST_ANGLE = 0.2
"""A curve of the steering that is straighter tells no angle of the wheels [rad]."""


class RoverModel(NamedTuple):
    """The airframe, and what its properties follow from."""

    airframe: RoverAirframe
    notes: dict[str, str]


def model_of(logs: Sequence[FlightLog], found: Found, mass: float | None) -> RoverModel:
    """The shipped airframe that steers as the log's does, changed by properties.

    Raises:
        IdentifyError: speed or steering were not found.
    """
    first, skids = logs[0], is_skid(logs[0])
    for name in ("speed_by_throttle", "turning_track" if skids else "steering_gain"):
        if not found(name).is_observed:
            raise IdentifyError(f"no airframe without {found(name)}")
    base = vehicles.load(BASES[skids])
    changes: dict[str, Any] = {}
    notes: dict[str, str] = {}

    def take(name: str, source: str, value: float) -> None:
        changes[name] = value
        notes[name] = f"identified, by {found(source)}"

    _drive(found, take, changes)
    if found("grip").least > float(base.value("grip")):
        changes["grip"], notes["grip"] = found("grip").least, f"at least so much, by {found('grip')}"
    if skids:
        take("track", "turning_track", found("turning_track").value / float(base.value("track_slip")))
        size = changes["track"] / float(base.value("track"))
    else:
        _steer(found, take, changes, base)
        size = changes["wheelbase"] / float(base.value("wheelbase"))
    for name in _LENGTHS:
        changes.setdefault(name, size * float(base.value(name)))
    changes["contact_along"] = tuple(size * x for x in base.value("contact_along"))
    if found("rear_axle").is_observed:
        take("rear_axle", "rear_axle", found("rear_axle").value)
    mass = mass or float(base.value("mass")) * size**3
    heavier = mass / float(base.value("mass"))
    changes["mass"] = mass
    changes["inertia"] = tuple(heavier * size * size * x for x in base.value("inertia"))
    _power(first, found, take, changes, base)
    for name in NOISES:
        if found(name).is_observed:
            take(name, name, found(name).value)
    properties = {**base.properties, **{name: _allowed(base, name, value) for name, value in changes.items()}}
    airframe = RoverAirframe(
        name="identified",
        description=f"identified from {', '.join(log.path.name for log in logs)}",
        properties=properties,
        parameters={**_base_parameters(base), **kept(first.parameters, _KEPT, TABLE)},
    )
    return RoverModel(airframe, notes)


def _drive(found: Found, take: Any, changes: dict[str, Any]) -> None:
    take("speed_max", "speed_by_throttle", found("speed_by_throttle").value)
    changes |= {"time_constant": 0.0, "rolling_resistance": 0.0, "drive_accel": 0.0, "driven_load": 1.0}
    for name, source in (
        ("time_constant", "speed_lag"),
        ("rolling_resistance", "rolling_resistance"),
        ("drive_accel", "drive_accel"),
        ("grip", "grip"),
    ):
        if found(source).is_observed:
            take(name, source, found(source).value)


def _steer(found: Found, take: Any, changes: dict[str, Any], base: Any) -> None:
    """Wheelbase, angle, time of the servo. The ratio of curvature at full steering to that of the slope about straight
    on is tan(angle) / angle for front wheels, sin(angle) / angle for a turning circle: it gives the angle."""
    slope, radius, angle = found("steering_gain").value, found("turning_radius"), float(base.value("steering_angle"))
    source = "steering_gain"
    if radius.is_observed:
        ratio = 1.0 / (radius.value * slope)
        shape = _angle(ratio)
        if ratio < 1.0 and shape > _LEAST_ANGLE:
            take("steering_angle", "turning_radius", shape)
            take("turning_diameter", "turning_radius", 2.0 * radius.value)
            changes["steering_model"] = STEERING_TURNING_CIRCLE
            take("wheelbase", "turning_radius", math.tan(shape) * radius.value)
            angle = shape
            source = ""
        elif ratio > 1.0 and shape > _LEAST_ANGLE:
            angle = shape
            take("steering_angle", "turning_radius", angle)
    if source:
        take("wheelbase", "steering_gain", angle / slope)
    changes["steering_rate"] = 0.0
    if found("steering_time").is_observed and found("steering_time").low > 0.0:
        take("steering_rate", "steering_time", angle / found("steering_time").value)


def _angle(ratio: float) -> float:
    """The angle [rad] whose tangent (more than 1) or sine (less than 1) is so many times the angle itself."""
    function = math.tan if ratio > 1.0 else math.sin
    low, high = 0.0, math.radians(80.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        over = function(middle) / middle > ratio if ratio > 1.0 else function(middle) / middle < ratio
        low, high = (low, middle) if over else (middle, high)
    return high


def _power(first: FlightLog, found: Found, take: Any, changes: dict[str, Any], base: Any) -> None:
    load = found("mass_by_efficiency")
    changes |= battery(first, found("battery_voltage"), found("battery_resistance"), load.is_observed)
    changes |= {"efficiency": 0.0, "power_full": 0.0}
    if load.is_observed:
        take("efficiency", "mass_by_efficiency", changes["mass"] / load.value)
    for name in ("power_full", "avionics_current"):
        if found(name).is_observed:
            take(name, name, found(name).value)
    if not load.is_observed and not found("power_full").is_observed:
        changes["efficiency"] = float(base.value("efficiency"))


def _allowed(base: Any, name: str, value: Any) -> Any:
    """Within what an airframe may have."""
    prop = next(prop for prop in base.known if prop.name == name)
    return value if isinstance(value, tuple) else min(max(value, prop.low), prop.high)


def _base_parameters(base: Any) -> dict[str, float]:
    """What the base needs as hardware; how it is driven is the log's."""
    return {name: value for name, value in base.parameters.items() if not name.startswith(_KEPT)}
