# SPDX-License-Identifier: BSD-3-Clause
"""A rover that stands: information, parameters, telemetry, arming without a position, clean refusals, by MAVSDK 4."""

from mavsdk.plugins.telemetry import FlightMode
from sdk import Session, check, refused, wait

session = Session()
action, telemetry, system = session.action, session.telemetry, session.system

session.check_parameters("WP_SPEED", 1.0, unknown="WPNAV_SPEED", floats=80)
session.check_rates()
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
session.check_telemetry()

here = telemetry.position()
action.arm()
wait("armed", telemetry.armed, 2.0)
refused("take-off", action.takeoff, result="UNSUPPORTED")
refused("landing", action.land, result="UNSUPPORTED")
refused("orbit", action.do_orbit, 10.0, 2.0, 0, here.latitude_deg, here.longitude_deg, 584.0, result="UNSUPPORTED")
refused("shutdown while armed", action.shutdown, result="FAILED")
check("still armed", telemetry.armed())
action.kill()
wait("killed", lambda: not telemetry.armed(), 2.0)
action.reboot()
wait("connected after a reboot", system.is_connected)
session.mavsdk.destroy()
