# SPDX-License-Identifier: BSD-3-Clause
"""The usual DroneKit script: connect, arm, take off, go to, mission, RTL."""

import collections
import collections.abc
import sys
import time

collections.MutableMapping = collections.abc.MutableMapping  # DroneKit 2.9.2 is older than Python 3.10

from dronekit import Command, LocationGlobalRelative, VehicleMode, connect  # noqa: E402


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
check("parameters", len(vehicle.parameters) > 200)
vehicle.parameters["FS_GCS_ENABLE"] = 0
check("parameter", vehicle.parameters["FS_GCS_ENABLE"] == 0)
wait("armable", lambda: vehicle.is_armable, 90.0)
check("version", vehicle.version.major == 4, vehicle.version)
commands = vehicle.commands
commands.download()
commands.wait_ready()
check("home", vehicle.home_location is not None)

vehicle.mode = VehicleMode("GUIDED")
wait("GUIDED", lambda: vehicle.mode.name == "GUIDED", 5.0)
vehicle.armed = True
wait("armed", lambda: vehicle.armed, 5.0)
vehicle.simple_takeoff(10)
wait("at height", lambda: vehicle.location.global_relative_frame.alt > 9.7)
start = vehicle.location.global_relative_frame
vehicle.simple_goto(LocationGlobalRelative(start.lat + 1e-4, start.lon, 12), groundspeed=4)
wait("there", lambda: abs(vehicle.location.global_relative_frame.lat - start.lat - 1e-4) < 4e-6)
north = vehicle.message_factory.set_position_target_local_ned_encode(
    0, 0, 0, 1, 0b0000111111000111, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0
)
for _ in range(4):
    vehicle.send_mavlink(north)
    time.sleep(1)
check("velocity", abs(vehicle.velocity[0] - 2.0) < 0.3, vehicle.velocity)

commands.clear()
for number, lat, height in ((22, 0, 10), (16, start.lat + 1e-4, 10), (16, start.lat, 10), (16, start.lat, 10)):
    commands.add(Command(0, 0, 0, 3, number, 0, 0, 0, 0, 0, 0, lat, start.lon if lat else 0, height))
commands.upload()
commands.download()
commands.wait_ready()
check("mission", commands.count == 4, commands.count)
vehicle.mode = VehicleMode("AUTO")
wait("on the way to item 3", lambda: commands.next == 3, 40.0)
vehicle.mode = VehicleMode("RTL")
wait("disarmed", lambda: not vehicle.armed, 90.0)
vehicle.close()
