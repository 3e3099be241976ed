# SPDX-License-Identifier: BSD-3-Clause
"""Everything that a rover takes in GUIDED, by pymavlink."""

import math
import sys

from pilot import Pilot, check

POSITION, VELOCITY, VELOCITY_YAW, VELOCITY_RATE, ACCELERATION = 0xDF8, 0xDC7, 0x9C7, 0x5C7, 0xC3F
LOCAL_NED, LOCAL_OFFSET, BODY, BODY_OFFSET = 1, 7, 8, 9
GLOBAL_RELATIVE, GLOBAL_AMSL = 6, 5
DEGE7_OF_10_M = 898

pilot = Pilot(sys.argv[1])
pilot.arm()


def local(frame, mask, *values):
    pilot.mav.set_position_target_local_ned_send(0, 1, 1, frame, mask, *values, *(0,) * (11 - len(values)))


def arrive(what, north, east, seconds=40.0):
    to = (north, east)
    pilot.expect(what, ("LOCAL_POSITION_NED",), lambda p: math.dist((p.x, p.y), to) < 1.5, seconds)


def stop():
    pilot.expect("stands", ("LOCAL_POSITION_NED",), lambda p: math.hypot(p.vx, p.vy) < 0.1, 12.0)


def attitude():
    return pilot.expect("attitude", ("ATTITUDE",))


def ahead():
    """Speed along the nose [m/s]."""
    yaw, now = attitude().yaw, pilot.here()
    return now.vx * math.cos(yaw) + now.vy * math.sin(yaw)


local(LOCAL_NED, POSITION, 10, 0, 0)
arrive("position", 10, 0)
pilot.fly_for(9, lambda: local(LOCAL_NED, VELOCITY, 0, 0, 0, 0, 1.2, 0))
now = pilot.here()
check("velocity turns the nose", abs(now.vy - 1.2) < 0.2 and abs(now.vx) < 0.2, (now.vx, now.vy))
check("east", abs(math.degrees(attitude().yaw) - 90) < 8)
pilot.expect("said", ("STATUSTEXT",), lambda t: t.text == "target not received last 3secs, stopping", 4.0)
stop()
pilot.fly_for(4, lambda: local(BODY, VELOCITY, 0, 0, 0, 1, 0, 0))
now = pilot.here()
check("velocity ahead is east", abs(now.vy - 1) < 0.2 and abs(now.vx) < 0.2, (now.vx, now.vy))
pilot.fly_for(5, lambda: local(BODY, VELOCITY_RATE, 0, 0, 0, -0.6, 0, 0, 0, 0, 0, 0, 0.1))
check("backwards", -0.8 < ahead() < -0.4, ahead())
check("turn rate", abs(attitude().yawspeed - 0.1) < 0.04, attitude().yawspeed)
pilot.fly_for(7, lambda: local(LOCAL_NED, VELOCITY_YAW, 0, 0, 0, 0.8, 0, 0, 0, 0, 0, 0.0))
check("yaw and speed", abs(attitude().yaw) < 0.15 and abs(ahead() - 0.8) < 0.15, (attitude().yaw, ahead()))

now = pilot.here()
local(LOCAL_OFFSET, POSITION, 8, 0, 0)
arrive("8 m north of here", now.x + 8, now.y)
stop()
yaw, now = attitude().yaw, pilot.here()
local(BODY_OFFSET, POSITION, 6, 0, 0)
arrive("6 m ahead", now.x + 6 * math.cos(yaw), now.y + 6 * math.sin(yaw))
stop()
pilot.fly_for(1, lambda: local(LOCAL_NED, ACCELERATION, 0, 0, 0, 0, 0, 0, 1, 0, 0))
check("no accelerations", any(text.startswith("Ignoring SET_POSITION") for text in pilot.texts) and abs(ahead()) < 0.1)

start = pilot.expect("global position", ("GLOBAL_POSITION_INT",))


def there(lat):
    return lambda g: math.hypot(g.lat - lat, (g.lon - start.lon) * 0.815) < 135


pilot.mav.set_position_target_global_int_send(
    0, 1, 1, GLOBAL_RELATIVE, POSITION, start.lat - DEGE7_OF_10_M, start.lon, 12, *(0,) * 8
)
pilot.expect("global position", ("GLOBAL_POSITION_INT",), there(start.lat - DEGE7_OF_10_M), 40.0)
pilot.mode("HOLD")
for speed, result in ((0.6, 4), (-1.0, 0), (0.6, 0)):  # a speed is taken once it drives to a place
    pilot.mav.command_int_send(1, 1, 3, 192, 0, 0, speed, 1, 0, 0, start.lat, start.lon, 0)
    answer = pilot.expect("answer", ("COMMAND_ACK",), lambda a: a.command == 192).result
    check(f"reposition at {speed:g}", answer == result, answer)
pilot.wait((), seconds=14.0)  # it turns round
check("as fast as told", abs(ahead() - 0.6) < 0.15, ahead())
check("speed", pilot.command(178, 1, 1.0, -1) == 0)
pilot.expect("there", ("GLOBAL_POSITION_INT",), there(start.lat), 40.0)

check("yaw speed is none of it", pilot.command(213, 180, 0.8, 0, 0) == 3)
check("reverse", pilot.command(194, 1) == 0)

HEADING_AND_SPEED, RATE_AND_SPEED = 0x07, 0x83
south = [0.0, 0.0, 0.0, 1.0]
pilot.fly_for(9, lambda: pilot.mav.set_attitude_target_send(0, 1, 1, HEADING_AND_SPEED, south, 0, 0, 0, 0.6), 0.2)
full = pilot.parameter("WP_SPEED")
check("heading", abs(attitude().yaw) > math.pi - 0.15, attitude().yaw)
check("thrust is a share of WP_SPEED", abs(ahead() - 0.6 * full) < 0.15, (ahead(), full))
level = [1.0, 0.0, 0.0, 0.0]
pilot.fly_for(4, lambda: pilot.mav.set_attitude_target_send(0, 1, 1, RATE_AND_SPEED, level, 0, 0, 0.25, -0.5), 0.2)
check("turn rate", abs(attitude().yawspeed - 0.25) < 0.08, attitude().yawspeed)
check("and backwards", abs(ahead() + 0.5 * full) < 0.2, ahead())

pilot.mode("HOLD")
stop()
pilot.link.arducopter_disarm()
pilot.disarmed(3.0)
