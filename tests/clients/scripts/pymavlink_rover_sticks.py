# SPDX-License-Identifier: BSD-3-Clause
"""Driving by the sticks in every mode that has them: RC overrides and MANUAL_CONTROL, by pymavlink."""

import math
import sys

from pilot import ARMED, Pilot, check

pilot = Pilot(sys.argv[1])
mapping = pilot.link.mode_mapping()
check("modes of a rover", mapping["HOLD"] == 4 and mapping["SMART_RTL"] == 12 and "LAND" not in mapping)
pilot.link.param_set_send("CIRC_RADIUS", 6)
pilot.arm()


def hold(seconds, steer=1500, throttle=1500):
    sticks = (steer, 65535, throttle, 65535)  # 65535: not touched
    pilot.fly_for(seconds, lambda: pilot.mav.rc_channels_override_send(1, 1, *sticks, 0, 0, 0, 0))


def attitude():
    return pilot.expect("attitude", ("ATTITUDE",))


def ahead():
    """Speed along the nose [m/s]."""
    yaw, now = attitude().yaw, pilot.here()
    return now.vx * math.cos(yaw) + now.vy * math.sin(yaw)


for name in ("MANUAL", "STEERING", "ACRO"):
    pilot.mode(name)
    hold(4, throttle=1700)
    check(f"{name}: throttle ahead", ahead() > 0.4, ahead())
    hold(3, steer=1700, throttle=1700)
    check(f"{name}: steering right", attitude().yawspeed > 0.05, attitude().yawspeed)
    hold(6, throttle=1300)
    check(f"{name}: throttle back", ahead() < -0.3, ahead())
    hold(5)
    check(f"{name}: stops", abs(ahead()) < 0.15, ahead())
pilot.mode("SIMPLE")
hold(6, throttle=1700)
check("SIMPLE: drives", ahead() > 0.3, ahead())
pilot.mode("LOITER")
hold(6)
check("LOITER: stops", abs(ahead()) < 0.15, ahead())
pilot.mode("CIRCLE")
hold(15)
check("CIRCLE: goes round", abs(attitude().yawspeed) > 0.08 and ahead() > 0.3, (attitude().yawspeed, ahead()))

pilot.mode("MANUAL")
pilot.mav.rc_channels_override_send(1, 1, *(0,) * 8)  # the sticks are given back
hold(0.2)
pilot.fly_for(4, lambda: pilot.mav.manual_control_send(1, 0, 0, 400, 0, 0), 0.1)
check("MANUAL_CONTROL: ahead", ahead() > 0.4, ahead())
pilot.fly_for(3, lambda: pilot.mav.manual_control_send(1, 0, -500, 400, 0, 0), 0.1)
check("MANUAL_CONTROL: left", attitude().yawspeed < -0.05, attitude().yawspeed)
pilot.fly_for(6, lambda: pilot.mav.manual_control_send(1, 0, 0, -400, 0, 0), 0.1)
check("MANUAL_CONTROL: back", ahead() < -0.3, ahead())
pilot.fly_for(1, lambda: pilot.mav.manual_control_send(1, 0, 0, 400, 0, 0), 0.1)

pilot.fly_for(2, lambda: pilot.mav.manual_control_send(1, 0, 0, 0, 0, 0), 0.1)
pilot.mode("SMART_RTL")
pilot.expect("home on its own track", ("LOCAL_POSITION_NED",), lambda p: math.hypot(p.x, p.y) < 2.0, 120.0)
pilot.mode("MANUAL")
pilot.fly_for(4, lambda: pilot.mav.manual_control_send(1, 0, 0, 400, 0, 0), 0.1)
pilot.link.arducopter_disarm()
pilot.disarmed(3.0)  # a rover may be, while it moves
pilot.wait((), seconds=4.0)
check("rolled to a stop", abs(ahead()) < 0.1, ahead())
pilot.mav.manual_control_send(1, 0, 0, 0, 0, 0)
pilot.link.arducopter_arm()
pilot.expect("armed again", ("HEARTBEAT",), lambda m: m.base_mode & ARMED, 5.0)
pilot.link.arducopter_disarm()
pilot.disarmed(3.0)
