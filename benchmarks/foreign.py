# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.foreign copter --autopilot ardupilot:PATH``: another autopilot on our physics, and on its own.

Each repeat measures both, one after the other, so that what else the machine does meets both alike: CPU time a
simulated second of our process (user, system) and of the program, and the speed by the wall clock. The vehicle stands
and waits at home; a copter's autopilot works as much there as in the air. ArduPilot's own physics is ``quad`` or
``rover`` at ``--speedup 100``, PX4's is SIH at a factor of 50. Linux only.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import resource
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from sitl.client.connection import Connection, connect
from sitl.client.endpoint import Inbox
from sitl.envs.mavlink.foreign import launch
from sitl.errors import LinkLostError
from sitl.foreign import px4
from sitl.foreign.choice import ARDUPILOT, Choice, choose
from sitl.foreign.process import HOST, AutopilotProcess, free_tcp_run
from sitl.plants.local import stand_alone
from sitl.scenario import DEFAULT_HOME
from sitl.vehicle.kinds import KINDS

MODEL = {"copter": "quad", "rover": "rover"}
"""Of ArduPilot's own physics."""
OWN_SPEEDUP = {"ardupilot": 100, "px4": 50}
UNLOGGED = {"LOG_BACKEND_TYPE": 0.0}
SETTLED_S = 45.0
"""Simulated time before the measurement: the estimator has a position [s]."""


class Cost(NamedTuple):
    """What a simulated second takes [s]."""

    user: float
    system: float
    wall: float

    @property
    def cpu(self) -> float:
        """Of a processor."""
        return self.user + self.system


def own_times() -> tuple[float, float]:
    """(User, system) time of this process [s]."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime, used.ru_stime


def times_of(pid: int) -> tuple[float, float]:
    """(User, system) time of another process [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    tick = os.sysconf("SC_CLK_TCK")
    return int(fields[11]) / tick, int(fields[12]) / tick


def costs(
    clocks: list[Callable[[], tuple[float, float]]], simulated: Callable[[], float], go: Callable[[], None]
) -> list[Cost]:
    """What of each clock a simulated second takes while ``go`` runs."""
    began, wall, before = [clock() for clock in clocks], time.monotonic(), simulated()
    go()
    passed, lasted = simulated() - before, time.monotonic() - wall
    ended = [clock() for clock in clocks]
    return [
        Cost((e[0] - b[0]) / passed, (e[1] - b[1]) / passed, lasted / passed) for b, e in zip(began, ended, strict=True)
    ]


def on_ours(choice: Choice, kind: str, seconds: float) -> list[Cost]:
    """(Our process, the program) on our physics."""
    params = UNLOGGED if choice.kind == ARDUPILOT else {}
    plant = stand_alone(KINDS[kind].default_frame, home=DEFAULT_HOME)
    link = launch(choice, plant, params, Inbox(), 60.0)
    try:
        assert link.process is not None
        pid = link.process.pid

        def go_on(seconds: float) -> None:
            for _ in range(round(seconds * 10)):
                link.run(100_000)

        go_on(SETTLED_S)
        return costs([own_times, lambda: times_of(pid)], lambda: 1e-6 * link.time_us, lambda: go_on(seconds))
    finally:
        link.close()


@contextlib.contextmanager
def alone(choice: Choice, kind: str) -> Iterator[tuple[AutopilotProcess, str]]:
    """The program on its own physics, and where its MAVLink is."""
    home, factor = ",".join(map(str, DEFAULT_HOME)), OWN_SPEEDUP[choice.kind]
    with tempfile.TemporaryDirectory() as folder:
        if choice.kind == ARDUPILOT:
            base = free_tcp_run(8)
            text = "".join(f"{name} {value:g}\n" for name, value in {**UNLOGGED, "FRAME_CLASS": 1}.items())
            words = [str(choice.program), "--model", MODEL[kind], "--speedup", str(factor), "--wipe", "--home", home]
            words += ["--base-port", str(base), "--defaults", "{folder}/vehicle.parm"]
            process, where = (
                AutopilotProcess(words, {"vehicle.parm": text}, {}, Path(folder), 0.0),
                f"tcp:{HOST}:{base}",
            )
        else:
            assert choice.program is not None
            number = px4.free_instance()
            names = {"PX4_SIMULATOR": "sihsim", "PX4_SIM_MODEL": "sihsim_quadx", "PX4_SIM_SPEED_FACTOR": str(factor)}
            words = [str(choice.program), "-i", str(number), "-d", str(choice.program.parent.parent / "etc")]
            process = AutopilotProcess(words, {}, names, Path(folder))
            where = f"udp:{HOST}:{px4.programs_port(number)}"
        try:
            yield process, where
        finally:
            process.stop()


def reach(process: AutopilotProcess, where: str) -> Connection:
    """Its MAVLink, when it is there."""
    while True:
        try:
            return connect(where, Inbox(), 60.0, warn=lambda text: None)
        except LinkLostError:
            process.check()
            time.sleep(0.1)


def on_its_own(choice: Choice, kind: str, seconds: float) -> Cost:
    """The program on its own physics, with a client that reads."""
    with alone(choice, kind) as (process, where):
        link = reach(process, where)
        try:
            link.request(511, (2, 100_000))  # SYSTEM_TIME, ten times a simulated second

            def simulated() -> float:
                return 1e-6 * link.time_us

            def read(until: float) -> None:
                while simulated() < until:
                    link.listen(20_000)

            read(SETTLED_S)
            (found,) = costs([lambda: times_of(process.pid)], simulated, lambda: read(simulated() + seconds))
            return found
        finally:
            link.close()


def line(name: str, found: list[Cost]) -> None:
    """Print the medians of some repeats."""
    user, system = (1e3 * statistics.median(getattr(cost, name) for cost in found) for name in ("user", "system"))
    print(f"  {name:34s} {user:6.1f} + {system:5.1f} ms of CPU a simulated second", flush=True)


def main() -> None:
    """Print the values."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.foreign", description=__doc__.split("\n\n")[0])
    parser.add_argument("vehicle", choices=tuple(MODEL))
    parser.add_argument("--autopilot", required=True, help='as for "sitl run": ardupilot:PROGRAM, px4:PROGRAM')
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated time of each repeat (default 60)")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="of which the median counts (default 3)")
    options = parser.parse_args()
    if sys.platform != "linux":
        parser.error("the times of another process are read from /proc, which only Linux has")
    choice = choose(options.autopilot, options.vehicle)
    if choice is None or choice.program is None:
        parser.error(f"--autopilot {options.autopilot}: it is no program to start")
    ours: list[Cost] = []
    theirs: list[Cost] = []
    own: list[Cost] = []
    for _ in range(options.repeats):
        a, b = on_ours(choice, options.vehicle, options.seconds)
        ours.append(a)
        theirs.append(b)
        own.append(on_its_own(choice, options.vehicle, options.seconds))
    line("our physics", ours)
    line("the autopilot on it", theirs)
    line("the autopilot on its own physics", own)
    middle = [statistics.median(1.0 / cost.wall for cost in found) for found in (ours, own)]
    shares = [o.cpu / (a.cpu + b.cpu) for a, b, o in zip(ours, theirs, own, strict=True)]
    print(f"  speed by the wall clock: {middle[0]:.1f}x on our physics, {middle[1]:.1f}x on its own")
    print(f"  speed by CPU time of both, of that on its own physics: {statistics.median(shares):.2f}")


if __name__ == "__main__":
    main()
