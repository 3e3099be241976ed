# SPDX-License-Identifier: BSD-3-Clause
"""Rotors: actuator controls to commands, speeds, forces and torques.

Two thrust models behind one interface: RotorS (Furrer et al., "RotorS - A modular Gazebo MAV simulator
framework", 2016: thrust and torque with the square of a lagged speed, rotor drag and rolling moment from the
in-plane air speed) and the momentum model of ArduPilot's SITL multicopter (thrust from outflow and inflow
speed, momentum drag along all axes: in its recordings a climb of 2.5 m/s takes 10 % more thrust than a
hover).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ....core.algebra import ZERO
from ....core.kernels import law
from ....core.records import Floats
from ....core.vectors import Vec3
from ....vehicles.properties.multicopter import THRUST_MOMENTUM, Properties
from ..body import Wrench
from ..records import Air
from .state import Derived, Rotors


class Flow(NamedTuple):
    """How a body moves through the air, in its own frame (FRD)."""

    velocity: Vec3
    """Through the air [m/s]."""
    rates: Vec3
    """[rad/s]"""


@law
def command(rotors: Rotors, controls: Floats, airframe: Properties, derived: Derived) -> None:
    """Take over the actuator controls [0 .. 1] as rotor commands; called once a tick."""
    step, stuck = derived.command_step, rotors.stuck
    for k in range(airframe.rotor_count):
        if stuck != 0 and stuck >> k & 1:
            continue
        c = (float(controls[k]) * rotors.share[k] - airframe.control_min) * derived.control_scale
        if not c > 0.0:  # also for NaN
            c = 0.0
        elif c > 1.0:
            c = 1.0
        if step > 0.0:
            before = rotors.command[k]
            c = min(max(c, before - step), before + step)
        rotors.command[k] = c


@law
def lag(rotors: Rotors, airframe: Properties, derived: Derived, voltage: float) -> float:
    """Let the rotor speeds follow the commands for a substep at a battery voltage [V]; returns the yaw torque [N m] of
    spinning up.
    """
    top = 1.0
    if airframe.thrust_model != THRUST_MOMENTUM:
        top = airframe.speed_max
    limit = top
    if derived.speed_per_volt > 0.0:
        limit = min(top, derived.speed_per_volt * voltage)
    spin_up = 0.0
    for k in range(airframe.rotor_count):
        target = min(rotors.command[k] * top, limit)
        before = rotors.speed[k]
        error = before - target
        after = target + error * (derived.decay_up if error < 0.0 else derived.decay_down)
        rotors.speed[k] = after
        spin_up += airframe.rotor_direction[k] * (after - before)
    return spin_up * airframe.rotor_inertia / derived.dt


@law
def hub(airframe: Properties, k: int) -> Vec3:
    """Where rotor ``k`` is, FRD [m]."""
    return Vec3(airframe.rotor_x[k], airframe.rotor_y[k], airframe.rotor_z[k])


@law
def velocity_at(at: Vec3, flow: Flow) -> Vec3:
    """Velocity through the air [m/s] of a point of the body, FRD [m]."""
    v, rates = flow.velocity, flow.rates
    return Vec3(
        v.x + rates.y * at.z - rates.z * at.y,
        v.y + rates.z * at.x - rates.x * at.z,
        v.z + rates.x * at.y - rates.y * at.x,
    )


@law
def speed_squared_wrench(rotors: Rotors, airframe: Properties, flow: Flow) -> Wrench:
    """What the rotors do by RotorS' model."""
    k_moment, k_roll = airframe.moment_coefficient, airframe.rolling_moment
    force, torque = ZERO, ZERO
    momentum, shaft = 0.0, 0.0
    for k in range(airframe.rotor_count):
        w, direction, at = rotors.speed[k], airframe.rotor_direction[k], hub(airframe, k)
        thrust = airframe.thrust_coefficient * w * w
        rotors.thrust[k] = thrust
        air = velocity_at(at, flow)
        drag_x = -airframe.rotor_drag * w * air.x
        drag_y = -airframe.rotor_drag * w * air.y
        force += Vec3(drag_x, drag_y, -thrust)
        torque += Vec3(
            -at.y * thrust - at.z * drag_y - k_roll * w * air.x,
            at.x * thrust + at.z * drag_x - k_roll * w * air.y,
            direction * k_moment * thrust + at.x * drag_y - at.y * drag_x,
        )
        momentum += direction * w
        shaft += k_moment * thrust * w
    # Gyroscopic torque: a counter-clockwise rotor's momentum points up, so that the sum is (0, 0, -h).
    h = momentum * airframe.rotor_inertia
    rotors.power = shaft / airframe.efficiency
    return Wrench(force, Vec3(torque.x + flow.rates.y * h, torque.y - flow.rates.x * h, torque.z))


@law
def momentum_wrench(rotors: Rotors, airframe: Properties, flow: Flow, air: Air, outflow: float) -> Wrench:
    """What the rotors do by the momentum model; ``outflow``: its speed at command 1 [m/s]."""
    expo = airframe.thrust_expo
    half_flow = 0.5 * air.density * airframe.outflow_area
    outflow2 = outflow * outflow
    k_drag = airframe.momentum_drag * air.density_root * math.sqrt(airframe.disc_area)
    force, torque = ZERO, ZERO
    total = 0.0
    for k in range(airframe.rotor_count):
        c, at = rotors.speed[k], hub(airframe, k)
        hub_air = velocity_at(at, flow)
        inflow = max(-hub_air.z, 0.0)
        thrust = half_flow * (outflow2 * c * (1.0 - expo + expo * c) - inflow * inflow)
        rotors.thrust[k] = thrust
        drag = k_drag * math.sqrt(abs(thrust))
        drag_x = -drag * hub_air.x
        drag_y = -drag * hub_air.y
        axial = thrust + drag * hub_air.z
        force += Vec3(drag_x, drag_y, -axial)
        torque += Vec3(
            -at.y * axial - at.z * drag_y,
            at.x * axial + at.z * drag_x,
            airframe.rotor_direction[k] * airframe.yaw_lever * thrust * c + at.x * drag_y - at.y * drag_x,
        )
        total += abs(thrust)
    rotors.power = total * airframe.power_by_thrust
    return Wrench(force, torque)
