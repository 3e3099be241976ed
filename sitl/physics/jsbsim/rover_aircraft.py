# SPDX-License-Identifier: BSD-3-Clause
"""A rover as a JSBSim aircraft that never takes off: four wheels on springs, and the force of its motors.

Wheels roll freely (rolling resistance is in the motor's law) and hold sideways as far as the airframe's grip. The
motors push where the driven wheels stand, in proportion to what the wheels roll faster than the ground goes by, up to
the grip of the driven wheels.

Inputs are properties ``drive/speed1`` and, skid-steered, ``drive/speed2`` [m/s], and the wheels' steering angles.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from ...core.constants import GRAVITY
from ...vehicles.properties.ground_vehicle import STEERING_FRONT_WHEELS, STEERING_SKID
from .aircraft import Contact, location, written
from .formula import difference, function, limited, product, total
from .model import FOOT, POUND

SPRING_RATE = 20.0
"""Natural frequency of the body on its springs [rad/s]."""
SPRING_DAMPING = 0.7
"""Of critical."""
SLIP_TIME = 0.01
"""In which the driven wheels bring the vehicle to their speed, while they grip [s]."""
FRONT_LEFT, FRONT_RIGHT = 0, 1
"""Numbers of the wheels that steer."""


class Layout(NamedTuple):
    """Where the wheels are."""

    wheelbase: float
    """[m]"""
    half_track: float
    """[m]"""
    rear: float
    """From the rear axle forward to the centre of mass [m]."""
    ahead: float
    """From the origin of the body forward to the centre of mass [m]."""
    height: float
    """Of the centre of mass over the floor [m]."""


def layout(a: Any) -> Layout:
    """Of a rover's properties.

    A turning circle needs no wheelbase: without one it is that of the car which turns on it with its wheels at the
    steering angle. A skid-steered rover without one is as long as it is wide. Both have their weight in the middle.
    """
    track, wheelbase, model = float(a.track), float(a.wheelbase), int(a.steering_model)
    if wheelbase <= 0.0:
        circle = 0.5 * float(a.turning_diameter) * math.tan(float(a.steering_angle))
        wheelbase = track if model == STEERING_SKID else circle
    radius = float(a.wheel_radius) or wheelbase / 6.0
    height = float(a.centre_height) or 1.5 * radius
    if model == STEERING_SKID:
        return Layout(wheelbase, 0.5 * track, 0.5 * wheelbase, 0.0, height)
    rear = wheelbase * (float(a.front_load) if model == STEERING_FRONT_WHEELS else 0.5)
    return Layout(wheelbase, 0.5 * track, rear, rear - float(a.rear_axle), height)


def document(a: Any, name: str, dt: float) -> str:
    """The aircraft of a rover's properties."""
    at = layout(a)
    names = ("drive/speed1", "drive/speed2")
    inputs = "".join(f'<property value="0">{name}</property>' for name in names)
    nothing = f'<aerodynamics><axis name="X">{function("air/none", 0.0)}</axis></aerodynamics>'
    parts = f'<system name="drive">{inputs}</system>{_drive(a, at)}{nothing}'
    return written(a, name, 2.0 * at.half_track, wheels(a, at), parts)


def wheels(a: Any, at: Layout) -> list[Contact]:
    """Front left and right, rear left and right; springs as stiff as their load."""
    mass, share = float(a.mass), at.rear / at.wheelbase
    give = GRAVITY / (SPRING_RATE * SPRING_RATE)
    out = []
    for end, x, load in (("front", at.wheelbase - at.rear, share), ("rear", -at.rear, 1.0 - share)):
        for side, y in (("left", -at.half_track), ("right", at.half_track)):
            stiffness = 0.5 * load * mass * SPRING_RATE * SPRING_RATE
            damping = load * mass * SPRING_DAMPING * SPRING_RATE
            scrubs = int(a.steering_model) == STEERING_SKID
            at_floor, grip, steers = (x, y, at.height + give), float(a.grip), end == "front" and not scrubs
            out.append(Contact(f"{end}-{side}", at_floor, stiffness, damping, grip, True, scrubs, steers))
    return out


def _drive(a: Any, at: Layout) -> str:
    """The force of the motors: of all driven wheels, or of the left and the right side."""
    mass, bound = float(a.mass), float(a.grip) * float(a.driven_load) * GRAVITY * float(a.mass)
    forward = product("velocities/u-fps", FOOT)
    if int(a.steering_model) != STEERING_SKID:
        both = _force("drive", forward, 1, mass, bound, (-at.rear, 0.0, at.height))
        return f"<external_reactions>{both}</external_reactions>"
    # Wheels scrub: the body turns as if the track were wider.
    lever = at.half_track * float(a.track_slip)
    left = total(forward, product("velocities/r-rad_sec", lever))
    right = total(forward, product("velocities/r-rad_sec", -lever))
    sides = _force("drive-left", left, 1, 0.5 * mass, 0.5 * bound, (0.0, -at.half_track, at.height))
    sides += _force("drive-right", right, 2, 0.5 * mass, 0.5 * bound, (0.0, at.half_track, at.height))
    return f"<external_reactions>{sides}</external_reactions>"


def _force(name: str, speed: str, motor: int, mass: float, bound: float, at: tuple[float, float, float]) -> str:
    wanted = product(difference(f"drive/speed{motor}", speed), mass / SLIP_TIME)
    formula = product(limited(wanted, bound), 1.0 / POUND)
    return (
        f'<force name="{name}" frame="BODY">{function(f"force/{name}", formula)}{location(*at)}'
        "<direction><x>1</x><y>0</y><z>0</z></direction></force>"
    )
