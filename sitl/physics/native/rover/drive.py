# SPDX-License-Identifier: BSD-3-Clause
"""Motors of a rover: throttle to rolling speed of the wheels.

A motor on a voltage runs up to the speed that its throttle stands for as first order (its back-EMF), within what it
can pull; rolling resistance takes its part, so that under load the speed stays a little behind. The battery gives the
force times the speed that the throttle stands for, as of a direct-current motor (its current goes with the force, its
voltage with the throttle); nothing flows back into it.
"""

from __future__ import annotations

from typing import NamedTuple

from ....core.constants import TICK_S
from ....core.kernels import law
from ....vehicles.properties.ground_vehicle import Properties
from .state import Derived

_PER_S = 1.0 / TICK_S


class Drive(NamedTuple):
    """What a motor does in a tick."""

    speed: float
    """Rolling speed of its wheels after it [m/s]."""
    power: float
    """That it takes if it drives the whole vehicle [W]."""


class Pull(NamedTuple):
    """What driven tyres do in a tick."""

    accel: float
    """Along the body [m/s^2]."""
    speed: float
    """Of the driven axle over the ground after it [m/s]."""


@law
def commanded(control: float, scale: float) -> float:
    """Command -1 .. 1 of an actuator control (0 of a NaN)."""
    c = control * scale
    if c > 1.0:
        return 1.0
    if c < -1.0:
        return -1.0
    if c != c:
        return 0.0
    return c


@law
def run(before: float, command: float, airframe: Properties, derived: Derived) -> Drive:
    """A motor follows its command for a tick, from a rolling speed [m/s]."""
    target = command * airframe.speed_max
    step, loss = derived.speed_step, derived.rolling_step
    after = min(max(target + (before - target) * derived.speed_decay, before - step), before + step)
    pull = (after - before) * _PER_S * target
    power = max(pull, 0.0) * derived.power_by_accel + abs(command) * airframe.power_full
    return Drive(after - min(max(after, -loss), loss), power)


@law
def grip_along(before: float, wanted: float, grip: float) -> Pull:
    """Take the vehicle along with its wheels' speed [m/s] as far as driven tyres of a grip [m/s^2] hold."""
    accel = (wanted - before) * _PER_S
    if accel > grip:
        return Pull(grip, before + grip * TICK_S)
    if accel < -grip:
        return Pull(-grip, before + -grip * TICK_S)
    return Pull(accel, wanted)
