# SPDX-License-Identifier: BSD-3-Clause
"""A rover with a lidar follows the wall on its right until it is out of a maze: a loop of a few lines.

Scans come as OBSTACLE_DISTANCE, and each step sends speed and turn rate: MAVLink, as to a real rover in GUIDED.

    python examples/rover_wall_following.py

It draws rover_wall_following.png and needs matplotlib.
"""

import numpy as np

from sitl import Simulation
from sitl.client import Client

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

KEEP_M, AHEAD_M = 2.5, 3.5
"""Distance from the wall, and the free distance ahead below which it turns to the left."""
SPEED_M_S, TURN_DEG_S = 1.2, 40.0
STEP_S, LIMIT_S = 0.1, 500.0
EXIT_Y_M = -36.0
"""South of this it is outside."""


def steer(angles: np.ndarray, ranges: np.ndarray) -> tuple[float, float]:
    """Speed [m/s] and turn rate [deg/s, clockwise] for a scan: angles [deg, clockwise from ahead], ranges [m]."""
    ahead = ranges[abs(angles) < 20].min()
    right = ranges[(angles > 50) & (angles < 130)].min()
    if ahead < AHEAD_M:
        return 0.5 * SPEED_M_S, -TURN_DEG_S
    return SPEED_M_S, float(np.clip(8.0 * (right - KEEP_M), -TURN_DEG_S, TURN_DEG_S))


def main() -> None:
    """Drive, and draw the path in the maze."""
    rover = Client(Simulation("erle_rover", world="maze_erlerover", seed=1))
    rover.wait_ready()
    rover.set_mode("GUIDED")
    rover.arm()
    body, obstacles = rover.simulation.v.physics.body, rover.simulation.v.physics.obstacles
    positions, begin = [], rover.now
    with rover.messages("OBSTACLE_DISTANCE", rate_hz=1 / STEP_S) as scans:
        rover.delay(0.5)
        while rover.now < begin + LIMIT_S and -body.pos.y > EXIT_Y_M:
            scan = scans[-1]
            ranges = np.array(scan.distances) * 0.01
            angles = scan.angle_offset + scan.increment_f * np.arange(len(ranges))
            speed, turn = steer(angles, ranges)
            rover.set_velocity(speed, 0, yaw_rate=turn, body=True)
            rover.delay(STEP_S)
            positions.append((body.pos.x, -body.pos.y))  # the world's x is north, y is west
    path = np.array(positions)
    metres = np.hypot(*np.diff(path, axis=0).T).sum()
    found = "out" if path[-1, 1] <= EXIT_Y_M else "not out"
    print(f"{found} after {metres:.0f} m and {rover.now - begin:.0f} s, walls hit: {obstacles.hit_count}")

    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    for solid in rover.simulation.world.solids:
        axes.fill(*solid.footprint().T, color="0.3")
    axes.plot(*path.T)
    axes.plot(*path[0], "o", color="tab:orange")
    axes.annotate(" start", path[0], va="bottom")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.savefig("rover_wall_following.png", dpi=80)


if __name__ == "__main__":
    main()
