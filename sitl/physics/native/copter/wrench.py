# SPDX-License-Identifier: BSD-3-Clause
"""What acts on a multicopter in the air: its rotors and aerodynamic drag."""

from __future__ import annotations

from ....core.algebra import by_component, cross, rotate_inverse
from ....core.kernels import law
from ....core.vectors import Vec3
from ....vehicles.properties.multicopter import THRUST_MOMENTUM, Properties
from ..body import Wrench
from .rotors import Flow, lag, momentum_wrench, speed_squared_wrench
from .state import Physics


@law
def add_air(wrench: Wrench, spin_up: float, flow: Flow, airframe: Properties, density: float) -> Wrench:
    """The rotors' wrench and their yaw torque of spinning up [N m], with what air of a density [kg/m^3] does to the
    airframe.
    """
    f, m, v, rates = wrench.force, wrench.torque, flow.velocity, flow.rates
    area, inertia = airframe.drag_area, airframe.inertia
    half, damping = 0.5 * density, airframe.angular_damping
    force = Vec3(
        f.x - half * area.x * v.x * abs(v.x),
        f.y - half * area.y * v.y * abs(v.y),
        f.z - half * area.z * v.z * abs(v.z),
    )
    torque = Vec3(
        m.x - damping * inertia.x * rates.x,
        m.y - damping * inertia.y * rates.y,
        m.z + (spin_up - damping * inertia.z * rates.z),
    )
    if airframe.gyroscopic == 0:
        torque += cross(rates, by_component(inertia, rates))  # what ``fly`` will take away
    return Wrench(force, torque)


@law
def act(p: Physics) -> Wrench:
    """All that acts on the body but gravity and ground; rotors move on by a substep."""
    airframe, body, rotors, voltage = p.airframe, p.body, p.rotors, p.battery.voltage
    spin_up = lag(rotors, airframe, p.derived, voltage)
    flow = Flow(rotate_inverse(body.q, body.vel - p.wind.vel), body.rates)
    if airframe.thrust_model == THRUST_MOMENTUM:
        outflow = airframe.outflow_speed_max * voltage * p.derived.voltage_scale
        wrench = momentum_wrench(rotors, airframe, flow, p.air, outflow)
    else:
        wrench = speed_squared_wrench(rotors, airframe, flow)
    wrench = add_air(wrench, spin_up, flow, airframe, p.air.density)
    if p.shove.until_us == 0 and p.shove.twist_until_us == 0:
        return wrench
    return pushed(wrench, p)


@law
def pushed(wrench: Wrench, p: Physics) -> Wrench:
    """What acts on the body besides, while something pushes or twists it."""
    force, torque = wrench.force, wrench.torque
    if p.shove.until_us != 0:
        force += p.shove.accel / p.derived.inverse_mass
    if p.shove.twist_until_us != 0:
        torque += by_component(p.airframe.inertia, p.shove.twist)
    return Wrench(force, torque)
