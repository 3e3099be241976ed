# SPDX-License-Identifier: BSD-3-Clause
"""Actions and sticks in the air, by MAVSDK 4 as the pilot's ground station (255)."""

import math
import time

from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.telemetry import FlightMode
from sdk import Session, check, refused, wait

session = Session(as_pilot=True)
action, telemetry = session.action, session.telemetry
session.take_off()
check("in the air", telemetry.in_air())

start = telemetry.position()
action.set_current_speed(4.0)
action.goto_location(start.latitude_deg + 1e-4, start.longitude_deg, start.absolute_altitude_m + 2.0, 0.0)
wait("there", lambda: abs(telemetry.position().latitude_deg - start.latitude_deg - 1e-4) < 3e-6)
wait("higher", lambda: abs(telemetry.position().relative_altitude_m - start.relative_altitude_m - 2.0) < 0.5)
action.hold()
wait("hold", lambda: telemetry.flight_mode() == FlightMode.HOLD, 3.0)
refused("orbit", action.do_orbit, 10.0, 2.0, 0, start.latitude_deg, start.longitude_deg, 600.0, result="UNSUPPORTED")

sticks = ManualControl(session.system)


def hold_sticks(seconds, ahead):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        sticks.set_manual_control_input(ahead, 0.0, 0.5, 0.0)
        time.sleep(0.05)


hold_sticks(0.2, 0.0)
sticks.start_altitude_control()
wait("ALT_HOLD", lambda: telemetry.flight_mode() == FlightMode.ALTCTL, 3.0)
hold_sticks(3.0, 0.5)
check("stick ahead", math.hypot(*session.velocity()[:2]) > 1.0, session.velocity())
hold_sticks(2.0, -0.3)

action.return_to_launch()
wait("return", lambda: telemetry.flight_mode() == FlightMode.RETURN_TO_LAUNCH, 3.0)
action.land()
wait("disarmed", lambda: not telemetry.armed(), 90.0)
# MAVSDK 4.1 holds before it arms out of LAND, which is BRAKE in ArduPilot, and BRAKE cannot be armed in
refused("arming after landing", action.arm, result="FAILED")
session.mavsdk.destroy()
