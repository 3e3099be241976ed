# SPDX-License-Identifier: BSD-3-Clause
"""Plays what a run has learnt, without learning and without exploring: rewards, laps, crashes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np

from sitl.core.elementary import atan2
from sitl.envs.judge import ESTIMATE
from sitl.errors import SitlError

from . import algorithms, environments
from .algorithms import Policy
from .errors import AgentError
from .runs.evaluation_plan import EPISODES, EvaluationPlan
from .runs.folder import RunFolder
from .runs.local import SendProgress, Stopped

CENTRES = {"circuit": (2.0, -1.9), "circuit2": (-1.7, -3.5), "circuit2c": (-1.7, -3.5), "round": (0.8, -2.25)}
"""World -> x, y of a position inside the central solids [m]."""


def rounded(reward: float) -> str:
    """A mean reward for people: with one decimal below 100."""
    return f"{reward:.1f}" if abs(reward) < 100.0 else f"{reward:.0f}"


class LapCounter:
    """Counts the turns of a path around a position.

    Args:
        centre: x, y [m].
    """

    def __init__(self, centre: tuple[float, float]) -> None:
        self._centre = centre
        self._angle: float | None = None
        self.turned = 0.0
        """Accumulated angle, positive clockwise [rad]."""

    def take(self, x: float, y: float) -> None:
        """Add the next position of the path [m], less than half a turn from the last."""
        angle = atan2(y - self._centre[1], x - self._centre[0])
        if self._angle is not None:
            self.turned += math.remainder(self._angle - angle, 2.0 * math.pi)
        self._angle = angle

    @property
    def laps(self) -> float:
        """Net number of turns, in the predominant direction."""
        return abs(self.turned) / (2.0 * math.pi)


Pose = tuple[float, float, float]
"""x, y [m], yaw [rad]."""


@dataclass(frozen=True)
class Played:
    """Result of one episode."""

    reward: float
    steps: int
    terminated: bool
    """The episode ended by itself: a crash, or a goal reached."""
    crashed: bool
    reached: bool
    """The task was solved: a goal reached (False for tasks without one)."""
    simulated_s: float
    laps: float
    """Net turns around the centre of the world; nan in worlds without laps."""
    judge: str = ""
    """By what success was judged: "truth", where the robot really was; "estimate", where it believed to be; "":
    unknown, of an environment of another kind."""


@dataclass(frozen=True)
class Evaluation:
    """Results of several episodes."""

    episodes: tuple[Played, ...]

    @property
    def mean_reward(self) -> float:
        """Mean reward of an episode."""
        return float(np.mean([played.reward for played in self.episodes]))

    @property
    def crash_rate(self) -> float:
        """Share of the episodes that ended in a crash, 0 .. 1."""
        return float(np.mean([played.crashed for played in self.episodes]))

    @property
    def mean_laps(self) -> float:
        """Mean number of whole laps of an episode; nan where laps are not counted."""
        return float(np.mean([math.floor(p.laps) if p.laps == p.laps else math.nan for p in self.episodes]))

    @property
    def lap_rate(self) -> float:
        """Share of the episodes with a whole lap or more and no crash, 0 .. 1."""
        return float(np.mean([played.laps >= 1.0 and not played.crashed for played in self.episodes]))

    @property
    def mean_simulated_s(self) -> float:
        """Mean simulated time of an episode [s]."""
        return float(np.mean([played.simulated_s for played in self.episodes]))

    def sentence(self) -> str:
        """Summary in one line."""
        count = len(self.episodes)
        crashes = sum(played.crashed for played in self.episodes)
        parts = [f"{count} episodes: mean reward {rounded(self.mean_reward)}", f"{crashes} crashes"]
        if not math.isnan(self.mean_laps):
            parts.append(f"{self.mean_laps:.1f} laps per episode")
            parts.append(f"{100.0 * self.lap_rate:.0f} % of the episodes with a lap or more and no crash")
        ended = sum(played.terminated and not (played.crashed or played.reached) for played in self.episodes)
        if ended:
            parts.append(f"{ended} terminated otherwise")
        if any(played.reached for played in self.episodes):
            judged = " by the estimate" if any(played.judge == ESTIMATE for played in self.episodes) else ""
            parts.append(f"success{judged} in {sum(played.reached for played in self.episodes)}")
        if not math.isnan(self.mean_simulated_s):
            parts.append(f"{self.mean_simulated_s:.0f} simulated s per episode")
        return ", ".join(parts)


def evaluate(
    env: gym.Env[Any, Any],
    policy: Policy,
    episodes: int = EPISODES,
    seed: int = 0,
    poses: Sequence[Pose] | None = None,
    watch: Callable[[Played], None] = lambda played: None,
    first: int = 0,
) -> Evaluation:
    """Play episodes.

    Args:
        env: it must truncate its episodes.
        policy: policy that plays.
        episodes: number of episodes.
        seed: seed of the resets and of the policy's own choices.
        poses: where the episodes start, in turn; None: where the environment says.
        watch: called after each episode.
        first: number of the first one; each follows from its number and the seed alone.

    Raises:
        AgentError: the policy is of other spaces than the environment.
    """
    policy.check(env.observation_space, env.action_space)
    played = []
    for episode in range(first, first + episodes):
        one = environments.seed_of(seed, episode)
        options = {"pose": poses[episode % len(poses)]} if poses else None
        played.append(play(env, policy, one, options))
        watch(played[-1])
    return Evaluation(tuple(played))


class Interrupted(SitlError):
    """Raised to end an evaluation between two episodes."""


def until_stopped(send_progress: SendProgress, stopped: Stopped) -> Callable[[Played], None]:
    """A ``watch`` callback that sends 1 after each episode, and raises Interrupted when the work is asked to stop."""

    def watch(played: Played) -> None:
        send_progress(1)
        if stopped():
            raise Interrupted

    return watch


def play(env: gym.Env[Any, Any], policy: Policy, seed: int, options: Mapping[str, Any] | None = None) -> Played:
    """Play one episode."""
    observation, _ = env.reset(seed=seed, options=None if options is None else dict(options))
    policy.begin(seed)
    inner: Any = env.unwrapped
    centre = CENTRES.get(getattr(getattr(inner, "world", None), "name", ""))
    counter = None if centre is None else LapCounter(centre)
    total, steps = 0.0, 0
    while True:
        if counter is not None:
            counter.take(*inner.robot.pose[0, :2].tolist())
        observation, reward, terminated, truncated, info = env.step(policy.act(observation))
        total, steps = total + float(reward), steps + 1
        if terminated or truncated:
            break
    if counter is not None:
        counter.take(*inner.robot.pose[0, :2].tolist())
    return Played(
        reward=total,
        steps=steps,
        terminated=bool(terminated),
        crashed=bool(info.get("crashed", False)),  # an environment of another kind knows of no crashes
        reached=bool(info.get("is_success", info.get("reached", False))),
        simulated_s=steps * environments.step_time(env),
        laps=math.nan if counter is None else counter.laps,
        judge=environments.judged_by(env),
    )


@contextmanager
def stage(
    run: RunFolder, plan: EvaluationPlan, seed: int = 0
) -> Iterator[tuple[gym.Env[Any, Any], Policy, list[Pose] | None]]:
    """Environment, policy and (where the plan moves them) start poses for the evaluation of a run.

    Raises:
        AgentError: no model, or an environment that cannot be made.
    """
    config = run.config.with_(max_steps=plan.max_steps or run.config.max_steps)
    env = environments.make(config, **plan.options)
    try:
        poses = moved_starts(env, plan.episodes, seed, plan.jitter) if plan.jitter > 0.0 else None
        yield env, algorithms.policy_of(run), poses
    finally:
        env.close()


def evaluate_run(run: RunFolder, plan: EvaluationPlan | None = None, seed: int = 0) -> Evaluation:
    """Play the learnt policy of a run.

    Args:
        run: run that has a model.
        plan: how; None: as the run says.
        seed: seed of the evaluation.

    Raises:
        AgentError: no model, or not of this environment.
    """
    plan = plan or run.config.evaluation
    with stage(run, plan, seed) as (env, policy, poses):
        return evaluate(env, policy, plan.episodes, seed, poses)


def moved_starts(
    env: gym.Env[Any, Any] | gym.vector.VectorEnv[Any, Any, Any], count: int, seed: int, jitter: float
) -> list[Pose]:
    """Start poses near the environment's own.

    Raises:
        AgentError: it is no environment with poses.
    """
    inner: Any = env.unwrapped
    if not hasattr(inner, "robot"):
        raise AgentError(f"{env}: start poses of this environment cannot be moved")
    env.reset(seed=seed)
    x, y, _, yaw = inner.robot.pose[0].tolist()
    moves = np.random.default_rng([seed, 1]).uniform(-jitter, jitter, (count, 3)).tolist()
    return [(x + dx, y + dy, yaw + turn) for dx, dy, turn in moves]
