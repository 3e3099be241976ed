# SPDX-License-Identifier: BSD-3-Clause
"""A multicopter as a JSBSim aircraft: rotors as a system, their and the air's forces as aerodynamics, four legs.

The formulas are those of ``sitl.physics.native.copter`` (RotorS' model and the momentum model), evaluated by JSBSim
with its own air. Inputs are properties ``rotor/command1`` .. [0 .. 1] and ``battery/voltage`` [V];
SI units throughout, but for the forces, which JSBSim takes in pounds.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from ...core.constants import GRAVITY
from ...vehicles.properties.multicopter import THRUST_MOMENTUM
from ..native.prepare import decay
from .aircraft import Contact, written
from .formula import component, difference, function, greatest, if_less, least, magnitude, product, root, total
from .model import FOOT, POUND, POUND_FOOT, SLUG_BY_FOOT3

GOES = "rotor/goes"
"""Property: 1, or 0 while the rotors keep their speeds."""
ROTOR_HEIGHT = 0.02
"""Of rotors over their hubs [m]: what a vehicle that fell over lies on."""
P, Q, R = "velocities/p-rad_sec", "velocities/q-rad_sec", "velocities/r-rad_sec"


def document(a: Any, name: str, dt: float) -> str:
    """The aircraft of a multicopter's properties, for steps of dt [s]."""
    count = int(a.rotor_count)
    inputs = [f"rotor/command{k}" for k in range(1, count + 1)]
    properties = "".join(f'<property value="0">{name}</property>' for name in [*inputs, "battery/voltage", GOES])
    system = f'<system name="rotors">{properties}<channel name="rotors">{_speeds(a, dt)}</channel></system>'
    return written(a, name, 2.0 * reach(a), legs(a), system + _aerodynamics(a, dt))


def reach(a: Any) -> float:
    """Of the rotors' hubs from the middle, on average [m]."""
    count = int(a.rotor_count)
    return sum(math.hypot(a.rotor_x[k], a.rotor_y[k]) for k in range(count)) / count


def height(a: Any) -> float:
    """Of the centre of mass over the feet [m]: with more lean than the tip angle it is beyond two of them."""
    return math.sqrt(0.5) * reach(a) / math.tan(min(max(float(a.tip_angle), 0.2), 1.5))


def legs(a: Any) -> list[Contact]:
    """Four feet in a square that reaches as far as the hubs, and four points on top for a vehicle that fell over.

    Springs and dampers take up an impact in the leg's time constant (critically damped); they are longer by what the
    weight presses them together.
    """
    mass, tau, half = float(a.mass), max(float(a.leg_time_constant), 0.01), math.sqrt(0.5) * reach(a)
    stiffness, damping = 0.25 * mass / (tau * tau), 0.5 * mass / tau
    give = GRAVITY * tau * tau
    corners = [(half, half), (-half, half), (half, -half), (-half, -half)]
    friction = float(a.ground_friction)
    feet = [(x, y, height(a) + give) for x, y in corners]
    highest = min(float(a.rotor_z[k]) for k in range(int(a.rotor_count))) - ROTOR_HEIGHT
    tops = [(x, y, highest) for x, y in corners]
    named = [(f"foot{k}", at) for k, at in enumerate(feet, 1)] + [(f"top{k}", at) for k, at in enumerate(tops, 1)]
    return [Contact(name, at, stiffness, damping, friction) for name, at in named]


def _each(a: Any, term: Callable[[int], str]) -> str:
    """The sum of a term over the rotors."""
    return total(*(term(k) for k in range(int(a.rotor_count))))


