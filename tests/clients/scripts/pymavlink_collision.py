# SPDX-License-Identifier: BSD-3-Clause
"""Two copters are sent into each other by pymavlink; both tell that they were hit."""

import sys
import time

from pymavlink import mavutil

mavlink = mavutil.mavlink
POSITION_ONLY = 0xDF8
link = mavutil.mavlink_connection(sys.argv[1])
heights: dict[int, float] = {}
hits: dict[int, str] = {}
accepted: set[tuple[int, int]] = set()
located: set[int] = set()


def listen(what: str, condition, seconds: float) -> None:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            sys.exit(f"FAILED: {what}: {heights} {hits}")
        message = link.recv_match(blocking=True, timeout=1.0)
        if message is None:
            continue
        system, kind = message.get_srcSystem(), message.get_type()
        if kind == "LOCAL_POSITION_NED":
            heights[system] = -message.z
        elif kind == "EKF_STATUS_REPORT" and message.flags & mavlink.EKF_POS_HORIZ_ABS:
            located.add(system)
        elif kind == "COMMAND_ACK" and message.result == mavlink.MAV_RESULT_ACCEPTED:
            accepted.add((system, message.command))
        elif kind == "STATUSTEXT" and "Hit obstacle" in message.text:
            hits[system] = message.text
    print("ok:", what, flush=True)


class Sent:
    """A command to both, again each second until it is accepted."""

    def __init__(self, number: int, params: tuple[int, ...]) -> None:
        self.number, self.params, self.next = number, (*params, *(0,) * (7 - len(params))), 0.0

    def __call__(self) -> bool:
        waiting = {1, 2} - {system for system, number in accepted if number == self.number}
        if time.monotonic() > self.next:
            self.next = time.monotonic() + 1.0
            for system in waiting:
                link.mav.command_long_send(system, 1, self.number, 0, *self.params)
        return not waiting


listen("both know where they are", lambda: located == {1, 2}, 120.0)
for number, params in (
    (mavlink.MAV_CMD_DO_SET_MODE, (1, 4)),
    (mavlink.MAV_CMD_COMPONENT_ARM_DISARM, (1,)),
    (mavlink.MAV_CMD_NAV_TAKEOFF, (0, 0, 0, 0, 0, 0, 5)),
):
    listen(f"command {number}", Sent(number, params), 90.0)
listen("both are in the air", lambda: min(heights.values()) > 4.5, 60.0)
assert not hits
for system, east in ((1, 20.0), (2, -14.0)):  # from their starts, which are 6 m apart
    frame = mavlink.MAV_FRAME_LOCAL_NED
    link.mav.set_position_target_local_ned_send(0, system, 1, frame, POSITION_ONLY, 0, east, -5, *(0,) * 8)
listen("both were hit", lambda: set(hits) == {1, 2}, 30.0)
print(hits)
