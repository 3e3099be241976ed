# SPDX-License-Identifier: BSD-3-Clause
"""A copter's airframe by the properties of its logs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from .. import vehicles
from ..autopilot.copter.parameters import TABLE
from ..core.constants import GRAVITY
from ..logs.dataflash import motors
from ..physics.native.atmosphere import density
from ..vehicles import CopterAirframe
from .expected import Conditions, Copter, exponent, slope_of
from .log_streams import FlightLog, IdentifyError
from .model import Model, outflow
from .shared import Found, battery, kept

_BASES = {
    (1, 0): "ardupilot_quad",
    (1, 1): "ardupilot_x",
    (2, 0): "ardupilot_hexa",
    (2, 1): "ardupilot_hexa_x",
    (3, 0): "ardupilot_octa",
    (4, 1): "ardupilot_octa_quad",
    (5, 0): "ardupilot_y6",
}
"""FRAME_CLASS, FRAME_TYPE -> the shipped airframe with these rotors."""
_SHIPPED = Conditions(math.nan, 1.0, 0.0)
"""Of a shipped airframe: a full battery at sea level."""
_KEPT = ("ATC_", "FRAME_", "INS_ACCEL_FILTER", "INS_GYRO_FILTER", "MOT_", "PSC_", "WPNAV_", "WP_", "ANGLE_MAX")
"""Parameters of the log that the airframe takes over, as far as the firmware has them."""


def model_of(logs: Sequence[FlightLog], found: Found, mass: float | None) -> Model:
    """The shipped airframe with the rotors of the log's FRAME_CLASS and FRAME_TYPE, changed by properties.

    Raises:
        IdentifyError: there is no shipped airframe with such rotors, or the hover output was not found.
    """
    first = logs[0]
    pair = motors.frame(first.columns)
    if pair not in _BASES:
        known = ", ".join(f"{a}/{b}" for a, b in _BASES)
        raise IdentifyError(
            f"log {str(first.path)!r}: FRAME_CLASS/FRAME_TYPE {pair[0]}/{pair[1]} is none of {known}, of which "
            "there are airframes to begin with"
        )
    hover = found("hover_output")
    if not hover.is_observed:
        raise IdentifyError(f"no airframe without {hover}")
    base = vehicles.load(_BASES[pair])
    assert isinstance(base, CopterAirframe)
    low, high = first.parameter("MOT_SPIN_MIN", default=0.15), first.parameter("MOT_SPIN_MAX", default=0.95)
    command = (hover.value - low) / (high - low)
    if not 0.0 < command < 1.0:
        raise IdentifyError(f"no airframe with {hover}: outside MOT_SPIN_MIN .. MAX {low} .. {high}")
    mass = mass or float(base.value("mass"))
    parameters = {**first.parameters, "FRAME_CLASS": float(pair[0]), "FRAME_TYPE": float(pair[1])}
    scaled = _scaled(logs, found, base, mass, command, (low, high))
    model = Model(scaled, parameters, first.conditions, found, _authority(base, parameters))
    model.notes["outflow_speed_max"] = f"identified, by {hover}"
    for name, source in (
        ("thrust_expo", "thrust_expo"),
        ("power_by_thrust", "hover_current"),
        ("battery_resistance", "battery_resistance"),
    ):
        if found(source).is_observed and float(model.airframe.value(name)) > 0.0:
            model.notes[name] = f"identified, by {found(source)}"
    return model


def _authority(base: CopterAirframe, parameters: Mapping[str, float]) -> dict[str, float]:
    """Effectiveness of roll, pitch and yaw of a vehicle that is tuned as the shipped airframe: times the rate
    controller's gain it is the same. It stands for what the logs do not show; a vehicle with much more of it would not
    fly with these gains."""
    own = {parameter.name: parameter.default for parameter in TABLE} | dict(base.parameters)
    properties = Copter(
        base, {**own, **{k: parameters[k] for k in ("FRAME_CLASS", "FRAME_TYPE")}}, _SHIPPED
    ).properties()
    found = {}
    for axis, short in (("roll", "RLL"), ("pitch", "PIT"), ("yaw", "YAW")):
        gain = f"ATC_RAT_{short}_P"
        share = own[gain] / parameters[gain] if parameters.get(gain, 0.0) > 0.0 else 1.0
        found[axis] = properties[f"{axis}_effectiveness"] * share
    return found


def _scaled(
    logs: Sequence[FlightLog],
    found: Found,
    base: CopterAirframe,
    mass: float,
    command: float,
    spin: tuple[float, float],
) -> CopterAirframe:
    """The base with this mass, which hovers at this command, and the log's parameters."""
    first = logs[0]
    heavier = mass / float(base.value("mass"))
    expo, cells = (
        float(base.value("thrust_expo")),
        battery(first, found("hover_voltage"), found("battery_resistance"), found("hover_current").is_observed),
    )
    if found("thrust_expo").is_observed:
        expo = found("thrust_expo").value
        if "battery_capacity" in cells:  # its sag is in the property, and in the model besides
            sag = found("battery_resistance").value * found("hover_current").value / found("hover_voltage").value
            expo = exponent(slope_of(expo, command) * (1.0 + 2.0 * sag), command)
    expo = min(max(expo, 0.0), 1.0)
    base = replace(base, properties={**base.properties, **cells})
    speed = outflow(base, mass, command, expo, density(first.altitude))
    changes: dict[str, float | tuple[float, ...]] = {
        "mass": mass,
        "inertia": tuple(heavier * x for x in base.value("inertia")),
        "drag_area": tuple(heavier * x for x in base.value("drag_area")),
        "momentum_drag": float(base.value("momentum_drag")) * math.sqrt(heavier),
        "control_min": spin[0],
        "control_max": spin[1],
        "thrust_expo": expo,
        "outflow_speed_max": speed,
        "power_by_thrust": float(base.value("power_by_thrust")),
    }
    voltage, current = found("hover_voltage"), found("hover_current")
    if voltage.is_observed:
        changes["outflow_speed_max"] = speed * float(base.value("battery_voltage_full")) / voltage.value
    if voltage.is_observed and current.is_observed:
        changes["power_by_thrust"] = voltage.value * current.value / (mass * GRAVITY)
    return CopterAirframe(
        name="identified",
        description=f"identified from {', '.join(log.path.name for log in logs)}",
        rotors=base.rotors,
        properties={**base.properties, **changes},
        parameters=kept({**base.parameters, **_own(first.parameters)}, ("",), TABLE),
    )


def _own(parameters: Mapping[str, float]) -> dict[str, float]:
    """Those that are the log's; pulses are not: properties count outputs from MOT_PWM_MIN to _MAX."""
    kept_ones = {name: value for name, value in parameters.items() if name.startswith(_KEPT)}
    return {name: value for name, value in kept_ones.items() if not name.startswith("MOT_PWM_M")}
