# SPDX-License-Identifier: BSD-3-Clause
"""Flying by the sticks: RC overrides and MANUAL_CONTROL, by pymavlink."""

import math
import sys

from pilot import Pilot, check

pilot = Pilot(sys.argv[1])
pilot.take_off(15.0)


def hold(seconds, roll=1500, pitch=1500, throttle=1500, yaw=1500):
    sticks = (roll, pitch, throttle, yaw)
    pilot.fly_for(seconds, lambda: pilot.mav.rc_channels_override_send(1, 1, *sticks, 0, 0, 0, 0))


def speed():
    now = pilot.here()
    return math.hypot(now.vx, now.vy)


hold(0.4)
for name in ("LOITER", "ALT_HOLD"):
    pilot.mode(name)
    hold(1)
    hold(3, pitch=1300)
    check(f"{name}: stick ahead", speed() > 1.0, speed())
    hold(3)
    hold(3, throttle=1700)
    check(f"{name}: climbs", pilot.here().vz < -0.3)
    hold(3)
    check(f"{name}: holds the height", abs(pilot.here().vz) < 0.2)
pilot.mode("STABILIZE")
hold(1.5, roll=1600, throttle=1450)
check("STABILIZE: roll", pilot.expect("attitude", ("ATTITUDE",)).roll > 0.05)
pilot.mode("LOITER")
hold(3)
pilot.fly_for(4, lambda: pilot.mav.manual_control_send(1, 500, 0, 500, 0, 0), 0.1)
check("MANUAL_CONTROL: stick ahead", speed() > 1.0, speed())
pilot.fly_for(2, lambda: pilot.mav.manual_control_send(1, 0, 0, 500, 0, 0), 0.1)
pilot.mode("LAND")
pilot.mav.rc_channels_override_send(1, 1, *(0,) * 8)
pilot.disarmed()
