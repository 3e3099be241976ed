# SPDX-License-Identifier: BSD-3-Clause
"""A rover driven by actions, every kind of off-board set-point that ArduRover takes, and sticks, by MAVSDK 4 as 255."""

import math
import time

from mavsdk.plugins.manual_control import ManualControl
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
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode
from sdk import Session, check, refused, wait

FULL = 1.0  # [m/s]

session = Session(as_pilot=True)
action, telemetry, offboard = session.action, session.telemetry, Offboard(session.system)
Param(session.system).set_param_float("WP_SPEED", FULL)
session.ready()
action.arm()
start = telemetry.position()


def arrive(what, north, east, seconds=40.0):
    wait(what, lambda: math.dist(session.place(), (north, east)) < 2.5, seconds)


def yaw():
    return telemetry.attitude_euler().yaw_deg


def turn(since):
    return (yaw() - since + 180.0) % 360.0 - 180.0


sticks = ManualControl(session.system)


def hold_sticks(seconds, ahead, right):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        sticks.set_manual_control_input(0.0, right, ahead, 0.0)
        time.sleep(0.05)


def ahead():
    """Speed along the nose [m/s]."""
    heading = math.radians(yaw())
    return session.velocity()[0] * math.cos(heading) + session.velocity()[1] * math.sin(heading)


check("MANUAL, as it starts", telemetry.flight_mode() == FlightMode.MANUAL)
hold_sticks(3.0, 0.5, 0.0)
check("stick ahead", ahead() > 0.4, ahead())
before = yaw()
hold_sticks(3.0, 0.5, 0.5)
check("and right", turn(before) > 15.0, turn(before))
refused("stick back", hold_sticks, 1.0, -0.5, 0.0, result="INPUT_OUT_OF_RANGE")  # MAVSDK's throttle has no reverse
hold_sticks(2.0, 0.0, 0.0)

refused("off-board without a set-point", offboard.start, result="NO_SETPOINT_SET")
offboard.set_position_ned(PositionNedYaw(12.0, 0.0, 0.0, 0.0))
offboard.start()
check("active", offboard.is_active())
arrive("position", 12.0, 0.0)

# with a yaw beside it a velocity is the speed along that yaw
offboard.set_velocity_ned(VelocityNedYaw(0.0, 0.8, 0.0, 90.0))
time.sleep(9.0)  # three times the time-out: MAVSDK sends it again and again
check("velocity", math.dist(session.velocity()[:2], (0.0, 0.8)) < 0.2, session.velocity())
offboard.set_velocity_body(VelocityBodyYawspeed(0.8, 0.0, 0.0, 15.0))
time.sleep(2.0)
before = yaw()
time.sleep(3.0)
check("body velocity with a turn rate", 30.0 < turn(before) < 60.0, turn(before))
offboard.set_velocity_body(VelocityBodyYawspeed(-0.6, 0.0, 0.0, 0.0))
time.sleep(5.0)
check("backwards", -0.8 < ahead() < -0.4, ahead())
offboard.set_attitude(Attitude(0.0, 0.0, 180.0, 0.7))  # thrust is a share of WP_SPEED
time.sleep(10.0)
check("heading", abs(abs(yaw()) - 180.0) < 8.0, yaw())
check("and speed", abs(session.speed() - 0.7 * FULL) < 0.15, session.speed())
offboard.set_attitude_rate(AttitudeRate(0.0, 0.0, -15.0, 0.7))
time.sleep(2.0)
before = yaw()
time.sleep(3.0)
check("turn rate and speed", -60.0 < turn(before) < -30.0, turn(before))
offboard.set_acceleration_ned(AccelerationNed(1.0, 0.0, 0.0))
time.sleep(5.0)
check("accelerations are not taken: it stops", session.speed() < 0.1, session.speed())
over_home = PositionGlobalYaw.AltitudeType.REL_HOME
offboard.set_position_global(PositionGlobalYaw(start.latitude_deg, start.longitude_deg, 0.0, 0.0, over_home))
arrive("global position", 0.0, 0.0)
offboard.stop()
check("not active", not offboard.is_active())
wait("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD, 3.0)

action.goto_location(start.latitude_deg + 1e-4, start.longitude_deg, start.absolute_altitude_m, 0.0)
action.set_current_speed(0.5)
time.sleep(8.0)
check("speed changed", abs(session.speed() - 0.5) < 0.12, session.speed())
action.set_current_speed(FULL)
arrive("goto", 11.13, 0.0)

action.return_to_launch()
wait("return", lambda: telemetry.flight_mode() == FlightMode.RETURN_TO_LAUNCH, 3.0)
arrive("home", 0.0, 0.0)
action.hold()
wait("stands", lambda: session.speed() < 0.1, 10.0)
action.disarm()
wait("disarmed", lambda: not telemetry.armed(), 3.0)
session.mavsdk.destroy()
