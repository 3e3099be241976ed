# SPDX-License-Identifier: BSD-3-Clause
"""One run under one change: episodes are played, or the reason why they cannot be is recorded."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sitl.core.algebra import euler_of
from sitl.core.elementary import cos, sin
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.envs.robots.turtlebot import Turtlebot
from sitl.errors import MissingExtra, OptionError, VehicleError
from sitl.vehicles import Airframe
from sitl.worlds.contact import clearance
from sitl.worlds.shapes import to_ned

from .. import environments, learnt
from ..errors import AgentError
from ..evaluate import Interrupted, Played, evaluate, moved_starts, until_stopped
from ..runs.config import RunConfig
from ..runs.folder import RunFolder
from ..runs.local import SendProgress, Stopped
from .change import Change, is_covered
from .policies import run_of

MARGIN = 0.05
"""Distance beyond the crash range from which a crash is a false alarm [m]."""
_HALF_SLICE = 0.01
"""Half height of the slice around the lidar that is looked at [m]."""


def is_false_alarm(env: Any) -> bool:
    """Whether the crash that ended the episode was a lidar reading only: nothing was touched, and nothing was near.

    Args:
        env: environment of this package; no crash is a false alarm where the robot's true position is unknown.
    """
    inner = env.unwrapped
    robot, limit = inner.robot, getattr(inner.task, "limit", math.inf)
    if robot.collided[0] or limit == 0.0:  # no reading is a crash
        return False
    return lidar_distance(robot) > limit + MARGIN


def lidar_distance(robot: Any) -> float:
    """True horizontal distance from the lidar to the nearest solid at its height [m]; 0 where it is unknown."""
    if isinstance(robot, Turtlebot):
        x, y, z, yaw = robot.pose[0].tolist()
        airframe = robot.robots.views[0].airframe
        ahead = float(airframe.lidar_ahead)  # type: ignore[attr-defined]
        position = (x + ahead * cos(yaw), y + ahead * sin(yaw), z + float(airframe.lidar_height))  # type: ignore[attr-defined]
        north, east, down = to_ned(*position)
    elif isinstance(robot, AutopilotRobot) and robot.properties:
        v = robot.view(0)
        body, (forward, right, below) = v.physics.body, v.physics.airframe.lidar_at
        heading = euler_of(body.q).yaw
        c, s = cos(heading), sin(heading)
        north, east, down = body.pos
        north, east = north + forward * c - right * s, east + forward * s + right * c
        down += below - robot.world.floor_z
    else:
        return 0.0
    return clearance(robot.world.geometry, north, east, down - _HALF_SLICE, down + _HALF_SLICE, 0.0).distance


JITTER = 0.1
"""Default distance by which start poses are moved, in x and y [m] and yaw [rad]."""
_REFUSALS = (OptionError, VehicleError, MissingExtra)


@dataclass(frozen=True)
class Trial:
    """A run under one change; picklable."""

    run: Path
    """Folder of a run, or file of a policy."""
    change: Change | None
    """None: without a change."""
    episodes: int
    seed: int = 0
    """Seed of the resets; equal for all trials, so that their episodes are paired."""
    jitter: float | None = None
    """Start poses are moved by up to so much [m, rad]; None: as the run is evaluated, see ``jitter_of``."""
    boots: int | None = None
    """Number of prepared boots of which each episode begins with one; None: as many as the run's environment has."""


@dataclass(frozen=True)
class Result:
    """Result of a trial."""

    rewards: tuple[float, ...] = ()
    """Reward of each episode."""
    crashed: tuple[bool, ...] = ()
    false_alarms: tuple[bool, ...] = ()
    """Crashes that were a reading only, see ``truth``."""
    simulated_s: float = 0.0
    """Simulated time of all episodes together [s]."""
    seen: bool = False
    """Whether the training's randomisation covers the change."""
    refused: str = ""
    """Reason why it was not played; "" when it was."""
    boots: tuple[int, ...] = ()
    """Number of the prepared boot that each episode began with; (): of a robot without an autopilot, or that boots for
    each episode."""