def _speeds(a: Any, dt: float) -> str:
    """Components: speed and thrust of each rotor."""
    is_flow = int(a.thrust_model) == THRUST_MOMENTUM
    top = 1.0 if is_flow else float(a.speed_max)
    up, down = decay(float(a.time_constant_up), dt), decay(float(a.time_constant_down), dt)
    out = ""
    for k in range(1, int(a.rotor_count) + 1):
        speed, target = f"rotor/speed{k}", product(f"rotor/command{k}", top)
        if float(a.speed_voltage) > 0.0:
            target = least(target, product("battery/voltage", top / float(a.speed_voltage)))
        if up == 0.0 and down == 0.0:
            out += component(speed, target)
        else:
            out += component(f"rotor/target{k}", target)
            share = if_less(speed, f"rotor/target{k}", 1.0 - up, 1.0 - down)
            out += component(f"rotor/change{k}", product(difference(f"rotor/target{k}", speed), share, GOES))
            out += component(speed, total(speed, f"rotor/change{k}"))
        if not is_flow:
            factor = float(a.thrust_coefficient)
            out += component(f"rotor/thrust{k}", product(speed, speed, factor))
    return out


def _aerodynamics(a: Any, dt: float) -> str:
    """Forces and torques on the body."""
    flow = int(a.thrust_model) == THRUST_MOMENTUM
    out = "".join(function(f"air/{axis}", product(f"velocities/{axis}-aero-fps", FOOT)) for axis in "uvw") + function(
        "air/half-density", product("atmosphere/rho-slugs_ft3", 0.5 * SLUG_BY_FOOT3)
    )
    out += _momentum_hubs(a) if flow else _speed_squared_hubs(a)
    damping = [-float(a.angular_damping) * inertia for inertia in a.inertia]
    spins = [float(a.rotor_direction[k]) for k in range(int(a.rotor_count))]
    lag = float(a.time_constant_up) > 0.0 or float(a.time_constant_down) > 0.0
    inertia = float(a.rotor_inertia)
    # A counter-clockwise rotor's momentum points up: the sum is (0, 0, -h).
    momentum = "" if flow else product(_each(a, lambda k: product(f"rotor/speed{k + 1}", spins[k])), inertia)
    spin_up = _each(a, lambda k: product(f"rotor/change{k + 1}", spins[k], inertia / dt)) if lag else ""
    drag = [_drag(float(area), f"air/{axis}") for axis, area in zip("uvw", a.drag_area, strict=True)]
    forces = (
        total(_each(a, lambda k: f"rotor/drag-x{k + 1}"), drag[0]),
        total(_each(a, lambda k: f"rotor/drag-y{k + 1}"), drag[1]),
        total(_each(a, lambda k: product(f"rotor/axial{k + 1}" if flow else f"rotor/thrust{k + 1}", -1.0)), drag[2]),
    )
    roll, pitch, yaw = _rotor_torques(a, flow, spins)
    torques = (
        total(roll, product(Q, momentum) if momentum else "", product(P, damping[0])),
        total(pitch, product(P, momentum, -1.0) if momentum else "", product(Q, damping[1])),
        total(yaw, spin_up, product(R, damping[2])),
    )
    for axis, formula in zip("XYZ", forces, strict=True):
        out += f'<axis name="{axis}">{function(f"force/{axis}", product(formula, 1.0 / POUND))}</axis>'
    for axis, formula in zip(("ROLL", "PITCH", "YAW"), torques, strict=True):
        out += f'<axis name="{axis}">{function(f"torque/{axis}", product(formula, 1.0 / POUND_FOOT))}</axis>'
    return f"<aerodynamics>{out}</aerodynamics>"


def _drag(area: float, speed: str) -> str:
    return product("air/half-density", speed, magnitude(speed), -area)


def _hub(a: Any, k: int) -> tuple[str, str]:
    """Air velocity (x, y) at hub ``k`` [m/s]."""
    x, y, z = float(a.rotor_x[k]), float(a.rotor_y[k]), float(a.rotor_z[k])
    return (
        total("air/u", product(Q, z), product(R, -y)),
        total("air/v", product(R, x), product(P, -z)),
    )


