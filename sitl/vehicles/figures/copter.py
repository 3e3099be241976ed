# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a multicopter; the origin is the centre of mass."""

from __future__ import annotations

import math

from ...core.records import Floats, Record
from ...core.vectors import Vec3
from . import body
from .body import Battery, Body, Outline, Ranging, Sensors
from .figure import figure

ROTORS_MAX = 8

THRUST_SPEED_SQUARED = 0
"""Thrust model: thrust = coefficient * speed^2 with first-order speed lag (RotorS)."""
THRUST_MOMENTUM = 1
"""Thrust model: momentum theory, outflow against inflow (ArduPilot's SITL multicopter)."""

_SPEED = (THRUST_SPEED_SQUARED,)
_FLOW = (THRUST_MOMENTUM,)
_TINY = 1e-12

MODEL = "thrust_model"
"""The figure that says which of the others are needed."""


class Air(Record):
    """Drag, and the steps of the integration."""

    drag_area: Vec3 = figure("m^2", "drag coefficient times area along body x, y, z", default=(0.0, 0.0, 0.0))
    angular_damping: float = figure("1/s", "rotational air resistance: angular acceleration per rate", default=0.0)
    gyroscopic: int = figure("", "1: a body that turns about two axes is turned about the third; 0: it is not", 0, 1, 1)
    wind_lag: float = figure("", "time constant of the wind by SIM_WIND_TC", 0.001, 10.0, 1.0)
    substeps: int = figure("", "integration steps a tick", 1, 100, 1)


class Hubs(Record):
    """Positions of the rotors; written from the airframe's rotors."""

    rotor_count: int = figure("", "rotors", 1, ROTORS_MAX)
    rotor_x: Floats = figure("m", "hub positions, forward", -math.inf, count=ROTORS_MAX)
    rotor_y: Floats = figure("m", "to the right", -math.inf, count=ROTORS_MAX)
    rotor_z: Floats = figure("m", "down", -math.inf, count=ROTORS_MAX)
    rotor_direction: Floats = figure("", "+1 counter-clockwise seen from above, -1 clockwise", -1, 1, count=ROTORS_MAX)


class Rotors(Record):
    """Motors and rotors."""

    thrust_model: int = figure("", "THRUST_SPEED_SQUARED 0 or THRUST_MOMENTUM 1", 0, 1)
    control_min: float = figure("", "actuator control that gives command 0", 0.0, 0.99, 0.0)
    control_max: float = figure("", "actuator control that gives command 1", 0.01, 1.0, 1.0)
    command_slew: float = figure("1/s", "fastest change of command, 0 unlimited", default=0.0)
    time_constant_up: float = figure("s", "first-order lag of a rotor that speeds up, 0 none", default=0.0)
    time_constant_down: float = figure("s", "the same when it slows down", default=0.0)
    speed_max: float = figure("rad/s", "at command 1", _TINY, 1e5, models=_SPEED)
    speed_voltage: float = figure(
        "V", "battery voltage below which top speed falls in proportion, 0 never", default=0.0
    )
    thrust_coefficient: float = figure("N/(rad/s)^2", "thrust by speed squared", _TINY, 1e3, models=_SPEED)
    moment_coefficient: float = figure("m", "drag torque by thrust", models=_SPEED)
    rotor_drag: float = figure("N/(rad/s)/(m/s)", "in-plane drag by rotor speed and air speed", default=0.0)
    rolling_moment: float = figure("N m/(rad/s)/(m/s)", "torque by rotor speed and in-plane air speed", default=0.0)
    rotor_inertia: float = figure("kg m^2", "of one rotor about its axis", default=0.0)
    efficiency: float = figure("", "rotor shaft power by battery power", 0.001, 1.0, 1.0)
    outflow_area: float = figure("m^2", "effective area of one rotor", _TINY, 1e3, models=_FLOW)
    outflow_speed_max: float = figure("m/s", "at command 1 and full battery", _TINY, 400.0, models=_FLOW)
    thrust_expo: float = figure("", "outflow^2 goes with (1 - expo) c + expo c^2 of command c", 0.0, 1.0, models=_FLOW)
    yaw_lever: float = figure("m", "yaw torque by thrust and command", models=_FLOW)
    momentum_drag: float = figure("", "drag coefficient of a rotor's momentum flow, each axis", default=0.0)
    disc_area: float = figure("m^2", "true area of one rotor", models=_FLOW)
    power_by_thrust: float = figure("W/N", "battery power by thrust", models=_FLOW)


class Legs(Record):
    """What it stands on."""

    ground_friction: float = figure("", "Coulomb coefficient")
    leg_time_constant: float = figure("s", "time in which the legs take up an impact or a lean")
    tip_angle: float = figure("rad", "touching with more lean than this tips it over", 0.0, math.pi)
    hit_speed: float = figure("m/s", "slowest touch that is reported")


class Firmware(Record):
    """What the firmware has to know of it and no parameter says."""

    learns_at_rest: int = figure("", "1: the hover throttle is learnt only while the path stands still", 0, 1, 0)


class Figures(body.Figures, Body, Air, Hubs, Rotors, Battery, Legs, Firmware, Sensors, Outline, Ranging):
    """All figures of a multicopter."""
