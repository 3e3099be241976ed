# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle on a bench that turns it as outputs 5 to 8 say, so that sensors can be calibrated (``on_bench``).

Output 5 chooses, as in ArduPilot's simulated calibration frame: below 1100 us it comes to rest; below 1200 us outputs
6 to 8 are roll, pitch and yaw, -180 .. 180 deg at 1000 .. 2000 us; below 1300 us it turns in all directions, one after
the other; from there to 2000 us it turns with 0 to 360 deg/s about the body's axis whose components are outputs 6 to 8,
from 1500 us.
"""

from __future__ import annotations

import math

from ...core.algebra import ZERO, conjugate, multiply, norm, normalise, quat_from_euler, rotate_inverse
from ...core.constants import GRAVITY, TICK_S
from ...core.elementary import atan2, cos, sin
from ...core.kernels import law
from ...core.records import Ints
from ...core.vectors import Euler, Quat, Vec3
from .body import small_rotation
from .records import Body

SWITCH, FIRST, SECOND, THIRD = 4, 5, 6, 7
"""Indices of the outputs."""
ATTITUDE, EVERYWHERE, AXIS, HIGHEST = 1100, 1200, 1300, 2000
STIFFNESS = 6.0
"""[rad/s] for each radian that the attitude is off."""
TIME_CONSTANT = 0.05
"""Of the rates [s]."""
TURN_RATE = math.radians(60.0)


@law
def _angle(pulse: int) -> float:
    return (pulse - 1500) * (math.pi / 500.0)


@law
def _rotation(q: Quat, wanted: Quat) -> Vec3:
    """Rotation vector [rad], body, from one attitude to another, the short way."""
    turn = multiply(conjugate(q), wanted)
    sign = -1.0 if turn.w < 0.0 else 1.0
    axis = sign * Vec3(turn.x, turn.y, turn.z)
    sine = norm(axis)
    if sine < 1e-9:
        return ZERO
    return (2.0 * atan2(sine, sign * turn.w) / sine) * axis


@law
def wanted_rates(q: Quat, pulses: Ints, time_us: int) -> Vec3:
    """Body rates [rad/s] that the outputs ask for."""
    switch, first, second, third = int(pulses[SWITCH]), int(pulses[FIRST]), int(pulses[SECOND]), int(pulses[THIRD])
    if switch < ATTITUDE:
        return ZERO
    if switch < EVERYWHERE:
        wanted = quat_from_euler(Euler(_angle(first), _angle(second), _angle(third)))
        return STIFFNESS * _rotation(q, wanted)
    axis, rate = Vec3(first - 1500.0, second - 1500.0, third - 1500.0), TURN_RATE
    if switch < AXIS:
        t = 1e-6 * time_us
        axis = Vec3(sin(0.5 * t), cos(0.37 * t), sin(0.23 * t + 1.0))
    else:
        rate = 2.0 * math.pi * (switch - AXIS) / (HIGHEST - AXIS)
    size = norm(axis)
    return (rate / size) * axis if size > 0.0 else ZERO


@law
def turn(body: Body, pulses: Ints, time_us: int) -> None:
    """One tick on the bench; the position stays."""
    wanted = wanted_rates(body.q, pulses, time_us)
    body.rates += (TICK_S / TIME_CONSTANT) * (wanted - body.rates)
    body.rates_mean = body.rates
    body.q = normalise(multiply(body.q, small_rotation(body.rates * TICK_S)))
    body.vel, body.acc_ned = ZERO, ZERO
    body.specific_force = rotate_inverse(body.q, Vec3(0.0, 0.0, -GRAVITY))
