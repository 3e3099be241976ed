# SPDX-License-Identifier: BSD-3-Clause
"""The usual DroneKit script: connect, arm, take off, go to three positions, come home.

    sitl exec --speedup max -- python examples/dronekit_goto.py        (CONNECTION: udpin:0.0.0.0:14550)

It draws dronekit_goto.png and needs dronekit, future (which DroneKit imports) and matplotlib.
"""

import collections
import collections.abc
import functools
import sys
import time

collections.MutableMapping = collections.abc.MutableMapping  # DroneKit 2.9.2 is older than Python 3.10

try:
    import matplotlib.pyplot as plt
    from dronekit import LocationGlobalRelative, VehicleMode, connect
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib dronekit future") from None

POSITIONS = ((2.5e-4, 0.0, 10.0), (2.5e-4, 3e-4, 20.0), (0.0, 3e-4, 10.0))
"""Latitude, longitude [deg] from home, height above home [m]."""


def wait(what: str, condition, seconds: float) -> None:
    """Wait until ``condition()`` holds; SystemExit when it does not come true in time."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise SystemExit(f"gave up after {seconds:.0f} s: {what}")
        time.sleep(0.2)
    print(what, flush=True)


def is_near(vehicle, goal) -> bool:
    """Whether the vehicle is within about a metre of a position."""
    here = vehicle.location.global_relative_frame
    return abs(here.lat - goal.lat) + abs(here.lon - goal.lon) < 1e-5 and abs(here.alt - goal.alt) < 1


def main() -> None:
    """Fly, and draw the flight."""
    vehicle = connect(sys.argv[1] if len(sys.argv) > 1 else "udpin:0.0.0.0:14550", wait_ready=True, timeout=60)
    wait("ready to arm", lambda: vehicle.is_armable, 90)
    home, positions = vehicle.location.global_frame, []
    vehicle.add_attribute_listener(
        "location.local_frame", lambda _vehicle, _name, p: positions.append((p.east, p.north, -p.down))
    )
    vehicle.mode = VehicleMode("GUIDED")
    wait("GUIDED", lambda: vehicle.mode.name == "GUIDED", 5)
    vehicle.armed = True
    wait("armed", lambda: vehicle.armed, 5)
    vehicle.simple_takeoff(10)
    wait("at height", lambda: vehicle.location.global_relative_frame.alt > 9.7, 30)
    for north, east, height in POSITIONS:
        goal = LocationGlobalRelative(home.lat + north, home.lon + east, height)
        vehicle.simple_goto(goal, groundspeed=6)
        wait(f"{height:.0f} m above {north:g}, {east:g}", functools.partial(is_near, vehicle, goal), 60)
    vehicle.mode = VehicleMode("RTL")
    wait("landed and disarmed", lambda: not vehicle.armed, 120)
    vehicle.close()

    figure = plt.figure(figsize=(5, 4.4), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    axes.plot(*zip(*positions))
    axes.set_box_aspect(None, zoom=0.85)  # room for the labels
    axes.set(xlabel="east [m]", ylabel="north [m]", zlabel="height [m]")
    figure.savefig("dronekit_goto.png", dpi=80)


if __name__ == "__main__":
    main()
