# SPDX-License-Identifier: BSD-3-Clause
"""The usual DroneKit script with a rover: connect, arm, go to, velocity, mission, sticks, RTL."""

import collections
import collections.abc
import math
import sys
import time

collections.MutableMapping = collections.abc.MutableMapping  # DroneKit 2.9.2 is older than Python 3.10

from dronekit import Command, LocationGlobalRelative, VehicleMode, connect  # noqa: E402

NORTH_10_M = 0.9e-4


def check(what, ok, seen=""):
    print(f"{'ok' if ok else 'FAILED'}: {what} {seen}", flush=True)
    if not ok:
        sys.exit(1)


def wait(what, condition, seconds=30.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.2)
    check(what, condition())


vehicle = connect(sys.argv[1], wait_ready=True, timeout=60)
check("a rover", vehicle._vehicle_type == 10, vehicle.version)
vehicle.parameters["FS_GCS_ENABLE"] = 0
check("parameter", vehicle.parameters["FS_GCS_ENABLE"] == 0)
wait("armable", lambda: vehicle.is_armable, 90.0)
commands = vehicle.commands
commands.download()
commands.wait_ready()
check("home", vehicle.home_location is not None)


def mode(name):
    vehicle.mode = VehicleMode(name)
    wait(name, lambda: vehicle.mode.name == name, 5.0)


def there(north, seconds):
    wait("there", lambda: abs(vehicle.location.global_relative_frame.lat - start.lat - north) < 2.5e-5, seconds)


mode("GUIDED")
vehicle.armed = True
wait("armed", lambda: vehicle.armed, 5.0)
start = vehicle.location.global_relative_frame
vehicle.simple_goto(LocationGlobalRelative(start.lat + NORTH_10_M, start.lon, 0), groundspeed=1)
there(NORTH_10_M, 40.0)
north = vehicle.message_factory.set_position_target_local_ned_encode(
    0, 0, 0, 1, 0b0000110111000111, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0
)
for _ in range(6):
    vehicle.send_mavlink(north)
    time.sleep(1)
check("velocity", math.dist(vehicle.velocity[:2], (1.0, 0.0)) < 0.2, vehicle.velocity)
check("ground speed", abs(vehicle.groundspeed - 1.0) < 0.2, vehicle.groundspeed)

commands.clear()
for number, lat in ((16, 2 * NORTH_10_M), (16, 0.0), (20, None)):
    place = (0, 0) if lat is None else (start.lat + lat, start.lon)
    commands.add(Command(0, 0, 0, 3, number, 0, 0, 0, 0, 0, 0, *place, 0))
commands.upload()
commands.download()
commands.wait_ready()
check("mission", commands.count == 3, commands.count)
mode("AUTO")
wait("on the way to item 2", lambda: commands.next == 2, 60.0)
mode("MANUAL")
for _ in range(4):  # DroneKit sends them once; they hold for RC_OVERRIDE_TIME, 3 s
    vehicle.channels.overrides = {"1": 1500, "3": 1700}
    time.sleep(1)
check("sticks", vehicle.groundspeed > 0.4, vehicle.groundspeed)
vehicle.channels.overrides = {}
mode("RTL")
there(0.0, 60.0)
mode("HOLD")
vehicle.armed = False
wait("disarmed", lambda: not vehicle.armed, 5.0)
vehicle.close()
