# SPDX-License-Identifier: BSD-3-Clause
"""A MAVProxy session with a rover, typed into its console."""

import sys
import time

from console import Console

MISSION = """QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t-35.363262\t149.165237\t584.0\t1
1\t0\t3\t178\t1\t1.0\t0\t0\t0\t0\t0\t1
2\t0\t3\t16\t0\t0\t0\t0\t-35.363170\t149.165237\t0\t1
3\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1
"""

console = Console(sys.argv[1])
say, expect = console.say, console.expect
(console.folder / "mission.txt").write_text(MISSION)
say("param show CRUISE_SPEED", "CRUISE_SPEED")
say("param set FS_GCS_ENABLE 0")
say(f"wp load {console.folder / 'mission.txt'}", "ACCEPTED")
say("wp list", "Saved 4 waypoints")
say("mode manual", "DO_SET_MODE: ACCEPTED")
say("arm throttle", "ARMED")
say("rc 3 1700")
time.sleep(3.0)
say("rc 1 1700")
say("rc all 0")
say("mode guided", "DO_SET_MODE: ACCEPTED")
say("guided -35.363170 149.165300 0", "DO_REPOSITION: ACCEPTED")
time.sleep(15.0)
say("velocity 1 0 0")
say("mode auto", "Mission: 1 ChangeSpeed")
expect("Reached waypoint #2", 60.0)
expect("Mission: 3 RTL", 10.0)
expect("Mission Complete", 60.0)
say("mode smart_rtl", "DO_SET_MODE: ACCEPTED")
say("mode hold", "DO_SET_MODE: ACCEPTED")
say("disarm", "DISARMED")
console.end()
