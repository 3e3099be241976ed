# SPDX-License-Identifier: BSD-3-Clause
"""Parameters and missions of a rover by pymavlink: a WPL file by mavwp, and a plan as QGroundControl sends it."""

import math
import sys
import tempfile
from pathlib import Path

from pilot import ARMED, Pilot, check
from pymavlink import mavwp

NORTH_10_M, EAST_10_M = 898, 1101
WAYPOINT, RETURN, DELAY, JUMP, CHANGE_SPEED, SET_REVERSE, START = 16, 20, 93, 177, 178, 194, 300
RELATIVE, MISSION = 3, 2

pilot = Pilot(sys.argv[1])
pilot.link.param_set_send("WP_SPEED", 1.0)
changed = pilot.expect("parameter set", ("PARAM_VALUE",), lambda p: p.param_id == "WP_SPEED")
check("value", changed.param_value == 1.0)
pilot.link.param_fetch_all()
names = set()
while len(names) < changed.param_count:
    names.add(pilot.expect(f"parameter {len(names)}", ("PARAM_VALUE",), lambda p: p.param_index < 65535).param_id)
check("parameters of a rover", {"CRUISE_SPEED", "ATC_STR_RAT_FF", "MOT_SLEWRATE"} <= names and "ANGLE_MAX" not in names)
pilot.mav.set_mode_send(1, 1, pilot.link.mode_mapping()["STEERING"])
pilot.expect("STEERING by SET_MODE", ("HEARTBEAT",), lambda m: m.custom_mode == 3)
pilot.arm()
home = pilot.expect("global position", ("GLOBAL_POSITION_INT",))


def speed():
    now = pilot.here()
    return math.hypot(now.vx, now.vy)


def home_again(seconds):
    pilot.expect("home", ("LOCAL_POSITION_NED",), lambda p: math.hypot(p.x, p.y) < 2.5, seconds)
    pilot.mode("HOLD")


# a file of a ground station, in the old encoding
rows = [
    (0, 0, WAYPOINT, 0, home.lat, home.lon), (0, RELATIVE, WAYPOINT, 0, home.lat + NORTH_10_M, home.lon),
    (0, RELATIVE, WAYPOINT, 2, home.lat + NORTH_10_M, home.lon + EAST_10_M), (0, RELATIVE, RETURN, 0, 0, 0),
]  # fmt: skip
lines = [
    f"{seq}\t{current}\t{frame}\t{command}\t{p1}\t0\t0\t0\t{lat * 1e-7:.7f}\t{lon * 1e-7:.7f}\t0\t1"
    for seq, (current, frame, command, p1, lat, lon) in enumerate(rows)
]
file = Path(tempfile.mkdtemp()) / "rover.waypoints"
file.write_text("\n".join(["QGC WPL 110", *lines]) + "\n")
loader = mavwp.MAVWPLoader(target_system=1, target_component=1)
check("file", loader.load(str(file)) == len(rows))
pilot.link.waypoint_clear_all_send()
check("cleared", pilot.expect("acknowledged", ("MISSION_ACK",)).type == 0)
pilot.link.waypoint_count_send(loader.count())
for _ in rows:
    request = pilot.expect("request", ("MISSION_REQUEST", "MISSION_REQUEST_INT"))
    pilot.mav.send(loader.wp(request.seq))
check("taken", pilot.expect("acknowledged", ("MISSION_ACK",)).type == 0)
pilot.link.waypoint_request_list_send()
check("count", pilot.expect("count", ("MISSION_COUNT",)).count == len(rows))
for seq, row in enumerate(rows):
    pilot.link.waypoint_request_send(seq)
    item = pilot.expect(f"item {seq}", ("MISSION_ITEM",), lambda m, k=seq: m.seq == k)
    check("command", (item.command, item.param1) == (row[2], row[3]), item)
pilot.mav.mission_ack_send(1, 1, 0)
pilot.link.set_mode_auto()
pilot.expect("AUTO", ("HEARTBEAT",), lambda m: m.custom_mode == 10)
pilot.expect("item 1", ("MISSION_ITEM_REACHED",), lambda m: m.seq == 1, 30.0)
pilot.expect("item 2 is stayed at", ("LOCAL_POSITION_NED",), lambda p: p.y > 8 and math.hypot(p.vx, p.vy) < 0.1, 30.0)
pilot.expect("item 3", ("MISSION_CURRENT",), lambda m: m.seq == 3, 10.0)
home_again(40.0)

