# SPDX-License-Identifier: BSD-3-Clause
"""Properties of a multicopter; the origin is the centre of mass."""

from __future__ import annotations

import math

from ...core.records import Floats, Record
from ...core.vectors import Vec3
from . import body
from .body import Battery, Body, Outline, Ranging, Sensors
from .property import described

ROTORS_MAX = 8

THRUST_SPEED_SQUARED = 0
"""Thrust model: thrust = coefficient * speed^2 with first-order speed lag (RotorS)."""
THRUST_MOMENTUM = 1
"""Thrust model: momentum theory, outflow against inflow (ArduPilot's SITL multicopter)."""

_SPEED = (THRUST_SPEED_SQUARED,)
_FLOW = (THRUST_MOMENTUM,)
_TINY = 1e-12

MODEL = "thrust_model"
"""The property that says which of the others are needed."""


class Air(Record):
    """Drag, and the steps of the integration."""

    drag_area: Vec3 = described("m^2", "drag coefficient times area along body x, y, z", default=(0.0, 0.0, 0.0))
    angular_damping: float = described("1/s", "rotational air resistance: angular acceleration per rate", default=0.0)
    gyroscopic: int = described(
        "", "1: a body that turns about two axes is turned about the third; 0: it is not", 0, 1, 1
    )
    wind_lag: float = described("", "time constant of the wind by SIM_WIND_TC", 0.001, 10.0, 1.0)
    substeps: int = described("", "integration steps a tick", 1, 100, 1)


class Hubs(Record):
    """Positions of the rotors; written from the airframe's rotors."""

    rotor_count: int = described("", "rotors", 1, ROTORS_MAX)
    rotor_x: Floats = described("m", "hub positions, forward", -math.inf, count=ROTORS_MAX)
    rotor_y: Floats = described("m", "to the right", -math.inf, count=ROTORS_MAX)
    rotor_z: Floats = described("m", "down", -math.inf, count=ROTORS_MAX)
    rotor_direction: Floats = described(
        "", "+1 counter-clockwise seen from above, -1 clockwise", -1, 1, count=ROTORS_MAX
    )


class Rotors(Record):
    """Motors and rotors."""

    thrust_model: int = described("", "THRUST_SPEED_SQUARED 0 or THRUST_MOMENTUM 1", 0, 1)
    control_min: float = described("", "actuator control that gives command 0", 0.0, 0.99, 0.0)
    control_max: float = described("", "actuator control that gives command 1", 0.01, 1.0, 1.0)
    command_slew: float = described("1/s", "fastest change of command, 0 unlimited", default=0.0)
    time_constant_up: float = described("s", "first-order lag of a rotor that speeds up, 0 none", default=0.0)
    time_constant_down: float = described("s", "the same when it slows down", default=0.0)
    speed_max: float = described("rad/s", "at command 1", _TINY, 1e5, models=_SPEED)
    speed_voltage: float = described(
        "V", "battery voltage below which top speed falls in proportion, 0 never", default=0.0
    )
    thrust_coefficient: float = described("N/(rad/s)^2", "thrust by speed squared", _TINY, 1e3, models=_SPEED)
    moment_coefficient: float = described("m", "drag torque by thrust", models=_SPEED)
    rotor_drag: float = described("N/(rad/s)/(m/s)", "in-plane drag by rotor speed and air speed", default=0.0)
    rolling_moment: float = described("N m/(rad/s)/(m/s)", "torque by rotor speed and in-plane air speed", default=0.0)
    rotor_inertia: float = described("kg m^2", "of one rotor about its axis", default=0.0)
    efficiency: float = described("", "rotor shaft power by battery power", 0.001, 1.0, 1.0)
    outflow_area: float = described("m^2", "effective area of one rotor", _TINY, 1e3, models=_FLOW)
    outflow_speed_max: float = described("m/s", "at command 1 and full battery", _TINY, 400.0, models=_FLOW)
    thrust_expo: float = described(
        "", "outflow^2 goes with (1 - expo) c + expo c^2 of command c", 0.0, 1.0, models=_FLOW
    )
    yaw_lever: float = described("m", "yaw torque by thrust and command", models=_FLOW)
    momentum_drag: float = described("", "drag coefficient of a rotor's momentum flow, each axis", default=0.0)
    disc_area: float = described("m^2", "true area of one rotor", models=_FLOW)
    power_by_thrust: float = described("W/N", "battery power by thrust", models=_FLOW)


class Legs(Record):
    """What it stands on."""

    ground_friction: float = described("", "Coulomb coefficient")
    leg_time_constant: float = described("s", "time in which the legs take up an impact or a lean")
    tip_angle: float = described("rad", "touching with more lean than this tips it over", 0.0, math.pi)
    hit_speed: float = described("m/s", "slowest touch that is reported")


class Firmware(Record):
    """What the firmware has to know of it and no parameter says."""

    learns_at_rest: int = described("", "1: the hover throttle is learnt only while the path stands still", 0, 1, 0)


class Properties(body.Properties, Body, Air, Hubs, Rotors, Battery, Legs, Firmware, Sensors, Outline, Ranging):
    """All properties of a multicopter."""
