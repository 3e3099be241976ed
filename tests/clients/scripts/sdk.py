# SPDX-License-Identifier: BSD-3-Clause
"""What the MAVSDK 4 scripts of these tests share."""

import json
import math
import sys
import time
from functools import cached_property

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.info import Info
from mavsdk.plugins.mission_raw import MissionRaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import Telemetry


def check(what: str, ok: object, seen: object = "") -> None:
    """Print and go on, or end the script."""
    print(f"{'ok' if ok else 'FAILED'}: {what} {seen}", flush=True)
    if not ok:
        sys.exit(1)


def wait(what, condition, seconds=30.0) -> None:
    """Until the condition holds; the script ends when it does not in time."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.1)
    check(what, condition())


def refused(what, call, *arguments, result="") -> None:
    """The call must raise, naming ``result``."""
    start = time.monotonic()
    try:
        call(*arguments)
    except Exception as error:
        check(f"{what} is refused", result in str(error), f"{error} after {time.monotonic() - start:.2f} s")
    else:
        check(f"{what} is refused", False)


class Session:
    """A connected vehicle."""

    def __init__(self, as_pilot: bool = False) -> None:
        ground_station = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
        self.mavsdk = Mavsdk(Configuration.create_manual(255, 190, True) if as_pilot else ground_station)
        self.mavsdk.add_any_connection(sys.argv[1])
        self.system = self.mavsdk.first_autopilot(30.0)
        check("autopilot", self.system is not None)
        self.action, self.telemetry = Action(self.system), Telemetry(self.system)

    @cached_property
    def info(self) -> Info:
        """It measures the vehicle's clock from when it is first asked."""
        return Info(self.system)

    def ready(self) -> None:
        """Until it can be armed and flown."""
        t = self.telemetry
        for name, rate in (
            ("position", 5),
            ("home", 1),
            ("health", 2),
            ("landed_state", 2),
            ("position_velocity_ned", 10),
        ):
            getattr(t, f"set_rate_{name}")(float(rate))
        t.set_rate_attitude_euler(10.0)
        wait("position", lambda: t.health().is_global_position_ok and t.health().is_home_position_ok, 90.0)
        wait("ready to arm", lambda: t.health().is_armable)

    def take_off(self, height=10.0) -> None:
        """Into the air."""
        self.ready()
        self.action.set_takeoff_altitude(height)
        self.action.arm()
        self.action.takeoff()
        wait("at height", lambda: self.telemetry.position().relative_altitude_m > height - 0.3)

    def land(self) -> None:
        """Down, motors off, and the library closed."""
        self.action.land()
        wait("disarmed", lambda: not self.telemetry.armed(), 90.0)
        self.mavsdk.destroy()

    def velocity(self) -> tuple[float, float, float]:
        """North, east, down [m/s]."""
        v = self.telemetry.position_velocity_ned().velocity
        return v.north_m_s, v.east_m_s, v.down_m_s

    def speed(self) -> float:
        """Over the ground [m/s]."""
        return math.hypot(*self.velocity()[:2])

    def place(self) -> tuple[float, float]:
        """North, east [m] of where the estimator began."""
        p = self.telemetry.position_velocity_ned().position
        return p.north_m, p.east_m

    def check_parameters(self, name: str, value: float, unknown: str, floats: int) -> None:
        """Version and parameters: a float of this vehicle, one that it does not have, and at least so many floats."""
        param = Param(self.system)
        check("version", self.info.get_version().flight_sw_major == 4)
        param.set_param_int("FS_GCS_ENABLE", 0)
        check("whole number", param.get_param_int("FS_GCS_ENABLE") == 0)
        param.set_param_float(name, value)
        check("float", param.get_param_float(name) == value)
        refused("float as whole number", param.get_param_int, name, result="WRONG_TYPE")
        refused("unknown parameter", param.get_param_float, unknown, result="DOES_NOT_EXIST")
        every = param.get_all_params()
        check("all parameters", len(every.int_params) > 50 and len(every.float_params) > floats)

    def check_rates(self) -> None:
        """Which telemetry can be asked for at a rate."""
        for name in (
            "position", "home", "in_air", "landed_state", "vtol_state", "attitude_quaternion", "attitude_euler",
            "velocity_ned", "gps_info", "raw_gps", "battery", "rc_status", "position_velocity_ned",
            "fixedwing_metrics", "imu", "scaled_imu", "raw_imu", "unix_epoch_time", "health",
        ):  # fmt: skip
            getattr(self.telemetry, f"set_rate_{name}")(5.0)
            check(f"rate of {name}", True)
        for name in ("odometry", "ground_truth", "altitude", "actuator_output_status", "actuator_control_target"):
            refused(f"rate of {name}", getattr(self.telemetry, f"set_rate_{name}"), 1.0, result="COMMAND_DENIED")

    def check_telemetry(self) -> None:
        """Every message has numbers."""
        check("all well", self.telemetry.health_all_ok())
        for name, field in (
            ("position", "latitude_deg"), ("home", "latitude_deg"), ("attitude_quaternion", "w"),
            ("attitude_euler", "yaw_deg"), ("velocity_ned", "north_m_s"), ("raw_gps", "hdop"),
            ("battery", "voltage_v"), ("heading", "heading_deg"), ("fixedwing_metrics", "throttle_percentage"),
            ("imu", "temperature_degc"),
        ):  # fmt: skip
            value = getattr(self.telemetry, name)()
            check(name, math.isfinite(getattr(value, field)), value)
        check("satellites", self.telemetry.gps_info().num_satellites >= 10)
        factor = self.info.get_speed_factor()
        check("its clock is the vehicle's", abs(factor - 1.0) < 0.05, factor)

    def check_clear_and_plan(self, mission: MissionRaw, vehicle_type: int, rows: list[dict]) -> None:
        """A mission is cleared; a QGroundControl plan of such simple items is uploaded and comes back."""
        mission.clear_mission()
        check("cleared", len(mission.download_mission()) <= 1)  # MAVSDK clears ArduPilot's by uploading one empty item
        home = self.telemetry.home()
        simple = {"autoContinue": True, "type": "SimpleItem", "frame": 3}
        plan = {
            "fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
            "geoFence": {"circles": [], "polygons": [], "version": 2}, "rallyPoints": {"points": [], "version": 2},
            "mission": {
                "version": 2, "firmwareType": 3, "vehicleType": vehicle_type, "globalPlanAltitudeMode": 1,
                "cruiseSpeed": 15 if vehicle_type == 2 else 2, "hoverSpeed": 5,
                "plannedHomePosition": [home.latitude_deg, home.longitude_deg, 584],
                "items": [{**simple, "doJumpId": number, **row} for number, row in enumerate(rows, 1)],
            },
        }  # fmt: skip
        mission.upload_mission(mission.import_qgroundcontrol_mission_from_string(json.dumps(plan)).mission_items)
        commands = [item.command for item in mission.download_mission()]
        check("plan", commands == [16, *(row["command"] for row in rows)], commands)
