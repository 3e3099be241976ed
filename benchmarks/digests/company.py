# SPDX-License-Identifier: BSD-3-Clause
"""Several vehicles at once: fleets, swarms and their environments; and shipped policies that fly."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from typing import Any

import numpy as np
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from . import tree
from .leaves import leaves
from .pilot import CLIENT
from .robots import Steps

TASKS = ("formation", "crossing", "pursuit", "escort")
POLICIES = (
    "copter-forest", "copter-gates", "copter-hover-discrete", "copter-land-moving", "copter-reach-goal",
    "rover-labyrinth-discrete", "rover-parking", "rover-slalom",
)  # fmt: skip


class Vehicles(Steps):
    """Digests of the records of several vehicles."""

    def look(self, dtype: np.dtype[Any], records: bytes, count: int) -> None:
        """Take those of now."""
        for leaf in leaves(np.dtype([("vehicles", dtype, (count,))])):
            self.record.add(self.step, leaf.path, leaf.wide(records))


def fleet(frame: str, count: int = 3, seconds: int = 40) -> Vehicles:
    """A vehicle boots and sets out; the fleet begins there, each with noise and a velocity of its own, one fails."""
    pilot = tree.locate("Client", "sitl.client.client")(tree.locate("Simulation", "sitl.simulation")(frame, seed=3))
    pilot.wait_ready()
    if pilot.simulation.kind.name == "copter":
        pilot.take_off(10.0)
    else:
        pilot.set_mode("GUIDED")
        pilot.arm()
    fleet = tree.locate("Fleet", "sitl.fleet")(frame, count, threads=2, seed=3)
    for k in range(count):
        fleet.put(k, pilot.simulation.snapshot(), seed=k)
    taken, mav = Vehicles(), mavlink.MAVLink(None, srcSystem=CLIENT, srcComponent=190)
    for taken.step in range(seconds):
        if taken.step == seconds // 2:
            fleet.fail(1, "gps/garbage@0..5")
        for k in range(count):
            way = math.tau * k / count + 0.1 * taken.step
            message = mav.set_position_target_local_ned_encode(
                0, 1, 1, 1, 0x5C7, 0, 0, 0, 2 * math.cos(way), 2 * math.sin(way), 0, 0, 0, 0, 0, 0.1 * k
            )
            fleet.send(k, bytes(message.pack(mav)))
        fleet.advance(1.0)
        fleet.drop_telemetry()
        taken.look(fleet.records.dtype, fleet.records.tobytes(), count)
    fleet.close()
    pilot.simulation.close()
    return taken


def swarm_task(name: str, steps: int = 100) -> Vehicles:
    """An environment of a swarm, on random actions."""
    env = tree.locate("SwarmEnv", "sitl.envs.swarm.parallel")(name, steps=steps)
    taken, random = Vehicles(), np.random.default_rng(5)
    taken.add("observation", env.reset(seed=5)[0])
    for taken.step in range(1, steps + 1):
        actions = {a: random.uniform(-1.0, 1.0, env.action_space(a).shape).astype(np.float32) for a in env.agents}
        given = env.step(actions)
        for what, value in zip(("observation", "reward", "terminated", "truncated"), given):
            taken.add(what, value)
        if not env.agents:
            taken.add("observation", env.reset()[0])
    env.close()
    return taken


def policy(name: str, episodes: int = 4) -> Steps:
    """A shipped policy: what each episode comes to."""
    taken, path = Steps(), tree.root() / f"sitl/agents/baselines/{name}.npz"
    found = tree.locate("rollout", "sitl.agents.rollout")(path, episodes=episodes, seed=1000)
    for taken.step, played in enumerate(found.episodes):
        # By what success was judged is no part of the flight, and has no bits that could differ.
        taken.add("episode", {name: value for name, value in asdict(played).items() if name != "judge"})
    return taken


def flights() -> dict[str, Callable[[], Steps]]:
    """All of them, by name."""
    return {
        **{f"fleet/{frame}": partial(fleet, frame) for frame in ("erle_copter", "erle_rover")},
        **{f"swarm/{name}": partial(swarm_task, name) for name in TASKS},
        **{f"policy/{name}": partial(policy, name) for name in POLICIES},
    }