def home_options(config: RunConfig, boots: int | None = None) -> dict[str, Any]:
    """Options of the environment without a change: those of the run's evaluation, without the randomisation of its
    training, so that plain and randomised runs are compared in the same environment.

    Args:
        config: configuration of the run.
        boots: see ``Trial``.
    """
    out = {**config.evaluation.options}
    if boots is not None:
        out["boots"] = boots
    if "randomise" in {**config.env_options, **out}:
        out["randomise"] = None
    return out


def jitter_of(config: RunConfig, robot: Any) -> float:
    """Default distance by which starts are moved [m, rad]: as in the run's evaluation; but a robot without noise that
    always
    starts at one position would repeat the same episode."""
    starts = "start" in {**config.env_options, **config.evaluation.options}
    if config.evaluation.jitter == 0.0 and not starts and isinstance(robot, Turtlebot):
        return JITTER
    return config.evaluation.jitter


def robot_name(config: RunConfig) -> str:
    """Name of the robot of a run.

    Raises:
        AgentError: its environment is none of this package's.
    """
    env = environments.make(config, **home_options(config))
    try:
        return str(_robot(env).name)
    finally:
        env.close()


def check_kind(config: RunConfig, airframe: Airframe) -> None:
    """Whether a run's policy can fly an airframe at all.

    Raises:
        AgentError: it is of another kind of vehicle than the run's robot, or the environment is none of this package's.
    """
    env = environments.make(config, **home_options(config))
    try:
        robot = _robot(env)
        kind = robot.airframe.kind if isinstance(robot, AutopilotRobot) else ""
    finally:
        env.close()
    if kind != airframe.kind:
        raise AgentError(
            f"{airframe.title} is a {airframe.kind}; the policy's environment {config.env} has "
            f"{f'a {kind}' if kind else f'robot {robot.name}, which has no airframe'}"
        )


def attempt(trial: Trial, send_progress: SendProgress, stopped: Stopped) -> Result | None:
    """Play a trial; sends 1 after each episode. None when it was stopped.

    Raises:
        AgentError: it cannot be played at home.
    """
    run = run_of(trial.run)
    config = run.config.with_(max_steps=run.config.evaluation.max_steps or run.config.max_steps)
    try:
        return _play(run, config, trial, send_progress, stopped)
    except Interrupted:
        return None
    except _REFUSALS as error:
        if trial.change is None:
            raise AgentError(f"{run.path} cannot be played at home: {error}") from None
        return Result(refused=str(error))


def _play(run: RunFolder, config: RunConfig, trial: Trial, send_progress: SendProgress, stopped: Stopped) -> Result:
    policy = learnt.policy_of(run.path)
    home = home_options(config, trial.boots)
    options = _options(config, home, trial.change)
    env = environments.make(config, **options)

    robot = _robot(env)
    false_alarms: list[bool] = []
    boots: list[int] = []
    go_on = until_stopped(send_progress, stopped)

    def watch(played: Played) -> None:
        false_alarms.append(played.crashed and is_false_alarm(env))
        if getattr(robot, "boots", 0):
            boots.append(robot.boot_of(0))
        go_on(played)

    try:
        jitter = jitter_of(config, robot) if trial.jitter is None else trial.jitter
        policy.check(env.observation_space, env.action_space)
        poses = moved_starts(env, trial.episodes, trial.seed, jitter) if jitter > 0.0 else None
        found = evaluate(env, policy, trial.episodes, trial.seed, poses, watch).episodes
    finally:
        env.close()
    return Result(
        tuple(played.reward for played in found),
        tuple(played.crashed for played in found),
        tuple(false_alarms),
        math.fsum(played.simulated_s for played in found),
        trial.change is not None and is_covered(options, home, config.env_options.get("randomise")),
        boots=tuple(boots),
    )


def _options(config: RunConfig, home: Mapping[str, Any], change: Change | None) -> Mapping[str, Any]:
    if change is None:
        return home
    env = environments.make(config, **home)
    try:
        return change.env_options(_robot(env), home, env.unwrapped.session.randomisation.ranges)  # type: ignore[attr-defined]
    finally:
        env.close()


def _robot(env: Any) -> Any:
    robot = getattr(env.unwrapped, "robot", None)
    if robot is None:
        raise AgentError(f"{env}: only environments of this package can be changed for a rehearsal")
    return robot
