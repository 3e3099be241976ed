# SPDX-License-Identifier: BSD-3-Clause
"""Tyres that scrub: the friction of wheels that slide all the time, as skid steering wants it.

Bullet's own friction holds a tyre that rolls (the steered rovers use it), but of one that slides it turns the force
only slowly into the direction of the sliding: a turn on the spot swings. Here the force of each tyre is friction by
load, against the sliding of its contact point, and fades out below a creep speed, as rubber's does.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from .rover_model import Model

CREEP = 0.1
"""Sliding below this has a force in proportion to it [m/s]."""


def scrub(along: float, across: float, limit: float) -> tuple[float, float]:
    """Force of a tyre on the vehicle, along and across [N].

    Args:
        along: speed of the contact point over the floor, forward [m/s]: that of the hub less that of the rim.
        across: the same to the left.
        limit: friction coefficient times load [N].
    """
    k = -limit / max(math.sqrt(along * along + across * across), CREEP)
    return k * along, k * across


def scrub_all(
    model: Model, state: Sequence[float], zero: float, speeds: Sequence[float], friction: float
) -> tuple[float, float, float, list[float]]:
    """Force of all tyres on the vehicle: forward, to the left [N], turning it to the left [N m], and on each wheel the
    torque that spins it forward [N m].

    Args:
        model: the vehicle.
        state: of its chassis: x, y, z [m], velocity [m/s], rates about forward, left, up [rad/s], then of its forward
            axis the parts along x, y, z, and of its left axis the part along z.
        zero: z at rest [m].
        speeds: of the rims [m/s].
        friction: coefficient.
    """
    _, _, z, vx, vy, vz, rolls, pitches, turns, c, s, rises, leans = state
    plan = model.layout
    forward, leftward, raised = c * vx + s * vy, c * vy - s * vx, z - zero
    fx = fy = turning = 0.0
    torques = [0.0, 0.0, 0.0, 0.0]
    for k, (ahead, aside) in enumerate(plan.wheels):
        spring = plan.sag - raised - ahead * rises - aside * leans
        load = model.stiffness * spring - model.damping * (vz - ahead * pitches + aside * rolls)
        if load <= 0.0:
            continue
        along = forward - aside * turns - speeds[k]
        x, y = scrub(along, leftward + ahead * turns, friction * load)
        fx += x
        fy += y
        turning += ahead * y - aside * x
        torques[k] = -plan.radius * x
    return fx, fy, turning, torques
