# SPDX-License-Identifier: BSD-3-Clause
"""A MAVProxy session with a copter, typed into its console."""

import sys
import time

from console import Console

MISSION = """QGC WPL 110
0\t1\t0\t16\t0\t0\t0\t0\t-35.363262\t149.165237\t584.0\t1
1\t0\t3\t22\t0\t0\t0\t0\t0\t0\t10.0\t1
2\t0\t3\t16\t0\t0\t0\t0\t-35.363100\t149.165237\t10.0\t1
3\t0\t3\t20\t0\t0\t0\t0\t0\t0\t0\t1
"""

console = Console(sys.argv[1])
(console.folder / "mission.txt").write_text(MISSION)
console.say("param show RTL_ALT", "RTL_ALT")
console.say("param set FS_GCS_ENABLE 0")
console.say("param fetch", "parameters (ftp)")
console.say(f"wp load {console.folder / 'mission.txt'}", "ACCEPTED")
console.say("wp list", "Saved 4 waypoints")
console.say("ftp list @SYS", "uarts.txt")
console.say("wp clear")
console.say(f"wp ftpload {console.folder / 'mission.txt'}", "Flight plan received")
console.say("wp list", "Saved 4 waypoints")
console.say("mode guided", "DO_SET_MODE: ACCEPTED")
time.sleep(2.0)
console.say("arm throttle", "ARMED")
console.say("takeoff 10", "NAV_TAKEOFF: ACCEPTED")
time.sleep(12.0)
console.say("rc 3 1500")
console.say("mode loiter", "DO_SET_MODE: ACCEPTED")
console.say("rc 3 1700", "height 25")
console.say("rc all 0")
console.say("mode auto", "Mission: 1 Takeoff")
console.say("mode rtl", "DO_SET_MODE: ACCEPTED")
console.expect("DISARMED", 90.0)
console.end()