# a plan of QGroundControl: the planned home is item 0
PLAN = (
    (0, WAYPOINT, (0, 0, 0, 0), home.lat, home.lon, 584),
    (MISSION, CHANGE_SPEED, (1, 0.7, -1, 0), 0, 0, 0),
    (RELATIVE, WAYPOINT, (0, 0, 0, math.nan), home.lat + NORTH_10_M, home.lon, 0),
    (MISSION, DELAY, (3, -1, -1, -1), 0, 0, 0),
    (MISSION, SET_REVERSE, (1, 0, 0, 0), 0, 0, 0),
    (RELATIVE, WAYPOINT, (0, 0, 0, math.nan), home.lat, home.lon, 0),
    (MISSION, SET_REVERSE, (0, 0, 0, 0), 0, 0, 0),
    (MISSION, JUMP, (2, 1, 0, 0), 0, 0, 0),
    (MISSION, RETURN, (0, 0, 0, 0), 0, 0, 0),
)
count = len(PLAN)
pilot.mav.mission_count_send(1, 1, count, 0)
for expected in range(count):
    asked = pilot.expect("request", ("MISSION_REQUEST", "MISSION_REQUEST_INT"))
    check("in order", asked.seq == expected)
    frame, command, params, x, y, z = PLAN[asked.seq]
    pilot.mav.mission_item_int_send(1, 1, asked.seq, frame, command, int(asked.seq == 0), 1, *params, x, y, z, 0)
check("plan", pilot.expect("acknowledged", ("MISSION_ACK",)).type == 0)
pilot.mav.mission_request_list_send(1, 1, 0)
check("count", pilot.expect("count", ("MISSION_COUNT",)).count == count)
for seq, row in enumerate(PLAN):
    pilot.mav.mission_request_int_send(1, 1, seq, 0)
    item = pilot.expect(f"item {seq}", ("MISSION_ITEM_INT",), lambda m, k=seq: m.seq == k)
    frame = 0 if row[0] == MISSION else row[0]  # what has no place comes back in frame 0
    check("as sent", (item.command, item.frame, item.param1) == (row[1], frame, row[2][0]), item)
pilot.mav.mission_ack_send(1, 1, 0, 0)
pilot.mav.mission_set_current_send(1, 1, 0)  # else it goes on at the number where the one before was left
check("start", pilot.command(START, 0, 0) == 0)
pilot.expect("AUTO", ("HEARTBEAT",), lambda m: m.custom_mode == 10)
pilot.wait((), seconds=6.0)
check("speed of the plan", abs(speed() - 0.7) < 0.12, speed())
pilot.expect("first corner", ("MISSION_ITEM_REACHED",), lambda m: m.seq == 2, 30.0)
# a do-command behind an item takes its MISSION_ITEM_REACHED, as in ArduPilot
pilot.expect("delay is over", ("MISSION_CURRENT",), lambda m: m.seq == 5, 10.0)
pilot.wait((), seconds=6.0)
yaw, now = pilot.expect("attitude", ("ATTITUDE",)).yaw, pilot.here()
check("backwards", now.vx * math.cos(yaw) + now.vy * math.sin(yaw) < -0.3, (now.vx, now.vy, yaw))
pilot.expect("back", ("MISSION_CURRENT",), lambda m: m.seq == 2, 40.0)
pilot.expect("once more", ("MISSION_ITEM_REACHED",), lambda m: m.seq == 2, 60.0)
pilot.mode("HOLD")  # QGroundControl's pause
pilot.mav.mission_set_current_send(1, 1, 8)
pilot.expect("current 8", ("MISSION_CURRENT",), lambda m: m.seq == 8)
pilot.mode("AUTO")
home_again(60.0)

# "go to location" of older ground stations: a mission item with current 2
pilot.mode("GUIDED")
north = home.lat + NORTH_10_M
pilot.mav.mission_item_send(1, 1, 0, RELATIVE, WAYPOINT, 2, 1, 0, 0, 0, 0, north * 1e-7, home.lon * 1e-7, 0)
check("taken", pilot.expect("acknowledged", ("MISSION_ACK",)).type == 0)
pilot.expect("there", ("GLOBAL_POSITION_INT",), lambda g: abs(g.lat - north) < 180, 40.0)
pilot.link.set_mode_rtl()
pilot.expect("RTL", ("HEARTBEAT",), lambda m: m.custom_mode == 11)
home_again(40.0)
pilot.link.arducopter_disarm()
pilot.disarmed(3.0)
pilot.link.reboot_autopilot()
check("reboot", pilot.expect("answer", ("COMMAND_ACK",), lambda a: a.command == 246).result == 0)
pilot.stream(2, "SYSTEM_TIME")
check("the clock began anew", pilot.expect("time", ("SYSTEM_TIME",)).time_boot_ms < 10000)
check("disarmed", not pilot.expect("heartbeat", ("HEARTBEAT",)).base_mode & ARMED)
