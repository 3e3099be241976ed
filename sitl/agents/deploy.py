# SPDX-License-Identifier: BSD-3-Clause
"""A learnt policy on a vehicle at a connection: another simulator, a real autopilot on our physics, or a real vehicle.

The vehicle is treated as ``sitl.envs`` treats it there: its reset is the caller's choice, a guard stands between the
policy and the vehicle, and at the end, or when anything goes wrong, its own modes take over.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, cast

import numpy as np

from sitl.core.sums import lengths
from sitl.envs.judge import ESTIMATE
from sitl.envs.mavlink.guard import Deed, Guard
from sitl.envs.rewards import Floats
from sitl.envs.targets.landing import Land
from sitl.envs.targets.moving import MovingTask
from sitl.envs.targets.target_task import TargetTask

from . import environments
from .algorithms import Policy
from .errors import AgentError
from .learnt import Learnt
from .runs.config import RunConfig

SIMULATED = ("autopilot", "autopilot_path", "begin", "faults", "gcs", "latency", "params", "physics", "randomise",
             "start", "threads")  # fmt: skip
"""Options of an environment that a simulator has and a vehicle at a connection has not: they are left out."""
REPLACED = (*SIMULATED, "connection", "guard", "reset", "wait")
"""Options that ``deploy`` leaves out or gives itself: what a policy's file says of them is not used."""
NEUTRAL = {"faults": None, "latency": 0.0, "randomise": None, "start": None}
"""Those of them that an environment may have by its id."""
SLOW = 1.5
"""Steps that take so many times as long as those that the policy was learnt with are reported."""


class Flown(NamedTuple):
    """An episode."""

    steps: int
    reward: float
    """Sum of all."""
    solved: bool
    """Whether the task was."""
    seconds: float
    """Time of the vehicle [s]."""
    off_path: float
    """Mean distance from the straight path through the task's positions, after each step [m]; nan: it has none."""


@dataclass
class Deployed:
    """What came of it."""

    episodes: list[Flown] = field(default_factory=list)
    """All that were played."""
    deeds: list[Deed] = field(default_factory=list)
    """What the guard did."""
    handed_over: str = ""
    """Why the policy lost the vehicle before the last episode's end; "": it did not."""
    thinking: list[float] = field(default_factory=list)
    """Wall time of the policy for each step [s]."""
    periods: list[float] = field(default_factory=list)
    """Time of the vehicle from step to step [s]."""
    judge: str = ESTIMATE
    """By what success was judged (``sitl.envs.judge``): nobody knows where a vehicle at a connection really is."""

    def sentences(self, step_time: float) -> list[str]:
        """The result in lines; ``step_time``: what the policy was learnt with [s]."""
        lines, judged = [], " by its own estimate" if self.judge == ESTIMATE else ""
        for k, flown in enumerate(self.episodes):
            off = "" if math.isnan(flown.off_path) else f", {flown.off_path:.2f} m off the straight path"
            lines.append(
                f"episode {k}: {flown.steps} steps, {flown.seconds:.1f} s, reward {flown.reward:.1f}, "
                f"{'solved' if flown.solved else 'not solved'}{judged}{off}"
            )
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


def neutral(learnt: Learnt, given: Mapping[str, Any] | None = None, max_steps: int | None = None) -> RunConfig:
    """What the policy was learnt in, without all that a vehicle at a connection has not; ``given`` options replace
    those that are left."""
    made = {**NEUTRAL, **options_of(learnt, given or {})[0]}
    return learnt.config.with_(env_options=made, max_steps=max_steps or learnt.config.max_steps)


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
    out: Deployed | None = None,
) -> Deployed:
    """Let a policy act on a vehicle. However it ends, short of SIGKILL, the vehicle is handed over to the guard's mode.

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
        out: is filled in, for a caller who wants to know what came of it when this raises; None: a new one.

    Raises:
        AgentError: an environment or option that cannot be.
        sitl.errors.NotReadyError, NotASimulatorError, LinkLostError: of the vehicle.
    """
    if (max_steps is not None and max_steps < 1) or episodes < 1:
        raise AgentError(f"episodes = {episodes}, max_steps = {max_steps}; they must be 1 or more")
    config = neutral(learnt, options or {}, max_steps)
    env = environments.make(config, connection=connection, reset=reset, guard=dict(guard or {}), wait=wait)
    out, inner = Deployed() if out is None else out, cast(Any, env.unwrapped)
    try:
        learnt.policy.check(env.observation_space, env.action_space)
        _check_floor(inner, guard or {})
        learnt.policy.begin(0)
        learnt.policy.act(env.observation_space.sample())  # the first call of anything is slow
        for episode in range(episodes):
            out.episodes.append(fly(env, learnt.policy, episode, out, clock))
            if out.handed_over:
                break
    finally:
        env.close()  # hands over
        watch = inner.robot.watch
        out.deeds = list(watch.deeds) if watch is not None else []
    return out


def _check_floor(env: Any, guard: Mapping[str, Any]) -> None:
    """Refuse a task that lands above a floor. Raises AgentError."""
    floor = Guard(**guard).floor
    if getattr(env.task, "lands", False) and floor > 0.0:
        raise AgentError(
            f"the policy is to land, and the guard's floor is {floor:g} m above the ground: --guard floor=-5 lets it "
            "down"
        )


def fly(env: Any, policy: Policy, seed: int, out: Deployed, clock: Callable[[], float] = time.perf_counter) -> Flown:
    """Play an episode, of a vehicle at a connection or of any other of this package's.

    Args:
        env: the environment; it must truncate its episodes.
        policy: that plays.
        seed: of the episode.
        out: gets periods, times of the policy, and why the policy lost the vehicle.
        clock: wall time [s].
    """
    observation, info = env.reset(seed=seed)
    policy.begin(seed)
    out.judge = environments.judged_by(env)
    robot: Any = env.unwrapped.robot
    positions = _positions(env.unwrapped.task)
    steps, total, ended, before = 0, 0.0, False, float(robot.time[0])
    trail = [robot.pose[0, :3].copy()]
    while not ended:
        began = clock()
        action = policy.act(observation)
        out.thinking.append(clock() - began)
        observation, reward, terminated, truncated, info = env.step(action)
        now = float(robot.time[0])
        if steps > 0:
            out.periods.append(now - before)
        before, steps, total, ended = now, steps + 1, total + float(reward), terminated or truncated
        trail.append(robot.pose[0, :3].copy())
        if "handed_over" in info:
            out.handed_over = str(info["handed_over"])
            break
    off = math.nan if positions is None else _off(np.array(trail), np.vstack([trail[:1], positions]))
    return Flown(steps, total, bool(info.get("is_success", False)), before, off)


def _positions(task: Any) -> Floats | None:
    """x, y, z of a task's positions [m], shape (n, 3); None: it has none, or they move."""
    moves = isinstance(task, MovingTask) and not isinstance(task, Land)
    return task.positions[0].copy() if isinstance(task, TargetTask) and not moves else None


def _off(points: Floats, path: Floats) -> float:
    """Mean distance of points from a line through others, shapes (n, 3), (k, 3) [m]."""
    a, legs = path[:-1], np.diff(path, axis=0)
    along = ((points[:, None] - a) * legs).sum(2) / np.maximum((legs * legs).sum(1), 1e-12)
    nearest = a + np.clip(along, 0.0, 1.0)[..., None] * legs
    return float(lengths(points[:, None] - nearest).min(1).mean())
