# SPDX-License-Identifier: BSD-3-Clause
"""A mission by plain pymavlink: upload it item by item, fly it in AUTO, and plot the path flown over the path planned.

    sitl exec --speedup max -- python examples/pymavlink_mission.py        (CONNECTION: udpin:0.0.0.0:14550)

It draws pymavlink_mission.png and needs matplotlib.
"""

import math
import sys
import time

try:
    import matplotlib.pyplot as plt
    from pymavlink import mavutil
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib pymavlink") from None

mavlink = mavutil.mavlink
PLAN = [(0, 0, 8), (30, 0, 12), (30, 20, 20), (15, 32, 20), (0, 20, 12), (0, 0, 8)]
"""North, east of home, height above home [m]."""
METRES_A_DEGREE = 111_319.5


def wait(link, kinds, condition=lambda message: True, timeout_s: float = 30.0):
    """The first message of these kinds for which the condition holds; SystemExit when none comes in time."""
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        message = link.recv_match(type=kinds, blocking=True, timeout=1.0)
        if message is not None and message.get_srcSystem() != link.target_system:
            continue  # of another vehicle or ground station, or the vehicle is not known yet
        if message is not None and condition(message):
            return message
    raise SystemExit(f"gave up after {timeout_s:.0f} s: {kinds}")


def upload(link, items: list[tuple[int, float, float, float]]) -> None:
    """Items (command, latitude, longitude [deg], height above home [m]), each when the vehicle asks for it."""
    target = link.target_system, link.target_component
    link.mav.mission_count_send(*target, len(items))
    while (asked := wait(link, ["MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK"])).get_type() != "MISSION_ACK":
        command, lat, lon, height = items[asked.seq]
        link.mav.mission_item_int_send(
            *target, asked.seq, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, command, 0, 1, 0, 0, 0, 0,
            round(lat * 1e7), round(lon * 1e7), height,
        )  # fmt: skip
    if asked.type != mavlink.MAV_MISSION_ACCEPTED:
        raise SystemExit(f"the mission is refused: {asked.type}")


def main() -> None:
    """Fly it, and draw it."""
    url = sys.argv[1] if len(sys.argv) > 1 else "udpin:0.0.0.0:14550"
    link = mavutil.mavlink_connection(url)
    wait(link, "HEARTBEAT")  # pymavlink takes the first vehicle's system for its target
    link.set_mode("GUIDED")
    wait(link, "HEARTBEAT", lambda m: link.flightmode == "GUIDED")
    checked = mavlink.MAV_SYS_STATUS_PREARM_CHECK
    wait(link, "SYS_STATUS", lambda m: m.onboard_control_sensors_health & checked, 120.0)
    home = wait(link, "GLOBAL_POSITION_INT", lambda m: m.lat != 0)
    lat, lon = home.lat * 1e-7, home.lon * 1e-7
    wide = METRES_A_DEGREE * math.cos(math.radians(lat))
    waypoints = [(lat + north / METRES_A_DEGREE, lon + east / wide, height) for north, east, height in PLAN]
    upload(link, [
        (mavlink.MAV_CMD_NAV_WAYPOINT, lat, lon, 0.0),  # item 0 is home
        (mavlink.MAV_CMD_NAV_TAKEOFF, 0.0, 0.0, PLAN[0][2]),
        *((mavlink.MAV_CMD_NAV_WAYPOINT, *waypoint) for waypoint in waypoints),
        (mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0, 0.0),
    ])  # fmt: skip
    link.arducopter_arm()
    link.motors_armed_wait()
    link.set_mode_auto()  # AUTO, and MISSION_START

    path, armed = [], True
    while armed:
        m = wait(link, ["GLOBAL_POSITION_INT", "HEARTBEAT", "MISSION_ITEM_REACHED", "STATUSTEXT"])
        if m.get_type() == "GLOBAL_POSITION_INT":
            east, north = (m.lon * 1e-7 - lon) * wide, (m.lat * 1e-7 - lat) * METRES_A_DEGREE
            path.append((m.time_boot_ms * 1e-3, east, north, m.relative_alt * 1e-3))
        elif m.get_type() == "HEARTBEAT":
            armed = bool(m.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
        else:
            print(m.text if m.get_type() == "STATUSTEXT" else f"item {m.seq} reached", flush=True)
    print("landed and disarmed")

    times, easts, norths, heights = zip(*path)
    figure, (plan, climb) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    plan.plot([p[1] for p in PLAN], [p[0] for p in PLAN], "o--", color="0.5", label="planned")
    plan.plot(easts, norths, label="flown")
    plan.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    plan.legend()
    climb.plot(times, heights)
    climb.set(xlabel="time since boot [s]", ylabel="height above home [m]")
    figure.savefig("pymavlink_mission.png", dpi=80)


if __name__ == "__main__":
    main()
