# SPDX-License-Identifier: BSD-3-Clause
"""Prints the table of docs/scripts-in-simulated-time.md for the MAVSDK generation of an interpreter.

    python -m tests.warp.measure [--python OTHER_PYTHON] 1 5 20 50 100 max

Run from the root of the repository; needs pymavlink here, and mavsdk 4, mavsdk 3 or mavsdk-grpc there.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Callable

from sitl.warp import ClockPage, Pacer, preload_library, start_script
from tests.warp.drive import SCRIPTS
from tests.warp.fake_vehicle import FakeVehicle

LAND, TERMINATE = 21, 185

COLUMNS = (
    "| speed-up | reached | heartbeat [s] | off-board set-point [ms] | retransmission [s] | TIMEOUT [s] | "
    "link lost [s] | mission upload [s] | speed factor |\n|---|---|---|---|---|---|---|---|---|"
)


def row(python: str, script: str, speedup: float | str) -> str:
    """Fly the script once; returns one line of the table."""
    vehicle = FakeVehicle()
    vehicle.deaf, vehicle.silent_on = {LAND}, TERMINATE
    with ClockPage() as page:
        pacer = Pacer(page, speedup)
        start, sim_us = time.monotonic(), 0
        child = start_script(
            [python, str(SCRIPTS / script), str(vehicle.port)],
            page,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        while child.poll() is None:
            sim_us += pacer.slice_us
            vehicle.advance_to(sim_us)
            pacer.pace(sim_us)
        reached = sim_us / 1e6 / (time.monotonic() - start)
        lines = [line for line in child.communicate()[0].splitlines() if line.startswith("{")]
    vehicle.close()
    if not lines:
        return f"| {speedup} | failed |"
    m = json.loads(lines[0])
    beats = vehicle.intervals("HEARTBEAT")[1:]  # the first is shorter at any speed
    setpoints = vehicle.intervals("SET_POSITION_TARGET_LOCAL_NED")
    repeats = vehicle.intervals(f"COMMAND_{LAND}")
    mean = sum(setpoints) / len(setpoints)
    cells = (
        speedup,
        f"{reached:.0f}x",
        f"{min(beats):.2f}..{max(beats):.2f}",
        f"{1e3 * mean:.1f}, at most {1e3 * max(setpoints):.0f}",
        f"{min(repeats):.2f}..{max(repeats):.2f}",
        f"{m['land_s']:.2f}" if "TIMEOUT" in m["land"] else m["land"],
        f"{m['lost_s']:.1f}",
        f"{m['upload_s']:.2f}",
        f"{m['speed_factor']:.3f}",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def main(say: Callable[[str], None] = print) -> None:
    """Measure at each speed-up given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("speedups", nargs="+", help='numbers, or "max"')
    parser.add_argument("--python", default=sys.executable, help="interpreter that has the MAVSDK to measure")
    options = parser.parse_args()
    native = subprocess.run([options.python, "-c", "import mavsdk.plugins"], capture_output=True).returncode == 0
    preload_library()  # compile before the clock starts
    say(COLUMNS)
    for speedup in options.speedups:
        script = "native_mavsdk.py" if native else "grpc_mavsdk.py"
        say(row(options.python, script, speedup if speedup == "max" else float(speedup)))


if __name__ == "__main__":
    main()
