# SPDX-License-Identifier: BSD-3-Clause
"""A learnt policy on a vehicle at a connection: another simulator, a real autopilot on our physics, or a real vehicle.

The vehicle is treated as ``sitl.envs`` treats it there: its reset is the caller's choice, a guard stands between the
policy and the vehicle, and at the end, or when anything goes wrong, its own modes take over.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from sitl.envs.mavlink.guard import Deed

from . import environments
from .errors import AgentError
from .learnt import Learnt

SIMULATED = ("autopilot", "autopilot_path", "begin", "faults", "gcs", "latency", "params", "physics", "randomise",
             "start", "threads")  # fmt: skip
"""Options of an environment that a simulator has and a vehicle at a connection has not: they are left out."""
SLOW = 1.5
"""Steps that take so many times as long as those that the policy was learnt with are told of."""


@dataclass
class Deployed:
    """What came of it."""

    episodes: list[tuple[int, float, bool]] = field(default_factory=list)
    """Steps, sum of rewards, and whether the task was solved, of each episode."""
    deeds: list[Deed] = field(default_factory=list)
    """What the guard did."""
    handed_over: str = ""
    """Why the policy lost the vehicle before the last episode's end; "": it did not."""
    thinking: list[float] = field(default_factory=list)
    """Wall time of the policy for each step [s]."""
    periods: list[float] = field(default_factory=list)
    """Time of the vehicle from step to step [s]."""

    def sentences(self, step_time: float) -> list[str]:
        """The result in lines; ``step_time``: what the policy was learnt with [s]."""
        lines = []
        for k, (steps, reward, solved) in enumerate(self.episodes):
            lines.append(f"episode {k}: {steps} steps, reward {reward:.1f}, {'solved' if solved else 'not solved'}")
        if self.periods:
            median, slow = np.percentile(self.periods, (50, 95))
            thought = 1e3 * np.percentile(self.thinking, (50, 99))
            lines.append(
                f"steps of {median:.3f} s (95 %: {slow:.3f} s; learnt with {step_time:.3f} s), "
                f"policy {thought[0]:.2f} ms (99 %: {thought[1]:.2f} ms)"
            )
            if slow > SLOW * step_time:
                lines.append("steps came later than those that the policy was learnt with: expect it to do worse")
        if self.handed_over:
            lines.append(f"handed over: {self.handed_over}")
        return lines


def options_of(learnt: Learnt, given: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Options of the environment for a connection, and the names of those of the policy that are left out."""
    kept = {name: value for name, value in learnt.config.env_options.items() if name not in SIMULATED}
    out = [name for name in learnt.config.env_options if name in SIMULATED]
    return {**kept, **given}, out


def deploy(
    learnt: Learnt,
    connection: str,
    *,
    episodes: int = 1,
    max_steps: int | None = None,
    reset: str = "none",
    guard: Mapping[str, Any] | None = None,
    wait: float = 60.0,
    options: Mapping[str, Any] | None = None,
    clock: Callable[[], float] = time.perf_counter,
) -> Deployed:
    """Let a policy act on a vehicle.

    Args:
        learnt: the policy.
        connection: of the vehicle: "udp:HOST:PORT", "udpout:HOST:PORT", "tcp:HOST:PORT", "serial:DEVICE:BAUD".
        episodes: how many are played.
        max_steps: of an episode; None: as it was learnt.
        reset: what is done to the vehicle at the beginning of each (``sitl.envs.robots.vehicles.AutopilotOptions``).
        guard: arguments of ``sitl.envs.mavlink.guard.Guard``.
        wait: how long "none" and "return" wait for the vehicle [s].
        options: of the environment, in place of those that it was learnt with.
        clock: wall time [s].

    Raises:
        AgentError: an environment or option that cannot be.
        sitl.errors.NotReadyError, NotASimulatorError, LinkLostError: of the vehicle.
    """
    if (max_steps is not None and max_steps < 1) or episodes < 1:
        raise AgentError(f"episodes = {episodes}, max_steps = {max_steps}; they must be 1 or more")
    made, _ = options_of(learnt, options or {})
    config = learnt.config.with_(env_options=made, max_steps=max_steps or learnt.config.max_steps)
    env = environments.make(config, connection=connection, reset=reset, guard=dict(guard or {}), wait=wait)
    out, inner = Deployed(), cast(Any, env.unwrapped)
    try:
        learnt.policy.check(env.observation_space, env.action_space)
        for episode in range(episodes):
            if not _play(env, learnt, episode, out, clock):
                break
    finally:
        env.close()  # hands over
        watch = inner.robot.watch
        out.deeds = list(watch.deeds) if watch is not None else []
    return out


def _play(env: Any, learnt: Learnt, episode: int, out: Deployed, clock: Callable[[], float]) -> bool:
    """One episode; whether the policy still has the vehicle."""
    observation, info = env.reset(seed=episode)
    learnt.policy.begin(episode)
    robot: Any = env.unwrapped.robot
    steps, total, ended, before = 0, 0.0, False, None
    while not ended:
        began = clock()
        action = learnt.policy.act(observation)
        out.thinking.append(clock() - began)
        observation, reward, terminated, truncated, info = env.step(action)
        now = 1e-3 * robot.link(0).inbox.position[0]
        if before is not None:
            out.periods.append(now - before)
        before, steps, total, ended = now, steps + 1, total + float(reward), terminated or truncated
        if "handed_over" in info:
            out.handed_over = str(info["handed_over"])
            break
    out.episodes.append((steps, total, bool(info.get("is_success", False))))
    return not out.handed_over
