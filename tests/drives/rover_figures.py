# SPDX-License-Identifier: BSD-3-Clause
"""How well an airframe drives with its own parameters: the figures of docs/vehicles.md."""

from __future__ import annotations

import math

import numpy as np

from sitl.simulation import Core
from tests.drives.rover_driver import HOLD, LOITER, VELOCITY, Driver, path_error
from tests.pilots.witness import WAYPOINT, Item

SIDE = {"erle_rover": 20.0, "erle_rover_small": 4.0, "ardupilot_rover": 60.0, "skid_rover": 20.0}
"""A square that suits the vehicle [m]."""


def square(side: float) -> list[tuple[float, float]]:
    """Its corners, the first at the start, to which it returns."""
    return [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side), (0.0, 0.0)]


def eight(radius: float) -> list[tuple[float, float]]:
    """Two circles, each of twelve places."""
    angles = np.linspace(0.0, 2.0 * math.pi, 13)[1:]
    return [(radius * math.sin(a), side * radius * (1.0 - math.cos(a))) for side in (1, -1) for a in angles]


def drive_along(core: Core, frame: str, places: list[tuple[float, float]], estimator: str) -> np.ndarray:
    """What a mission through these places drove."""
    d = Driver(core, frame, estimator=estimator).armed_in()
    start = d.now
    d.start_mission(*(Item(WAYPOINT, place) for place in places))
    d.finish_mission(60.0 + 3.0 * sum(map(math.dist, places, places[1:])) / d.cruise)
    d.wait_until_it_stands()
    return d.since(start)


def outside(rows: np.ndarray, side: float) -> float:
    """Furthest that the square was left to its outside [m]."""
    return float(np.maximum(-rows[:, 1:3], rows[:, 1:3] - side).max())


def figures(core: Core, frame: str) -> dict[str, float]:
    """All of them, by the column of the table."""
    side = SIDE[frame]
    corners = square(side)
    rows = drive_along(core, frame, corners[1:], "truth")
    by_gps = drive_along(core, frame, corners[1:], "ekf")
    places = [(0.0, 0.0), *eight(0.3 * side)]
    d = Driver(core, frame, estimator="truth").armed_in()
    start, v = d.now, d.cruise
    d.stream(12.0, VELOCITY, vx=v)
    speeds = np.hypot(*d.since(start)[:, 4:6].T)
    fast = float(d.since(start)[int(np.argmax(speeds > 0.9 * v)), 0] - start)
    stops = []
    for mode in (LOITER, HOLD):
        d = Driver(core, frame, estimator="truth").armed_in()
        d.get_going(seconds=12.0)
        place = d.place
        d.set_mode(mode)
        d.wait_until_it_stands(60.0)
        stops.append(float(np.hypot(*(d.place - place))))
    return {
        "cuts a corner by": max(float(np.hypot(*(rows[:, 1:3] - c).T).min()) for c in corners[1:4]),
        "runs wide by": outside(rows, side),
        "runs wide by, with GPS": outside(by_gps, side),
        "off the eight, RMS": float(
            np.sqrt(np.mean(path_error(drive_along(core, frame, places[1:], "truth"), *places) ** 2))
        ),
        "90 % of the speed after": fast,
        "overshoot": float(speeds.max() / v - 1.0) * 100.0,
        "stops in (LOITER)": stops[0],
        "rolls out (HOLD)": stops[1],
    }
