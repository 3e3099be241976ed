# SPDX-License-Identifier: BSD-3-Clause
"""Flights of the library's missions, and those of the recordings of a real ArduPilot."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from . import tree
from .pilot import Item, Pilot

HOME = (-35.363262, 149.165237, 584.0, 0.0)
COPTER_SQUARE = [(-353629926, 1491652371), (-353629926, 1491655676), (-353632621, 1491655676), (-353632621, 1491652371)]
ROVER_SQUARE = [(-353630824, 1491652371), (-353630824, 1491654574), (-353632621, 1491654574), (-353632621, 1491652371)]
POSITION, VELOCITY = 0xDF8, 0xDC7
SPLINE = 82
"""A command that vehicles do not take: flown as waypoints here."""
WINDY = ("copter/square", "copter/survey", "copter/circles")
WIND = {"SIM_WIND_SPD": 5.0, "SIM_WIND_DIR": 120.0, "SIM_WIND_TURB": 1.0}
ON_OTHER_PHYSICS = {
    "pybullet": ("copter/square", "copter/office_route", "rover/square", "rover/maze_route"),
    "jsbsim": ("copter/square", "copter/spline_figure"),
}


def mission(name: str, seed: int = 1, params: dict[str, float] | None = None, **options: Any) -> Pilot:
    """A mission of the library."""
    row = tree.library()[name]
    items = [Item(**item) for item in tree.mission_items(row["path"])]
    items = [item._replace(command=16) if item.command == SPLINE else item for item in items]
    places = {key: row[key] for key in ("world", "start") if key in row}
    params = {**row.get("params", {}), **(params or {})}
    no_home = items[0].x == 0 and items[0].y == 0
    home = None if no_home else (items[0].x * 1e-7, items[0].y * 1e-7, items[0].z, 0.0)
    pilot = Pilot(row["frame"], name.partition("/")[0], seed=seed, home=home, params=params, **places, **options)
    if no_home:
        lat, lon, alt, _ = pilot.simulation.home
        items[0] = Item(16, round(lat * 1e7), round(lon * 1e7), alt, frame=0)
    pilot.boot()
    pilot.fly_mission(items)
    return pilot


def copter_guided(**options: Any) -> Pilot:
    """The recorded GUIDED script: up, 20 m north, 3 m/s east, stop, yaw three times, RTL."""
    pilot = Pilot("ardupilot_quad", home=HOME, **options)
    pilot.hover()
    pilot.target(POSITION, x=20.0, z=-10.0)
    pilot.fly(15.0)
    pilot.stream(10.0, VELOCITY, vy=3.0)
    pilot.stream(6.0, VELOCITY)
    for angle, rate, way, relative in ((0, 0, -1, 0), (90, 0, 1, 0), (45, 30, 1, 1)):
        pilot.command(115, angle, rate, way, relative)
        pilot.fly(8.0)
    pilot.set_mode("RTL")
    pilot.fly(90.0, lambda: not pilot.armed)
    return pilot


def copter_auto(**options: Any) -> Pilot:
    """The recorded AUTO square."""
    pilot = Pilot("ardupilot_quad", home=HOME, **options)
    pilot.boot()
    corners = [Item(16, lat, lon, 10.0) for lat, lon in COPTER_SQUARE]
    pilot.fly_mission([Item(16, -353632621, 1491652371, 584.0, frame=0), Item(22, z=10.0), *corners, Item(21)])
    return pilot


def rover_drive(**options: Any) -> Pilot:
    """The recorded drive: velocity, silence, two places, HOLD, a square, HOLD at speed, RTL."""
    pilot = Pilot("ardupilot_rover", "rover", home=HOME, **options)
    pilot.boot()
    pilot.arm()
    pilot.stream(10.0, VELOCITY, vx=2.0)
    pilot.fly(8.0)
    for x, y in ((26.555, 19.267), (0.0, 0.0)):
        pilot.target(POSITION, x=x, y=y)
        pilot.fly(20.0)
    pilot.set_mode("HOLD", 4.0)
    pilot.upload([Item(16, *ROVER_SQUARE[-1], 584.0, frame=0), *(Item(16, lat, lon) for lat, lon in ROVER_SQUARE)])
    pilot.set_mode("AUTO", 45.0)
    pilot.set_mode("GUIDED")
    pilot.stream(6.0, VELOCITY, vx=2.0)
    pilot.set_mode("HOLD", 6.0)
    pilot.set_mode("RTL", 25.0)
    return pilot


def flights() -> dict[str, Callable[[], Pilot]]:
    """All of them, by name."""
    found: dict[str, Callable[[], Pilot]] = {}
    for name in tree.library():
        found[f"native/mission/{name}"] = partial(mission, name)
    for name in WINDY:
        found[f"native/mission/{name}-wind"] = partial(mission, name, 2, WIND)
    for physics, names in ON_OTHER_PHYSICS.items():
        for name in names:
            found[f"{physics}/mission/{name}"] = partial(mission, name, physics=physics)
    scripts = {"copter_guided": copter_guided, "copter_auto": copter_auto, "rover": rover_drive}
    for name, script in scripts.items():
        for estimator in ("ekf", "truth"):
            found[f"native/recorded/{name}-{estimator}"] = partial(script, estimator=estimator)
    return found
