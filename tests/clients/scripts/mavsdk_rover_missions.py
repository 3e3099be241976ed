# SPDX-License-Identifier: BSD-3-Clause
"""Missions of a rover by MAVSDK 4: upload, download, start, pause, jump, clear, and a QGroundControl plan."""

import math

from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.telemetry import FlightMode
from sdk import Session, check, refused, wait

WAYPOINT, RETURN, UNKNOWN, CHANGE_SPEED, SET_REVERSE, JUMP = 16, 20, 65000, 178, 194, 177

session = Session()
action, telemetry = session.action, session.telemetry
mission = MissionRaw(session.system)
session.ready()
home = telemetry.home()
lat, lon = home.latitude_deg, home.longitude_deg


def item(seq, command, north=0.0, p1=0.0, p2=0.0):
    place = (round((lat + north) * 1e7), round(lon * 1e7)) if command == WAYPOINT else (0, 0)
    return MissionItem(seq, 3, command, int(seq == 0), 1, p1, p2, 0.0, 0.0, *place, 0.0, 0)


items = [
    item(0, WAYPOINT), item(1, WAYPOINT, 0.8e-4), item(2, WAYPOINT, 2e-4, p1=2.0), item(3, WAYPOINT, 3e-4),
    item(4, CHANGE_SPEED, p1=1.0, p2=0.8), item(5, WAYPOINT, 1e-4), item(6, RETURN),
]  # fmt: skip
mission.upload_mission(items)
check("download", [i.command for i in mission.download_mission()] == [i.command for i in items])
action.arm()
mission.start_mission()
wait("on the way to item 2", lambda: mission.mission_progress().current == 2, 60.0)
check("mission mode", telemetry.flight_mode() == FlightMode.MISSION)
mission.pause_mission()
wait("pause", lambda: session.speed() < 0.1, 15.0)
check("hold", telemetry.flight_mode() == FlightMode.HOLD)
mission.set_current_mission_item(5)
mission.start_mission()
wait("back at 5", lambda: mission.mission_progress().current == 5, 5.0)
wait("return", lambda: mission.mission_progress().current == 6, 60.0)
wait("home", lambda: math.hypot(*session.place()) < 2.5, 60.0)
wait("finished", lambda: mission.is_mission_finished(), 60.0)
action.hold()
action.disarm()
wait("disarmed", lambda: not telemetry.armed(), 5.0)
refused("an unknown item", mission.upload_mission, [item(0, WAYPOINT), item(1, UNKNOWN)], result="UNSUPPORTED")
session.check_clear_and_plan(
    mission,
    10,
    [
        {"command": WAYPOINT, "params": [0, 0, 0, None, lat + 1e-4, lon, 0]},
        {"command": SET_REVERSE, "frame": 2, "params": [1, 0, 0, 0, 0, 0, 0]},
        {"command": WAYPOINT, "params": [3, 0, 0, None, lat, lon, 0]},
        {"command": JUMP, "frame": 2, "params": [1, 2, 0, 0, 0, 0, 0]},
        {"command": RETURN, "frame": 2, "params": [0, 0, 0, 0, 0, 0, 0]},
    ],
)
session.mavsdk.destroy()
