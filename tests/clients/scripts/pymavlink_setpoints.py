# SPDX-License-Identifier: BSD-3-Clause
"""All set-points of GUIDED, by pymavlink."""

import math
import sys

from pilot import Pilot, check

POSITION, VELOCITY, ACCELERATION, POSITION_YAW = 0xDF8, 0xDC7, 0xC3F, 0x9F8
LOCAL_NED, LOCAL_OFFSET, BODY, BODY_OFFSET = 1, 7, 8, 9
GLOBAL_RELATIVE, GLOBAL_AMSL = 6, 5
DEGE7_OF_10_M = 898

pilot = Pilot(sys.argv[1])
pilot.take_off()


def local(frame, mask, *values):
    pilot.mav.set_position_target_local_ned_send(0, 1, 1, frame, mask, *values, *(0,) * (11 - len(values)))


def arrive(what, north, east, down):
    to = (north, east, down)
    pilot.expect(what, ("LOCAL_POSITION_NED",), lambda p: math.dist((p.x, p.y, p.z), to) < 0.5, 25.0)


local(LOCAL_NED, POSITION, 10, 0, -10)
arrive("position", 10, 0, -10)
pilot.fly_for(4, lambda: local(LOCAL_NED, VELOCITY, 0, 0, 0, 0, 2, 0))
now = pilot.here()
check("velocity", abs(now.vy - 2) < 0.25 and abs(now.vx) < 0.25, (now.vx, now.vy, now.vz))
pilot.expect("stops without set-points", ("LOCAL_POSITION_NED",), lambda p: abs(p.vy) < 0.1, 8.0)

check("condition yaw", pilot.command(115, 90, 0, 1, 0) == 0)
pilot.expect("nose east", ("ATTITUDE",), lambda a: abs(math.degrees(a.yaw) - 90) < 3)
pilot.fly_for(4, lambda: local(BODY, VELOCITY, 0, 0, 0, 2, 0, 0))
now = pilot.here()
check("velocity ahead is east", abs(now.vy - 2) < 0.3 and abs(now.vx) < 0.4, (now.vx, now.vy, now.vz))
# a hovering copter's estimate wanders by up to 0.1 m/s with its GPS: a tenth of the speed it had is standing
pilot.expect("stands", ("LOCAL_POSITION_NED",), lambda p: math.hypot(p.vx, p.vy) < 0.2, 10.0)

now = pilot.here()
local(BODY_OFFSET, POSITION, 5, 0, 0)
arrive("5 m ahead", now.x, now.y + 5, now.z)
now = pilot.here()
local(LOCAL_OFFSET, POSITION, 5, 0, -2)
arrive("5 m north, 2 m up", now.x + 5, now.y, now.z - 2)
local(LOCAL_NED, POSITION_YAW, 0, 0, -10, 0, 0, 0, 0, 0, 0, 0.5)
arrive("position with yaw", 0, 0, -10)
pilot.expect("yaw", ("ATTITUDE",), lambda a: abs(a.yaw - 0.5) < 0.05)
pilot.fly_for(1.5, lambda: local(LOCAL_NED, ACCELERATION, 0, 0, 0, 0, 0, 0, 1, 0, 0), 0.1)
check("acceleration", pilot.here().vx > 0.6)
pilot.fly_for(2, lambda: local(LOCAL_NED, VELOCITY))

start = pilot.expect("global position", ("GLOBAL_POSITION_INT",))
for frame, height, field in ((GLOBAL_RELATIVE, 12, "relative_alt"), (GLOBAL_AMSL, start.alt / 1e3, "alt")):
    to = start.lat + (DEGE7_OF_10_M if frame == GLOBAL_RELATIVE else 0)
    pilot.mav.set_position_target_global_int_send(0, 1, 1, frame, POSITION, to, start.lon, height, *(0,) * 8)

    def there(message, to=to, field=field, height=height):
        return abs(message.lat - to) < 45 and abs(getattr(message, field) - height * 1e3) < 500

    pilot.expect(f"global position, frame {frame}", ("GLOBAL_POSITION_INT",), there, 20.0)
pilot.mav.command_int_send(1, 1, 3, 192, 0, 0, -1, 1, 0, 0, start.lat + DEGE7_OF_10_M, start.lon, 10)
check("reposition", pilot.expect("answer", ("COMMAND_ACK",), lambda a: a.command == 192).result == 0)
pilot.expect("there", ("GLOBAL_POSITION_INT",), lambda g: abs(g.lat - start.lat - DEGE7_OF_10_M) < 45, 20.0)

ATTITUDE_AND_THRUST, RATES_AND_THRUST = 0x07, 0x80
roll = [math.cos(0.05), math.sin(0.05), 0.0, 0.0]
pilot.fly_for(2, lambda: pilot.mav.set_attitude_target_send(0, 1, 1, ATTITUDE_AND_THRUST, roll, 0, 0, 0, 0.5), 0.05)
now = pilot.expect("attitude", ("ATTITUDE",))
check("roll", abs(now.roll - 0.1) < 0.03, now.roll)
check("thrust 0.5 holds the height", abs(pilot.here().vz) < 0.4)
level = [1.0, 0.0, 0.0, 0.0]
pilot.fly_for(2, lambda: pilot.mav.set_attitude_target_send(0, 1, 1, RATES_AND_THRUST, level, 0, 0, 0.3, 0.5), 0.05)
now = pilot.expect("attitude", ("ATTITUDE",))
check("yaw rate", abs(now.yawspeed - 0.3) < 0.06, now.yawspeed)
pilot.mode("LAND")
pilot.disarmed()
