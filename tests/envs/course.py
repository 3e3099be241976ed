# SPDX-License-Identifier: BSD-3-Clause
"""Drives a Turtlebot along corners with the paper's three actions, as a person would by keyboard."""

from __future__ import annotations

import math

FORWARD, LEFT, RIGHT = 0, 1, 2
CIRCUIT2 = [(3.9, 0.0), (3.9, -3.8), (0.28, -3.8), (0.28, -7.65), (-3.7, -7.65), (-3.7, 0.0), (0.0, 0.0)]
"""Corners of the middle of circuit2's corridors, x and y [m], from the start round to it."""


def bearing_error(pose, corner):
    """How far to the left of the robot's heading the corner lies [rad]."""
    x, y, _, yaw = pose
    return math.remainder(math.atan2(corner[1] - y, corner[0] - x) - yaw, 2.0 * math.pi)


def drive(env, corners, near=0.3, most=600):
    """Go from corner to corner. Returns the steps, the sum of rewards, and which way it turned at each corner."""
    turns, steps, total = [], 0, 0.0
    for corner in corners:
        while True:
            pose = env.unwrapped.robot.pose[0].tolist()
            if math.dist(pose[:2], corner) < near:
                break
            error = bearing_error(pose, corner)
            action = FORWARD if abs(error) < 0.15 else LEFT if error > 0.0 else RIGHT
            if abs(error) > 0.8 and (not turns or turns[-1][1] != corner):
                turns.append(("left" if error > 0.0 else "right", corner))
            _, reward, terminated, truncated, _ = env.step(action)
            steps, total = steps + 1, total + reward
            assert not terminated, f"crashed at {pose} on the way to {corner}"
            assert not truncated and steps < most
    return steps, total, [way for way, _ in turns]
