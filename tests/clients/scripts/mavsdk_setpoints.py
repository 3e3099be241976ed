# SPDX-License-Identifier: BSD-3-Clause
"""Every kind of off-board set-point, by MAVSDK 4."""

import math
import time

from mavsdk.plugins.offboard import (
    AccelerationNed,
    Attitude,
    AttitudeRate,
    Offboard,
    PositionGlobalYaw,
    PositionNedYaw,
    VelocityBodyYawspeed,
    VelocityNedYaw,
)
from sdk import Session, check, refused, wait

session = Session()
telemetry = session.telemetry
session.take_off()
offboard = Offboard(session.system)
start = telemetry.position()


def near(what, expected, tolerance=0.3):
    check(what, math.dist(session.velocity(), expected) < tolerance, session.velocity())


def position():
    p = telemetry.position_velocity_ned().position
    return p.north_m, p.east_m, p.down_m


refused("off-board without a set-point", offboard.start, result="NO_SETPOINT_SET")
offboard.set_position_ned(PositionNedYaw(10.0, 0.0, -10.0, 0.0))
offboard.start()
wait("position", lambda: math.dist(position(), (10.0, 0.0, -10.0)) < 0.5, 20.0)
check("active", offboard.is_active())
offboard.set_velocity_ned(VelocityNedYaw(0.0, 2.0, 0.0, 90.0))
time.sleep(6.0)  # twice GUID_TIMEOUT: MAVSDK sends it again and again
near("velocity", (0.0, 2.0, 0.0))
check("yaw", abs(telemetry.attitude_euler().yaw_deg - 90.0) < 5.0, telemetry.attitude_euler().yaw_deg)
offboard.set_velocity_body(VelocityBodyYawspeed(2.0, 0.0, -1.0, 0.0))
time.sleep(4.0)
near("velocity ahead is east", (0.0, 2.0, -1.0))
offboard.set_position_velocity_ned(PositionNedYaw(0.0, 10.0, -10.0, 0.0), VelocityNedYaw(0.0, 0.0, 0.0, 0.0))
wait("position and velocity", lambda: math.dist(position(), (0.0, 10.0, -10.0)) < 0.9, 20.0)
over_home = PositionGlobalYaw.AltitudeType.REL_HOME if hasattr(PositionGlobalYaw, "AltitudeType") else 0
offboard.set_position_global(PositionGlobalYaw(start.latitude_deg, start.longitude_deg, 9.0, 0.0, over_home))
wait("global position", lambda: abs(telemetry.position().latitude_deg - start.latitude_deg) < 5e-6, 20.0)
offboard.set_attitude(Attitude(6.0, 0.0, 0.0, 0.5))
time.sleep(1.5)
check("attitude", abs(telemetry.attitude_euler().roll_deg - 6.0) < 2.0, telemetry.attitude_euler())
offboard.set_attitude_rate(AttitudeRate(0.0, 0.0, 20.0, 0.5))
before = telemetry.attitude_euler().yaw_deg
time.sleep(2.0)
check("rate", 20.0 < telemetry.attitude_euler().yaw_deg - before < 50.0, telemetry.attitude_euler().yaw_deg - before)
offboard.set_acceleration_ned(AccelerationNed(1.0, 0.0, 0.0))
time.sleep(2.0)
check("acceleration", session.velocity()[0] > 0.8, session.velocity())
offboard.stop()
check("not active", not offboard.is_active())
session.land()
