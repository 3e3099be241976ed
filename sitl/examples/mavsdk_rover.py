# SPDX-License-Identifier: BSD-3-Clause
"""A plain MAVSDK 4.x script for a rover: arm, drive a 20 m square as a mission, go to a position, return, disarm.

Nothing here knows of the simulator: it is what one would run against a real ArduPilot rover.

    python examples/mavsdk_rover.py [CONNECTION_URL]        (default udpin://0.0.0.0:14540)
"""

import math
import sys
import time

try:
    from mavsdk import ComponentType, Configuration, Mavsdk, log_subscribe
    from mavsdk.plugins.action import Action
    from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
    from mavsdk.plugins.telemetry import Telemetry
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install 'mavsdk>=4'") from None

SIDE_M = 20.0
WAYPOINT = 16
GLOBAL_RELATIVE_ALT = 3
METRES_PER_DEGREE = 111319.5


def item(seq: int, lat_deg: float, lon_deg: float) -> MissionItem:
    """One waypoint on the ground."""
    return MissionItem(
        seq=seq,
        frame=GLOBAL_RELATIVE_ALT,
        command=WAYPOINT,
        current=1 if seq == 0 else 0,
        autocontinue=1,
        x=round(lat_deg * 1e7),
        y=round(lon_deg * 1e7),
    )


def offset(lat_deg: float, lon_deg: float, north_m: float, east_m: float) -> tuple[float, float]:
    """The position so many metres to the north and to the east."""
    east_degrees = east_m / METRES_PER_DEGREE / math.cos(math.radians(lat_deg))
    return lat_deg + north_m / METRES_PER_DEGREE, lon_deg + east_degrees


def square(lat_deg: float, lon_deg: float) -> list[MissionItem]:
    """Item 0 is home (ArduPilot fills it in), then the four corners."""
    corners = [(0.0, 0.0), (SIDE_M, 0.0), (SIDE_M, SIDE_M), (0.0, SIDE_M), (0.0, 0.0)]
    return [item(seq, *offset(lat_deg, lon_deg, *corner)) for seq, corner in enumerate(corners)]


def distance(telemetry: Telemetry, position: tuple[float, float]) -> float:
    """How far the rover is from a position [m]."""
    here = telemetry.position()
    north = (here.latitude_deg - position[0]) * METRES_PER_DEGREE
    east = (here.longitude_deg - position[1]) * METRES_PER_DEGREE * math.cos(math.radians(position[0]))
    return math.hypot(north, east)


def wait_for(what: str, condition, timeout_s: float) -> None:
    """Wait until ``condition()`` holds; SystemExit when it does not come true in time."""
    start = time.monotonic()
    while not condition():
        if time.monotonic() - start > timeout_s:
            raise SystemExit(f"gave up after {timeout_s:.0f} s: {what}")
        time.sleep(0.2)
    print(f"{time.monotonic() - start:6.1f} s  {what}", flush=True)


def main() -> None:
    """Drive."""
    url = sys.argv[1] if len(sys.argv) > 1 else "udpin://0.0.0.0:14540"
    log_subscribe(lambda *_: True)  # the library's own log is not shown
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    mavsdk.add_any_connection(url)
    system = mavsdk.first_autopilot(30.0)
    if system is None:
        raise SystemExit(f"no autopilot found on {url}")
    action, telemetry, mission = Action(system), Telemetry(system), MissionRaw(system)
    telemetry.set_rate_position(5.0)
    telemetry.set_rate_health(2.0)
    telemetry.set_rate_home(1.0)
    telemetry.subscribe_status_text(lambda text, _: print("         ", text.text, flush=True))

    wait_for("position estimate", lambda: telemetry.health().is_global_position_ok, 120.0)
    wait_for("home", lambda: telemetry.health().is_home_position_ok, 60.0)
    here = telemetry.position()
    home = (here.latitude_deg, here.longitude_deg)
    mission.upload_mission(square(*home))
    wait_for("ready to arm", lambda: telemetry.health().is_armable, 60.0)

    action.arm()
    mission.start_mission()
    wait_for("square driven", mission.is_mission_finished, 600.0)  # a small rover makes 0.25 m/s

    position = offset(*home, 10.0, -10.0)
    action.goto_location(*position, here.absolute_altitude_m, 0.0)
    wait_for("10 m north and west of home", lambda: distance(telemetry, position) < 3.0, 90.0)

    action.return_to_launch()
    wait_for("home again", lambda: distance(telemetry, home) < 3.0, 120.0)
    action.hold()
    time.sleep(3.0)  # it rolls to a stop
    action.disarm()
    wait_for("disarmed", lambda: not telemetry.armed(), 10.0)
    mavsdk.destroy()


if __name__ == "__main__":
    main()
