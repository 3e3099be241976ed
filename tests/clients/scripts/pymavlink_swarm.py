# SPDX-License-Identifier: BSD-3-Clause
"""Three copters on one link, by pymavlink: parameters and commands to one, a command to all, and FOLLOW."""

import math
import sys
import time

from pymavlink import mavutil

mavlink = mavutil.mavlink
POSITION_ONLY = 0xDF8
FOLLOW = 23
METRES = 1e-7 * 111_319.5
EAST = math.cos(math.radians(35.363262))
FOLLOWER = {b"FOLL_ENABLE": 1.0, b"FOLL_SYSID": 1.0, b"FOLL_OFS_X": -6.0, b"FOLL_OFS_TYPE": 0.0, b"FOLL_ALT_TYPE": 1.0}
link = mavutil.mavlink_connection(sys.argv[1])
places: dict[int, tuple[float, float, float]] = {}
"""North, east [m] of a place that is the same for all, height [m] above home."""


def check(what: str, ok: object, seen: object = "") -> None:
    print(f"{'ok' if ok else 'FAILED'}: {what} {seen}", flush=True)
    if not ok:
        sys.exit(1)


def collect(kind: str, wanted: set[int], seconds: float, fits=lambda message: True) -> dict:
    """The first message of a kind that fits from each of these systems."""
    found: dict = {}
    end = time.monotonic() + seconds
    while set(found) != wanted and time.monotonic() < end:
        message = link.recv_match(type=[kind, "GLOBAL_POSITION_INT"], blocking=True, timeout=1.0)
        if message is None:
            continue
        sender = message.get_srcSystem()
        if message.get_type() == "GLOBAL_POSITION_INT":
            places[sender] = (message.lat * METRES, message.lon * METRES * EAST, message.relative_alt * 1e-3)
        if message.get_type() == kind and sender in wanted and fits(message):
            found[sender] = message
    check(f"{kind} of {sorted(wanted)}", set(found) == wanted, sorted(found))
    return found


def command(number: int, target: int, *params: float, answers: set[int] | None = None) -> None:
    link.mav.command_long_send(target, 1, number, 0, *params, *(0.0,) * (7 - len(params)))
    acks = collect("COMMAND_ACK", answers or {target}, 10.0, lambda message: message.command == number)
    check(f"command {number} to {target}", all(ack.result == 0 for ack in acks.values()))


collect("HEARTBEAT", {1, 2, 3}, 10.0)
command(mavlink.MAV_CMD_REQUEST_MESSAGE, 0, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION, answers={1, 2, 3})
for name, value in FOLLOWER.items():
    link.mav.param_set_send(2, 1, name, value, mavlink.MAV_PARAM_TYPE_REAL32)
    set_at = collect("PARAM_VALUE", {2}, 5.0, lambda m, name=name: m.param_id == name.decode())
    check(name.decode(), set_at[2].param_value == value)
READY = mavlink.MAV_SYS_STATUS_PREARM_CHECK
collect("EKF_STATUS_REPORT", {1, 2, 3}, 120.0, lambda m: m.flags & mavlink.EKF_POS_HORIZ_ABS)
collect("SYS_STATUS", {1, 2, 3}, 60.0, lambda m: m.onboard_control_sensors_health & READY)
for system in (1, 2):
    command(mavlink.MAV_CMD_DO_SET_MODE, system, 1, 4)
    command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, system, 1)
    command(mavlink.MAV_CMD_NAV_TAKEOFF, system, 0, 0, 0, 0, 0, 0, 5)
collect("LOCAL_POSITION_NED", {1, 2}, 60.0, lambda m: m.z < -4.5)
command(mavlink.MAV_CMD_DO_SET_MODE, 2, 1, FOLLOW)
link.mav.set_position_target_local_ned_send(
    0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, POSITION_ONLY, 0, 30, -5, 0, 0, 0, 0, 0, 0, 0, 0
)
collect("LOCAL_POSITION_NED", {1}, 60.0, lambda m: abs(m.y - 30.0) < 0.5)
collect("GLOBAL_POSITION_INT", {2}, 60.0, lambda m: math.dist(places[2][:2], (places[1][0] - 6.0, places[1][1])) < 2.0)
check("the third one stands", places[1][1] - places[3][1] > 20.0 and abs(places[3][2]) < 1.0, places)
