# SPDX-License-Identifier: BSD-3-Clause
"""On the ground: information, parameters, telemetry, and clean refusals, by MAVSDK 4."""

from mavsdk.plugins.ftp import Ftp
from mavsdk.plugins.geofence import Circle, FenceType, Geofence, GeofenceData, Point
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from sdk import Session, check, refused, wait

session = Session()
action, telemetry, system = session.action, session.telemetry, session.system

session.check_parameters("WPNAV_SPEED", 800.0, unknown="NOPE", floats=100)
action.set_return_to_launch_altitude(12.0)
check("return altitude", action.get_return_to_launch_altitude() == 12.0)

refused("goto before there is a position", action.goto_location, -35.363, 149.165, 600.0, 0.0, result="FAILED")
session.check_rates()
session.ready()
session.check_telemetry()
origin = telemetry.get_gps_global_origin()
check("origin", abs(origin.latitude_deg + 35.363262) < 1e-4)
refused("a second origin", action.set_gps_global_origin, -35.0, 149.0, 584.0)

here = telemetry.position()
geofence, mission = Geofence(system), MissionRaw(system)
circle = Circle(Point(here.latitude_deg, here.longitude_deg), 50.0, FenceType.INCLUSION)
refused("fence", geofence.upload_geofence, GeofenceData([], [circle]))
fence = geofence.download_geofence()
check("no fence", not fence.circles and not fence.polygons)
geofence.clear_geofence()
point = MissionItem(
    0, 3, 5100, 1, 1, 0, 0, 0, 0, round(here.latitude_deg * 1e7), round(here.longitude_deg * 1e7), 50.0, 2
)
refused("rally points", mission.upload_rally_points, [point], result="UNSUPPORTED")
check("no rally points", mission.download_rallypoints() == [])
refused("directory", Ftp(system).list_directory, "/", result="UNSUPPORTED")
refused("take-off when disarmed", action.takeoff, result="FAILED")
refused("shutdown", action.shutdown, result="UNSUPPORTED")
action.reboot()
wait("connected after a reboot", system.is_connected)
session.mavsdk.destroy()
