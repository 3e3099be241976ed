# SPDX-License-Identifier: BSD-3-Clause
"""Rotors and lean that give a multicopter in the air the acceleration it has, with other properties, wind or speed.

The forces are balanced exactly: thrust holds weight and drag. Torques are left to the rate loops: what wind does to
rotors above or below the centre is new to them for a moment.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import ZERO, conjugate, cross, dot, multiply, norm, normalise, rotate, rotate_inverse
from ....core.kernels import law
from ....core.records import Floats
from ....core.vectors import Quat, Vec3
from ....vehicles.properties.multicopter import THRUST_MOMENTUM
from ..body import Wrench
from .rotors import Flow, momentum_wrench, speed_squared_wrench
from .state import Physics
from .wrench import add_air

_STEPS = 24
"""Each step leaves at most half of the error."""
RESERVE = 0.95
"""Greatest rotor command at which a vehicle is said to hover: less than full, so that it can still be steered."""


class Trim(NamedTuple):
    """What the balance came to."""

    turn: Quat
    """Of the body, in NED."""
    holds: bool
    """Rotors can give it."""


@law
def rotors_wrench(p: Physics, flow: Flow) -> Wrench:
    """What the rotors do at their present speeds."""
    airframe = p.airframe
    if airframe.thrust_model == THRUST_MOMENTUM:
        outflow = airframe.outflow_speed_max * p.battery.voltage * p.derived.voltage_scale
        return momentum_wrench(p.rotors, airframe, flow, p.air, outflow)
    return speed_squared_wrench(p.rotors, airframe, flow)


@law
def arc(a: Vec3, b: Vec3) -> Quat:
    """The smallest rotation of one direction to another; unit vectors, not opposite."""
    c = cross(a, b)
    return normalise(Quat(1.0 + dot(a, b), c.x, c.y, c.z))


@law
def speed_at_full(p: Physics) -> float:
    """A rotor's speed at command 1, at this voltage."""
    airframe = p.airframe
    if airframe.thrust_model == THRUST_MOMENTUM:
        return 1.0
    if p.derived.speed_per_volt > 0.0:
        return min(airframe.speed_max, p.derived.speed_per_volt * p.battery.voltage)
    return airframe.speed_max


@law
def balance(p: Physics, wanted: Vec3) -> Trim:
    """Turn the body and set the rotors' speeds for a specific force NED [m/s^2]; the wind is the steady one."""
    b, rotors, airframe = p.body, p.rotors, p.airframe
    before, up = b.q, Vec3(0.0, 0.0, -1.0)
    air = b.vel - p.wind.steady
    for _ in range(_STEPS):
        flow = Flow(rotate_inverse(b.q, air), ZERO)
        made = rotors_wrench(p, flow)
        force = add_air(made, 0.0, flow, airframe, p.air.density).force
        thrust = -made.force.z
        drag = rotate(b.q, Vec3(force.x, force.y, force.z + thrust))
        needed = airframe.mass * wanted - drag
        size = norm(needed)
        if not (thrust > 0.0 and size > 0.0):
            return Trim(Quat(1.0, 0.0, 0.0, 0.0), False)
        direction = needed / size
        axis = rotate(b.q, up)
        if dot(axis, direction) < 0.0:
            return Trim(Quat(1.0, 0.0, 0.0, 0.0), False)
        b.q = normalise(multiply(arc(axis, direction), b.q))
        k = math.sqrt(size / thrust)
        for rotor in range(airframe.rotor_count):
            rotors.speed[rotor] *= k
    b.specific_force = rotate_inverse(b.q, wanted)
    full, holds = speed_at_full(p), True
    for rotor in range(airframe.rotor_count):
        holds = holds and rotors.speed[rotor] <= RESERVE * rotors.share[rotor] * full
    return Trim(multiply(b.q, conjugate(before)), holds)


@law
def command_speeds(p: Physics, controls: Floats) -> None:
    """Commands and actuator controls that keep the rotors' speeds."""
    airframe, rotors = p.airframe, p.rotors
    top = 1.0 if airframe.thrust_model == THRUST_MOMENTUM else airframe.speed_max
    for k in range(airframe.rotor_count):
        rotors.command[k] = rotors.speed[k] / top
        made = rotors.command[k] * (airframe.control_max - airframe.control_min) + airframe.control_min
        controls[k] = made / rotors.share[k] if rotors.share[k] > 0.0 else 0.0
