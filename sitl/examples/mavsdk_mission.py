# SPDX-License-Identifier: BSD-3-Clause
"""A plain MAVSDK 4.x script: arm, take off to 10 m, fly a 30 m square as a mission, return, land, disarm.

Nothing here knows of the simulator: it is what one would run against a real vehicle with ArduPilot or PX4.

    python examples/mavsdk_mission.py [CONNECTION_URL]        (default udpin://0.0.0.0:14540)
"""

import math
import sys
import time

try:
    from mavsdk import Autopilot, ComponentType, Configuration, Mavsdk, log_subscribe
    from mavsdk.plugins.action import Action
    from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
    from mavsdk.plugins.telemetry import Telemetry
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install 'mavsdk>=4'") from None

ALTITUDE_M = 10.0
SIDE_M = 30.0

WAYPOINT, RETURN_TO_LAUNCH, TAKEOFF = 16, 20, 22
MISSION, GLOBAL_RELATIVE_ALT = 2, 3


def item(seq: int, command: int, lat_deg: float = 0.0, lon_deg: float = 0.0, alt_m: float = 0.0) -> MissionItem:
    """One mission item, altitude above home; one without a position has the frame MISSION."""
    return MissionItem(
        seq=seq,
        frame=MISSION if command == RETURN_TO_LAUNCH else GLOBAL_RELATIVE_ALT,
        command=command,
        current=1 if seq == 0 else 0,
        autocontinue=1,
        x=round(lat_deg * 1e7),
        y=round(lon_deg * 1e7),
        z=alt_m,
    )


def square(lat_deg: float, lon_deg: float, is_ardupilot: bool) -> list[MissionItem]:
    """Take-off, the four corners and the return; before them ArduPilot has home as item 0, which it fills in."""
    north = SIDE_M / 111319.5
    east = north / math.cos(math.radians(lat_deg))
    corners = [(north, 0.0), (north, east), (0.0, east), (0.0, 0.0)]
    items = [item(0, WAYPOINT, lat_deg, lon_deg)] if is_ardupilot else []
    items.append(item(len(items), TAKEOFF, lat_deg, lon_deg, ALTITUDE_M))
    for north_deg, east_deg in corners:
        items.append(item(len(items), WAYPOINT, lat_deg + north_deg, lon_deg + east_deg, ALTITUDE_M))
    return [*items, item(len(items), RETURN_TO_LAUNCH)]


def wait_for(what: str, condition, timeout_s: float) -> None:
    """Wait until ``condition()`` holds; SystemExit when it does not come true in time."""
    start = time.monotonic()
    while not condition():
        if time.monotonic() - start > timeout_s:
            raise SystemExit(f"gave up after {timeout_s:.0f} s: {what}")
        time.sleep(0.2)
    print(f"{time.monotonic() - start:6.1f} s  {what}", flush=True)


def main() -> None:
    """Fly the mission."""
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
    telemetry.set_rate_landed_state(2.0)
    telemetry.subscribe_status_text(lambda text, _: print("         ", text.text, flush=True))
    mission.subscribe_mission_progress(lambda p, _: print(f"          item {p.current} of {p.total}", flush=True))

    wait_for("position estimate", lambda: telemetry.health().is_global_position_ok, 120.0)
    wait_for("home", lambda: telemetry.health().is_home_position_ok, 60.0)
    here = telemetry.position()
    is_ardupilot = system.autopilot_type() == Autopilot.ARDUPILOT
    mission.upload_mission(square(here.latitude_deg, here.longitude_deg, is_ardupilot))
    wait_for("ready to arm", lambda: telemetry.health().is_armable, 60.0)

    action.arm()
    mission.start_mission()
    wait_for("in the air", telemetry.in_air, 30.0)
    wait_for("landed and disarmed", lambda: not telemetry.armed(), 180.0)
    mavsdk.destroy()


if __name__ == "__main__":
    main()
