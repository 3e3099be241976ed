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
geofence.upload_geofence(GeofenceData([], [circle]))
(found,) = geofence.download_geofence().circles
check("fence", abs(found.point.latitude_deg - here.latitude_deg) < 1e-6 and found.radius == 50.0)
geofence.clear_geofence()
check("no fence", not geofence.download_geofence().circles)
point = MissionItem(
    0, 3, 5100, 1, 1, 0, 0, 0, 0, round(here.latitude_deg * 1e7), round(here.longitude_deg * 1e7), 50.0, 2
)
mission.upload_rally_points([point])
check("rally points", [(p.x, p.y, p.z) for p in mission.download_rallypoints()] == [(point.x, point.y, 50.0)])
ftp = Ftp(system)
check("folder", "@SYS" in [entry.name for entry in ftp.list_directory("/").entries])
check("files", "uarts.txt" in [entry.name for entry in ftp.list_directory("@SYS").entries])
refused("a folder that is not there", ftp.list_directory, "nothing", result="FILE_DOES_NOT_EXIST")
refused("take-off when disarmed", action.takeoff, result="FAILED")
refused("shutdown", action.shutdown, result="UNSUPPORTED")
action.reboot()
wait("connected after a reboot", system.is_connected)
session.mavsdk.destroy()
