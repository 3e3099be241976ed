# SPDX-License-Identifier: BSD-3-Clause
"""MAVSDK 4, as its published examples: no stream is asked for; a plan with rally points, a short flight."""

import json
import sys

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.telemetry import LandedState, Telemetry
from sdk import check, wait

mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
mavsdk.add_any_connection(sys.argv[1])
system = mavsdk.first_autopilot(30.0)
check("autopilot", system is not None)
action, telemetry, mission = Action(system), Telemetry(system), MissionRaw(system)
wait("position", lambda: telemetry.health().is_global_position_ok and telemetry.health().is_home_position_ok, 90.0)
home = telemetry.home()
lat, lon = home.latitude_deg, home.longitude_deg
item = {"autoContinue": True, "type": "SimpleItem", "frame": 3}
plan = {
    "fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
    "geoFence": {"circles": [], "polygons": [], "version": 2},
    "rallyPoints": {"points": [[lat + 1e-3, lon, 50], [lat, lon + 1e-3, 50]], "version": 2},
    "mission": {
        "version": 2, "firmwareType": 12, "vehicleType": 2, "globalPlanAltitudeMode": 1, "cruiseSpeed": 15,
        "hoverSpeed": 5, "plannedHomePosition": [lat, lon, 584],
        "items": [
            {**item, "doJumpId": 1, "command": 22, "params": [15, 0, 0, None, lat, lon, 50]},
            {**item, "doJumpId": 2, "command": 16, "params": [0, 0, 0, None, lat + 1e-3, lon, 50]},
            {**item, "doJumpId": 3, "command": 20, "frame": 2, "params": [0, 0, 0, 0, 0, 0, 0]},
        ],
    },
}  # fmt: skip
imported = mission.import_qgroundcontrol_mission_from_string(json.dumps(plan))
mission.upload_mission(imported.mission_items)
mission.upload_rally_points(imported.rally_items)
check("plan and rally points", len(imported.rally_items) == 2 and len(mission.download_mission()) == 4)
action.arm()
action.set_takeoff_altitude(5.0)
action.takeoff()
wait("at height", lambda: telemetry.position().relative_altitude_m > 4.5)
wait("in the air", lambda: telemetry.landed_state() == LandedState.IN_AIR)
check("battery", telemetry.battery().voltage_v > 10.0)
action.land()
wait("on the ground", lambda: telemetry.landed_state() == LandedState.ON_GROUND, 60.0)
mavsdk.destroy()
