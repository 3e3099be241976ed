# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.deployment [NAME...] [--ardupilot FOLDER]``: shipped policies out of their simulation.

Each flies the same episodes where it was learnt, in process, and by ``sitl deploy`` on ``sitl run``; with --ardupilot
also on a real ArduPilot with its own physics, and on one that our physics carries. Between episodes the vehicle flies
back (``--reset return``). The guard is so wide that it limits nothing: what differs is the vehicle and its link.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from benchmarks.baselines.shipped import share
from benchmarks.manoeuvres import executable
from sitl import vehicles
from sitl.agents import baselines, environments, learnt
from sitl.agents.deploy import Deployed, deploy, fly, neutral
from sitl.agents.learnt import Learnt
from sitl.agents.report.statistics import Z
from sitl.client import Client
from sitl.client.connection import connect
from sitl.foreign.process import free_tcp_run

HOME_PLACE = (-35.363262, 149.165237, 584.0, 0.0)
FRAMES = {"copter": "ardupilot_quad", "rover": "ardupilot_rover"}
POLICIES = ("copter-hover", "copter-waypoint", "copter-course", "copter-land", "rover-waypoint")
WIDE = {"radius": 200.0, "floor": -20.0, "ceiling": 100.0, "speed": 20.0, "climb": 10.0, "late": 60.0}
"""A guard within whose limits the policies stay."""
IN_PROCESS, RUN, REAL, CARRIED = "in process", "sitl run", "ArduPilot", "ArduPilot on our physics"
PORTS = 4
"""An ArduPilot listens on so many from its base port; its second serial line is two above."""


@contextlib.contextmanager
def run(kind: str, speedup: float, autopilot: Path | None = None) -> Iterator[tuple[Client, str]]:
    """``sitl run``: a pilot's client, and the connection that is left for the policy.

    Args:
        kind: of vehicle.
        speedup: simulated seconds a second.
        autopilot: program of an ArduPilot; None: our own.
    """
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "sitl", "run", kind, "--speedup", f"{speedup:g}", "--tcp", "0", "--tcp", "0",
                 "--out", "none", "--quiet", "--log-dir", folder]  # fmt: skip
        words += ["--autopilot", f"ardupilot:{autopilot}"] if autopilot else []
        paths = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        with subprocess.Popen(words, cwd=folder, stdout=subprocess.PIPE, text=True, env=paths) as process:
            try:
                assert process.stdout is not None
                lines = (line for line in process.stdout if "MAVLink on tcp:" in line)
                first, second = (next(lines).rpartition(" ")[2].strip() for _ in range(2))
                pilot = Client(connect(first, patience=60.0, warn=lambda text: None))
                yield pilot, second
                pilot.close()
            finally:
                process.terminate()


@contextlib.contextmanager
def real(folder: Path, kind: str, speedup: float) -> Iterator[tuple[Client, str]]:
    """The same of a real ArduPilot with its own physics."""
    port, params = free_tcp_run(PORTS), vehicles.load(FRAMES[kind]).parameters
    path = executable.find(folder, kind)
    with executable.started(path, kind, HOME_PLACE, 20, params, port=port) as connection:
        pilot = Client(connection)
        pilot.wait_ready()
        pilot.params["SIM_SPEEDUP"] = speedup
        yield pilot, f"tcp:127.0.0.1:{port + 2}"


def at_home(policy: Learnt, episodes: int) -> Deployed:
    """The same episodes in process."""
    env = environments.make(neutral(policy))
    out = Deployed()
    try:
        out.episodes = [fly(env, policy.policy, seed, out) for seed in range(episodes)]
    finally:
        env.close()
    return out


def abroad(policy: Learnt, pilot: Client, connection: str, episodes: int, take_off: float) -> Deployed:
    """A pilot brings the vehicle to where episodes begin; the policy takes over."""
    pilot.wait_ready()
    if take_off:
        pilot.take_off(take_off)
    else:
        pilot.guided_and_armed()
    pilot.delay(5.0)
    return deploy(policy, connection, episodes=episodes, reset="return", guard=WIDE)


def row(name: str, where: str, flown: Deployed, home: Deployed, step_time: float) -> str:
    """A row of the table."""
    rewards = np.array([one.reward for one in flown.episodes])
    cells = [name, where, share(sum(one.solved for one in flown.episodes), len(rewards)), f"{rewards.mean():.1f}"]
    if flown is home or len(rewards) < len(home.episodes):
        cells.append("")
    else:
        other = rewards - np.array([one.reward for one in home.episodes])
        cells.append(f"{other.mean():+.1f} ± {Z * other.std(ddof=1) / len(other) ** 0.5:.1f}")
    cells.append(f"{np.mean([one.seconds for one in flown.episodes]):.1f}")
    cells.append(f"{np.mean([one.off_path for one in flown.episodes]):.2f}")
    cells.append(f"{100 * np.mean(np.array(flown.periods) > 1.1 * step_time):.0f} %")
    return f"| {' | '.join(cells)} |"


def rows(name: str, folder: Path | None, episodes: int, speedup: float) -> Iterator[str]:
    """Rows of a policy."""
    policy = learnt.load(baselines.find(name))
    kind = name.partition("-")[0]
    env = environments.make(neutral(policy))
    take_off = float(env.unwrapped.session.robot._options.take_off) if kind == "copter" else 0.0  # type: ignore[attr-defined]
    env.close()
    home = at_home(policy, episodes)
    yield row(name, IN_PROCESS, home, home, policy.step_time)
    places = {RUN: run(kind, speedup)}
    if folder is not None:
        places[REAL] = real(folder, kind, speedup)
        places[CARRIED] = run(kind, speedup, executable.find(folder, kind))
    for where, begun in places.items():
        with begun as (pilot, connection):
            flown = abroad(policy, pilot, connection, episodes, take_off)
        yield row(name, where, flown, home, policy.step_time)
        if flown.handed_over:
            print(f"{name}, {where}: {flown.handed_over}", file=sys.stderr)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.deployment", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"default: {', '.join(POLICIES)}")
    parser.add_argument("--ardupilot", type=Path, metavar="FOLDER", help="of a real arducopter and ardurover")
    parser.add_argument("--episodes", type=int, default=20, metavar="N", help="default 20")
    parser.add_argument("--speedup", type=float, default=2.0, metavar="K", help="simulated seconds a second, default 2")
    options = parser.parse_args(arguments)
    if options.episodes < 2:
        parser.error(f"--episodes {options.episodes}: it must be 2 or more")
    warnings.filterwarnings("ignore", message=".*clock cannot be held")
    head = ("policy", "vehicle", "success", "return", "paired difference", "seconds", "off the straight line [m]")
    print(f"| {' | '.join(head)} | late steps |")
    print("|---|---|---:|---:|---:|---:|---:|---:|")
    for name in options.names or POLICIES:
        for line in rows(name, options.ardupilot, options.episodes, options.speedup):
            print(line, flush=True)


if __name__ == "__main__":
    main()
