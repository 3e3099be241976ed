# SPDX-License-Identifier: BSD-3-Clause
"""Unmodified scripts in simulated time: their sleeps, dates and time-outs follow the simulation, not the
wall.

    with ClockPage() as page:                        # the clock; stands still until the first publish
        pacer = Pacer(page, speedup=50)              # or "max"
        script = start_script([sys.executable, "mission.py"], page)
        while script.poll() is None:
            sim_us += pacer.slice_us                 # how far to simulate now
            vehicle.advance_to(sim_us)               # the simulator's own work: physics, autopilot, MAVLink
            pacer.pace(sim_us)                       # publishes the clock, sleeps out the rest of the slice
    print(script.returncode)

The simulator's own process is not warped: `time.monotonic` there is the wall clock.
"""

from sitl.warp.build import CannotBuild, preload_library
from sitl.warp.launch import script_environment, start_script
from sitl.warp.pace import Pacer
from sitl.warp.page import ClockPage, PageReader

__all__ = [
    "CannotBuild",
    "ClockPage",
    "PageReader",
    "Pacer",
    "preload_library",
    "script_environment",
    "start_script",
]
