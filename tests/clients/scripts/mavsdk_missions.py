# SPDX-License-Identifier: BSD-3-Clause
"""Missions by MAVSDK 4: upload, download, start, pause, jump, clear, and a QGroundControl plan."""

import math

from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.telemetry import FlightMode
from sdk import Session, check, wait

WAYPOINT, RETURN, TAKEOFF = 16, 20, 22

session = Session()
action, telemetry = session.action, session.telemetry
mission = MissionRaw(session.system)
session.ready()
home = telemetry.home()
lat, lon = home.latitude_deg, home.longitude_deg


def item(seq, command, north=0.0, height=0.0):
    place = (round((lat + north) * 1e7), round(lon * 1e7)) if command == WAYPOINT else (0, 0)
    return MissionItem(seq, 3, command, int(seq == 0), 1, 0.0, 0.0, 0.0, 0.0, *place, height, 0)


items = [
    item(0, WAYPOINT), item(1, TAKEOFF, height=10.0), item(2, WAYPOINT, 1e-4, 10.0), item(3, WAYPOINT, 2e-4, 10.0),
    item(4, WAYPOINT, 0.0, 12.0), item(5, RETURN),
]  # fmt: skip
mission.upload_mission(items)
check("download", [i.command for i in mission.download_mission()] == [i.command for i in items])
action.arm()
mission.start_mission()
wait("on the way to item 3", lambda: mission.mission_progress().current == 3, 60.0)
check("mission mode", telemetry.flight_mode() == FlightMode.MISSION)
mission.pause_mission()
wait("pause", lambda: math.hypot(*session.velocity()) < 0.1, 15.0)
mission.set_current_mission_item(4)
mission.start_mission()
wait("back at 4", lambda: mission.mission_progress().current == 4, 5.0)
wait("return", lambda: mission.mission_progress().current == 5, 60.0)
wait("disarmed", lambda: not telemetry.armed(), 90.0)
session.check_clear_and_plan(
    mission,
    2,
    [
        {"command": TAKEOFF, "params": [0, 0, 0, None, 0, 0, 10]},
        {"command": WAYPOINT, "params": [0, 0, 0, None, lat + 1e-4, lon, 10]},
        {"command": RETURN, "params": [0, 0, 0, 0, 0, 0, 0]},
    ],
)
session.mavsdk.destroy()
