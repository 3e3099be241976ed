# SPDX-License-Identifier: BSD-3-Clause
"""Takes a vehicle from place to place by velocity set-points, as an agent that knows its pose would."""

from __future__ import annotations

import math


def go(env, places, action_of, near, most):
    """From place to place; returns the steps. Fails on a crash and after ``most`` steps."""
    steps = 0
    for place in places:
        while True:
            x, y, _, yaw = env.unwrapped.robot.pose[0].tolist()
            distance = math.dist((x, y), place)
            if distance < near:
                break
            bearing = math.remainder(math.atan2(place[1] - y, place[0] - x) - yaw, 2.0 * math.pi)
            _, _, terminated, _, info = env.step(action_of(distance, bearing))
            assert not terminated, f"{info} at {x:.1f}, {y:.1f} on the way to {place}"
            steps += 1
            assert steps < most
    return steps
