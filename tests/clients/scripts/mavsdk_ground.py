# SPDX-License-Identifier: BSD-3-Clause
"""On the ground: information, parameters, telemetry, and clean refusals, by MAVSDK 4."""

import math

from mavsdk.plugins.ftp import Ftp
from mavsdk.plugins.geofence import Circle, FenceType, Geofence, GeofenceData, Point
from mavsdk.plugins.info import Info
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.param import Param
from sdk import Session, check, refused, wait

session = Session()
action, telemetry, system = session.action, session.telemetry, session.system
info, param = Info(system), Param(system)

check("version", info.get_version().flight_sw_major == 4)
param.set_param_int("FS_GCS_ENABLE", 0)
check("whole number", param.get_param_int("FS_GCS_ENABLE") == 0)
param.set_param_float("WPNAV_SPEED", 800.0)
check("float", param.get_param_float("WPNAV_SPEED") == 800.0)
refused("float as whole number", param.get_param_int, "WPNAV_SPEED", result="WRONG_TYPE")
refused("unknown parameter", param.get_param_float, "NOPE", result="TIMEOUT")
every = param.get_all_params()
check("all parameters", len(every.int_params) > 50 and len(every.float_params) > 100)
action.set_return_to_launch_altitude(12.0)
check("return altitude", action.get_return_to_launch_altitude() == 12.0)

refused("goto before there is a position", action.goto_location, -35.363, 149.165, 600.0, 0.0, result="FAILED")
for name in (
    "position", "home", "in_air", "landed_state", "vtol_state", "attitude_quaternion", "attitude_euler", "velocity_ned",
    "gps_info", "raw_gps", "battery", "rc_status", "position_velocity_ned", "fixedwing_metrics", "imu", "scaled_imu",
    "raw_imu", "unix_epoch_time", "health",
):  # fmt: skip
    getattr(telemetry, f"set_rate_{name}")(5.0)
    check(f"rate of {name}", True)
for name in ("odometry", "ground_truth", "altitude", "actuator_output_status", "actuator_control_target"):
    refused(f"rate of {name}", getattr(telemetry, f"set_rate_{name}"), 1.0, result="COMMAND_DENIED")
session.ready()
check("all well", telemetry.health_all_ok())
for name, field in (
    ("position", "latitude_deg"), ("home", "latitude_deg"), ("attitude_quaternion", "w"), ("attitude_euler", "yaw_deg"),
    ("velocity_ned", "north_m_s"), ("raw_gps", "hdop"), ("battery", "voltage_v"), ("heading", "heading_deg"),
    ("fixedwing_metrics", "throttle_percentage"), ("imu", "temperature_degc"),
):  # fmt: skip
    value = getattr(telemetry, name)()
    check(name, math.isfinite(getattr(value, field)), value)
check("satellites", telemetry.gps_info().num_satellites >= 10)
origin = telemetry.get_gps_global_origin()
check("origin", abs(origin.latitude_deg + 35.363262) < 1e-4)
refused("a second origin", action.set_gps_global_origin, -35.0, 149.0, 584.0)
check("its clock is the vehicle's", abs(info.get_speed_factor() - 1.0) < 0.05, info.get_speed_factor())

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