def _speed_squared_hubs(a: Any) -> str:
    """Functions: what a rotor meets in its plane; its drag; the power of all."""
    out = ""
    for k in range(int(a.rotor_count)):
        for axis, formula in zip("xy", _hub(a, k), strict=True):
            out += function(f"rotor/hub-{axis}{k + 1}", formula)
            drag = product(f"rotor/speed{k + 1}", f"rotor/hub-{axis}{k + 1}", -float(a.rotor_drag))
            out += function(f"rotor/drag-{axis}{k + 1}", drag)
    shaft = _each(a, lambda k: product(f"rotor/thrust{k + 1}", f"rotor/speed{k + 1}"))
    return out + function("rotor/power", product(shaft, float(a.moment_coefficient) / float(a.efficiency)))


def _momentum_hubs(a: Any) -> str:
    """Functions: thrust of each rotor from outflow and inflow, its momentum drag; the power of all."""
    expo, full = float(a.thrust_expo), float(a.outflow_speed_max) / float(a.battery_voltage_full)
    out = function("rotor/fastest", product("battery/voltage", full))
    # rho / 2 is at hand: the root of rho is that of twice as much.
    factor = float(a.momentum_drag) * math.sqrt(2.0 * float(a.disc_area))
    out += function("rotor/drag-factor", product(root("air/half-density"), -factor))
    for k in range(int(a.rotor_count)):
        n, x, y = k + 1, float(a.rotor_x[k]), float(a.rotor_y[k])
        speed, thrust, drag = f"rotor/speed{n}", f"rotor/thrust{n}", f"rotor/drag{n}"
        out += function(f"rotor/hub-z{n}", total("air/w", product(P, y), product(Q, -x)))
        out += function(f"rotor/inflow{n}", greatest(product(f"rotor/hub-z{n}", -1.0), 0.0))
        outflow = product("rotor/fastest", "rotor/fastest", speed, total(1.0 - expo, product(speed, expo)))
        left = difference(outflow, product(f"rotor/inflow{n}", f"rotor/inflow{n}"))
        out += function(thrust, product("air/half-density", left, float(a.outflow_area)))
        out += function(drag, product("rotor/drag-factor", root(magnitude(thrust))))
        for axis, formula in zip("xy", _hub(a, k), strict=True):
            out += function(f"rotor/drag-{axis}{n}", product(drag, formula))
        out += function(f"rotor/axial{n}", difference(thrust, product(drag, f"rotor/hub-z{n}")))
    spent = _each(a, lambda k: magnitude(f"rotor/thrust{k + 1}"))
    return out + function("rotor/power", product(spent, float(a.power_by_thrust)))


def _rotor_torques(a: Any, flow: bool, spins: list[float]) -> tuple[str, str, str]:
    """Torques of thrust, drag, rolling moment and reaction [N m]."""
    axial = "rotor/axial" if flow else "rotor/thrust"
    rolling = 0.0 if flow else -float(a.rolling_moment)

    def roll(k: int) -> str:
        arm = product(f"{axial}{k + 1}", -float(a.rotor_y[k]))
        return total(arm, product(f"rotor/drag-y{k + 1}", -float(a.rotor_z[k])), _rolling(k, "x"))

    def pitch(k: int) -> str:
        arm = product(f"{axial}{k + 1}", float(a.rotor_x[k]))
        return total(arm, product(f"rotor/drag-x{k + 1}", float(a.rotor_z[k])), _rolling(k, "y"))

    def _rolling(k: int, axis: str) -> str:
        return product(f"rotor/speed{k + 1}", f"rotor/hub-{axis}{k + 1}", rolling)

    def yaw(k: int) -> str:
        n = k + 1
        if flow:
            reaction = product(f"rotor/thrust{n}", f"rotor/speed{n}", spins[k] * float(a.yaw_lever))
        else:
            reaction = product(f"rotor/thrust{n}", spins[k] * float(a.moment_coefficient))
        across = product(f"rotor/drag-y{n}", float(a.rotor_x[k]))
        return total(reaction, across, product(f"rotor/drag-x{n}", -float(a.rotor_y[k])))

    return _each(a, roll), _each(a, pitch), _each(a, yaw)
