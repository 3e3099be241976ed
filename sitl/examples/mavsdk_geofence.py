# SPDX-License-Identifier: BSD-3-Clause
"""A geofence by MAVSDK: a pentagon to stay in, a set-point that leads out of it, and the return that follows.

    sitl exec --speedup max -- python examples/mavsdk_geofence.py      (CONNECTION_URL: udpin://0.0.0.0:14540)

It draws mavsdk_geofence.png and needs mavsdk and matplotlib.
"""

import math
import sys
import time

try:
    import matplotlib.pyplot as plt
    from mavsdk import ComponentType, Configuration, Mavsdk, log_subscribe
    from mavsdk.plugins.action import Action
    from mavsdk.plugins.geofence import FenceType, Geofence, GeofenceData, Point, Polygon
    from mavsdk.plugins.offboard import Offboard, VelocityNedYaw
    from mavsdk.plugins.param import Param
    from mavsdk.plugins.telemetry import Telemetry
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib mavsdk") from None

RADIUS_M, CORNERS = 30.0, 5
POLYGONS = 4
"""Bit of FENCE_TYPE."""
METRES_A_DEGREE = 111_319.5


def wait_for(what: str, condition, timeout_s: float) -> None:
    """Wait until ``condition()`` holds; SystemExit when it does not come true in time."""
    start = time.monotonic()
    while not condition():
        if time.monotonic() - start > timeout_s:
            raise SystemExit(f"gave up after {timeout_s:.0f} s: {what}")
        time.sleep(0.2)
    print(f"{time.monotonic() - start:6.1f} s  {what}", flush=True)


def main() -> None:
    """Load the fence, fly into it, and draw the flight."""
    url = sys.argv[1] if len(sys.argv) > 1 else "udpin://0.0.0.0:14540"
    log_subscribe(lambda *_: True)  # the library's own log is not shown
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(url)
    system = mavsdk.first_autopilot(30.0)
    if system is None:
        raise SystemExit(f"no autopilot found on {url}")
    action, telemetry, offboard = Action(system), Telemetry(system), Offboard(system)
    telemetry.set_rate_health(2.0)
    telemetry.set_rate_position_velocity_ned(10.0)
    telemetry.subscribe_status_text(lambda text, _: print("         ", text.text, flush=True))
    wait_for("position estimate", lambda: telemetry.health().is_global_position_ok, 120.0)

    here = telemetry.position()
    turns = [math.tau * k / CORNERS for k in range(CORNERS)]
    corners = [(RADIUS_M * math.cos(turn), RADIUS_M * math.sin(turn)) for turn in turns]  # north, east [m]
    wide = METRES_A_DEGREE * math.cos(math.radians(here.latitude_deg))
    points = [Point(here.latitude_deg + n / METRES_A_DEGREE, here.longitude_deg + e / wide) for n, e in corners]
    Geofence(system).upload_geofence(GeofenceData([Polygon(points, FenceType.INCLUSION)], []))
    for name, value in (("FENCE_TYPE", POLYGONS), ("FENCE_ACTION", 1), ("AVOID_ENABLE", 0), ("FENCE_ENABLE", 1)):
        Param(system).set_param_int(name, value)

    wait_for("ready to arm", lambda: telemetry.health().is_armable, 60.0)
    path = []
    telemetry.subscribe_position_velocity_ned(lambda p, _: path.append((p.position.east_m, p.position.north_m)))
    action.set_takeoff_altitude(10.0)
    action.arm()
    action.takeoff()
    wait_for("at altitude", lambda: telemetry.position().relative_altitude_m > 9.5, 30.0)
    offboard.set_velocity_ned(VelocityNedYaw(-1.0, -4.0, 0.0, 0.0))  # north, east, down [m/s], yaw [deg]
    offboard.start()
    time.sleep(5.0)
    offboard.set_velocity_ned(VelocityNedYaw(5.0, 2.0, 0.0, 0.0))  # out of the fence
    wait_for("outside", lambda: telemetry.flight_mode().name == "RETURN_TO_LAUNCH", 60.0)
    wait_for("landed and disarmed", lambda: not telemetry.armed(), 120.0)
    mavsdk.destroy()

    norths, easts = zip(*corners, corners[0])
    figure, axes = plt.subplots(figsize=(5, 4.6), layout="constrained")
    axes.plot(easts, norths, "r--", label="fence")
    axes.plot(*zip(*path), label="flight")
    axes.plot(0, 0, "ks", label="home")
    axes.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    axes.legend()
    figure.savefig("mavsdk_geofence.png", dpi=80)


if __name__ == "__main__":
    main()
