# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.in_worlds``: what a world and a lidar cost a vehicle with autopilot, one core, one process.

Each row is simulated seconds per second of CPU time, a copter that hovers and a rover that stands armed; the repeats
take turns, so that what else the machine does meets all rows alike. Medians.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable

from benchmarks.recorded.pilot import Pilot
from sitl.simulation import Core, Simulation, load_core
from sitl.vehicle.kinds import KINDS

VEHICLES = {"copter": ("erle_copter", "office_erlecopter"), "rover": ("erle_rover", "maze_erlerover")}
SECONDS = 40.0
"""Simulated, a run."""


def ready(frame: str, world: str | None, core: Core, scans_hz: float = 0.0) -> Pilot:
    """A vehicle under way, silent but for scans."""
    pilot = Pilot(Simulation(frame, world=world, core=core))
    pilot.boot()
    pilot.arm()
    if core.kind.name == "copter":
        pilot.send_command("NAV_TAKEOFF", altitude=1.2)
        pilot.fly(8.0)
    pilot.send("REQUEST_DATA_STREAM", target_system=1, target_component=1)
    for name in ("LOCAL_POSITION_NED", "ATTITUDE", "EKF_STATUS_REPORT", "SYS_STATUS"):
        pilot.set_rate(name, 0.0)
    pilot.set_rate("DEBUG_FLOAT_ARRAY", scans_hz)
    pilot.simulation.advance(0.1)
    return pilot


def whole(pilot: Pilot) -> Callable[[], float]:
    """The whole simulation; goes back afterwards."""
    simulation, snapshot = pilot.simulation, pilot.simulation.snapshot()

    def run() -> float:
        start = time.process_time()
        simulation.advance(SECONDS)
        taken = time.process_time() - start
        pilot.connection.endpoint.receive()
        simulation.restore(snapshot)
        return SECONDS / taken

    return run


def core_alone(pilot: Pilot) -> Callable[[], float]:
    """The compiled core without lidar and messages; goes back afterwards."""
    simulation, snapshot = pilot.simulation, pilot.simulation.snapshot()
    advance, ticks = simulation.core.bind(simulation.fleet, simulation.index), int(SECONDS * 400)

    def run() -> float:
        start = time.process_time()
        first = int(simulation.v.tick)
        while int(simulation.v.tick) - first < ticks:
            simulation.v.autopilot.events.attention = False
            advance(ticks)
        taken = time.process_time() - start
        simulation.restore(snapshot)
        return SECONDS / taken

    return run


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.in_worlds", description=__doc__)
    parser.add_argument("--repeats", type=int, default=7, metavar="N", help="of each row")
    repeats = parser.parse_args().repeats
    print("| vehicle | | without a world | in its world | and LASER at 10 Hz |\n|---|---|---|---|---|")
    for kind, (frame, world) in VEHICLES.items():
        core = load_core(KINDS[kind])
        plain, inside, scanning = ready(frame, None, core), ready(frame, world, core), ready(frame, world, core, 10.0)
        runs = [core_alone(plain), core_alone(inside), whole(plain), whole(inside), whole(scanning)]
        taken = [[run() for run in runs] for _ in range(repeats)]
        a, b, c, d, e = (statistics.median(row[k] for row in taken) for k in range(len(runs)))
        print(f"| `{frame}` | core alone | {a:,.0f}x | {b:,.0f}x | |")
        print(f"| `{frame}` | with bridge; in a world with its lidar | {c:,.0f}x | {d:,.0f}x | {e:,.0f}x |")


if __name__ == "__main__":
    main()
