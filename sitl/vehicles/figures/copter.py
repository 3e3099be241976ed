# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a multicopter; the origin is the centre of mass."""

from __future__ import annotations

import math

from .battery import BATTERY
from .body import BODY, OUTLINE
from .figure import Figure, figures_record
from .ranging import RANGING
from .sensors import SENSORS

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

AIR = (
    Figure("drag_area", "m^2", "drag coefficient times area along body x, y, z", default=(0.0, 0.0, 0.0), length=3),
    Figure("angular_damping", "1/s", "rotational air resistance: angular acceleration per rate", default=0.0),
    Figure("substeps", "", "integration steps a tick", 1, 100, 1, whole=True),
)

HUBS = (  # written from the airframe's rotors
    Figure("rotor_count", "", "rotors", 1, ROTORS_MAX, whole=True),
    Figure("rotor_x", "m", "hub positions, forward", -math.inf, length=ROTORS_MAX),
    Figure("rotor_y", "m", "to the right", -math.inf, length=ROTORS_MAX),
    Figure("rotor_z", "m", "down", -math.inf, length=ROTORS_MAX),
    Figure("rotor_direction", "", "+1 counter-clockwise seen from above, -1 clockwise", -1, 1, length=ROTORS_MAX),
)

ROTORS = (
    Figure(MODEL, "", "THRUST_SPEED_SQUARED 0 or THRUST_MOMENTUM 1", 0, 1, whole=True),
    Figure("control_min", "", "actuator control that gives command 0", 0.0, 0.99, 0.0),
    Figure("control_max", "", "actuator control that gives command 1", 0.01, 1.0, 1.0),
    Figure("command_slew", "1/s", "fastest change of command, 0 unlimited", default=0.0),
    Figure("time_constant_up", "s", "first-order lag of a rotor that speeds up, 0 none", default=0.0),
    Figure("time_constant_down", "s", "the same when it slows down", default=0.0),
    Figure("speed_max", "rad/s", "at command 1", _TINY, 1e5, models=_SPEED),
    Figure("speed_voltage", "V", "battery voltage below which top speed falls in proportion, 0 never", default=0.0),
    Figure("thrust_coefficient", "N/(rad/s)^2", "thrust by speed squared", _TINY, 1e3, models=_SPEED),
    Figure("moment_coefficient", "m", "drag torque by thrust", models=_SPEED),
    Figure("rotor_drag", "N/(rad/s)/(m/s)", "in-plane drag by rotor speed and air speed", default=0.0),
    Figure("rolling_moment", "N m/(rad/s)/(m/s)", "torque by rotor speed and in-plane air speed", default=0.0),
    Figure("rotor_inertia", "kg m^2", "of one rotor about its axis", default=0.0),
    Figure("efficiency", "", "rotor shaft power by battery power", 1e-3, 1.0, 1.0),
    Figure("outflow_area", "m^2", "effective area of one rotor", _TINY, 1e3, models=_FLOW),
    Figure("outflow_speed_max", "m/s", "at command 1 and full battery", _TINY, 400.0, models=_FLOW),
    Figure("thrust_expo", "", "outflow^2 goes with (1 - expo) c + expo c^2 of command c", 0.0, 1.0, models=_FLOW),
    Figure("yaw_lever", "m", "yaw torque by thrust and command", models=_FLOW),
    Figure("momentum_drag", "", "drag coefficient of a rotor's momentum flow, each axis", default=0.0),
    Figure("disc_area", "m^2", "true area of one rotor", models=_FLOW),
    Figure("power_by_thrust", "W/N", "battery power by thrust", models=_FLOW),
)

LEGS = (
    Figure("ground_friction", "", "Coulomb coefficient"),
    Figure("leg_time_constant", "s", "time in which the legs take up an impact or a lean"),
    Figure("tip_angle", "rad", "touching with more lean than this tips it over", 0.0, math.pi),
    Figure("hit_speed", "m/s", "slowest touch that is reported"),
)

FIGURES = (*BODY, *AIR, *HUBS, *ROTORS, *BATTERY, *LEGS, *SENSORS, *OUTLINE, *RANGING)
FIGURES_RECORD = figures_record("Copter", FIGURES)
