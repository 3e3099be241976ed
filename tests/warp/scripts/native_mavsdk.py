# SPDX-License-Identifier: BSD-3-Clause
"""An ordinary MAVSDK 4.x script: python native_mavsdk.py PORT. Prints what it measured, as JSON, all by
its own clock.
"""

import json
import sys
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.info import Info
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.offboard import Offboard, VelocityNedYaw
from mavsdk.plugins.telemetry import Telemetry

measured = {}
sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
sdk.add_any_connection(f"tcpout://127.0.0.1:{sys.argv[1]}")
system = sdk.first_autopilot(10.0)
action, telemetry, info = Action(system), Telemetry(system), Info(system)
offboard, mission = Offboard(system), MissionRaw(system)

action.arm()
item = MissionItem
items = [item(n, 3, 16, int(n == 0), 1, 0, 0, 0, float("nan"), 473977420, 85455940, 10.0, 0) for n in range(5)]
start = time.monotonic()
mission.upload_mission(items)
measured["upload_s"] = time.monotonic() - start

offboard.set_velocity_ned(VelocityNedYaw(1.0, 0.0, 0.0, 0.0))
offboard.start()
time.sleep(10)
measured["speed_factor"] = info.get_speed_factor()
offboard.stop()

time.sleep(5)
start = time.monotonic()
try:
    action.land()  # the vehicle does not answer
    measured["land"] = "answered"
except Exception as error:
    measured["land"] = str(error)
measured["land_s"] = time.monotonic() - start

try:
    action.terminate()  # the vehicle falls silent here
except Exception as error:
    measured["terminate"] = str(error)
start = time.monotonic()
while system.is_connected() and time.monotonic() - start < 20:
    time.sleep(0.05)
measured["lost_s"] = time.monotonic() - start
print(json.dumps(measured), flush=True)
sdk.destroy()
