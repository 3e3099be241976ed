# SPDX-License-Identifier: BSD-3-Clause
"""A rover that stands: information, parameters, telemetry, arming without a position, clean refusals, by MAVSDK 4."""

import math

from mavsdk.plugins.info import Info
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode
from sdk import Session, check, refused, wait

session = Session()
action, telemetry, system = session.action, session.telemetry, session.system
info, param = Info(system), Param(system)

check("version", info.get_version().flight_sw_major == 4)
param.set_param_int("FS_GCS_ENABLE", 0)
check("whole number", param.get_param_int("FS_GCS_ENABLE") == 0)
param.set_param_float("WP_SPEED", 1.0)
check("float", param.get_param_float("WP_SPEED") == 1.0)
refused("float as whole number", param.get_param_int, "WP_SPEED", result="WRONG_TYPE")
refused("a copter's parameter", param.get_param_float, "WPNAV_SPEED", result="TIMEOUT")
every = param.get_all_params()
check("all parameters", len(every.int_params) > 50 and len(every.float_params) > 80)

for name in (
    "position", "home", "in_air", "landed_state", "vtol_state", "attitude_quaternion", "attitude_euler", "velocity_ned",
    "gps_info", "raw_gps", "battery", "rc_status", "position_velocity_ned", "fixedwing_metrics", "imu", "scaled_imu",
    "raw_imu", "unix_epoch_time", "health",
):  # fmt: skip
    getattr(telemetry, f"set_rate_{name}")(5.0)
    check(f"rate of {name}", True)
for name in ("odometry", "ground_truth", "altitude", "actuator_output_status", "actuator_control_target"):
    refused(f"rate of {name}", getattr(telemetry, f"set_rate_{name}"), 1.0, result="COMMAND_DENIED")

action.hold()
wait("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD, 5.0)
wait("ready to arm before there is a position", lambda: telemetry.health().is_armable, 30.0)
check("no position yet", not telemetry.health().is_global_position_ok)
action.arm()
wait("armed", telemetry.armed, 2.0)
refused("goto without a position", action.goto_location, -35.363, 149.165, 584.0, 0.0, result="FAILED")
action.disarm()
wait("disarmed", lambda: not telemetry.armed(), 2.0)

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
check("its clock is the vehicle's", abs(info.get_speed_factor() - 1.0) < 0.05, info.get_speed_factor())

here = telemetry.position()
action.arm()
wait("armed", telemetry.armed, 2.0)
refused("take-off", action.takeoff, result="UNSUPPORTED")
refused("landing", action.land, result="UNSUPPORTED")
refused("orbit", action.do_orbit, 10.0, 2.0, 0, here.latitude_deg, here.longitude_deg, 584.0, result="UNSUPPORTED")
refused("shutdown", action.shutdown, result="UNSUPPORTED")
check("still armed", telemetry.armed())
action.kill()
wait("killed", lambda: not telemetry.armed(), 2.0)
action.reboot()
wait("connected after a reboot", system.is_connected)
session.mavsdk.destroy()
