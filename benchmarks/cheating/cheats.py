# SPDX-License-Identifier: BSD-3-Clause
"""Policies that do not do the task. They know what no agent knows: the true state, and where the goal really is."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import product
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.agents import baselines, learnt
from sitl.envs.ids import FIRST, NEW
from sitl.envs.presets import PRESETS

Rows = npt.NDArray[Any]
Policy = Callable[[Any], Rows]
"""Actions of all robots for their observations."""
NEAR, RING = 4.0, 1.7
"""A robot begins to circle so far from where the goal counts [m]; it does at so many radii."""
RADIUS = 1.0
"""Of goals whose task names none [m]."""


class Stage:
    """A vector environment, and how its robots are told to fly.

    Args:
        env: many robots of an id.
        preset: of the id, without its version.
    """

    def __init__(self, env: Any, preset: str) -> None:
        self.env, self.count, self.preset = env, env.num_envs, preset
        session = env.unwrapped.session
        self.robot, self.task, self.action = session.robot, session.task, session.action
        self.is_discrete = isinstance(env.single_action_space, gym.spaces.Discrete)

    def velocities(self, wanted: Rows) -> Rows:
        """Actions for velocities forward, left, up [m/s], turn [rad/s], shape (count, 4): as near as there are any."""
        if self.is_discrete:
            table = np.asarray(self.action.table)
            scale = np.maximum(np.abs(table).max(axis=0), 1e-9)
            apart = (wanted[:, None, : table.shape[1]] - table) / scale
            return (apart * apart).sum(axis=2).argmin(axis=1)
        low, high = np.array(self.action.limits).T
        share = 2.0 * (wanted[:, self.action.columns] - low) / (high - low) - 1.0
        return np.clip(share, -1.0, 1.0).astype(np.float32)

    def towards(self, way: Rows, speed: float) -> Rows:
        """Actions along ways in the world [m], shape (count, 3): a rover turns to them."""
        yaw = self.robot.true_state()[:, 3]
        c, s = np.cos(yaw), np.sin(yaw)
        out = np.zeros((self.count, 4))
        out[:, 0], out[:, 1], out[:, 2] = way[:, 0] * c + way[:, 1] * s, way[:, 1] * c - way[:, 0] * s, way[:, 2]
        out[:, :3] *= speed / np.maximum(np.sqrt((out[:, :3] ** 2).sum(axis=1, keepdims=True)), 1e-9)
        if not self.task.flies:
            angle = np.arctan2(out[:, 1], out[:, 0])
            out[:, 0], out[:, 1], out[:, 3] = speed * np.maximum(np.cos(angle), 0.3), 0.0, np.clip(2.0 * angle, -1, 1)
        return self.velocities(out)

    def goal(self) -> Rows:
        """Way from each robot to its goal as it really is [m], shape (count, 3)."""
        way: Rows = self.task.axes * (self.task.targets - self.robot.true_state()[:, :3])
        return way

    def baseline(self) -> Policy:
        """The trained policy that comes with the package."""
        found = learnt.policy_of(baselines.file(baselines.of_preset(self.preset))).many(self.count)
        found.begin(np.arange(self.count), list(range(self.count)))
        return found.act


def options_of(preset: str) -> dict[str, Any]:
    """Options of the environment that the trained policy of a preset was trained with: how it observes, and its worlds,
    or it would be measured where it cannot do the task."""
    config = learnt.load(baselines.file(baselines.of_preset(preset))).config
    return {"world": PRESETS[(NEW | FIRST)[config.env].preset]()["world"], **config.env_options}


def _constant(velocity: tuple[float, ...]) -> Callable[[Stage], Policy]:
    def begin(stage: Stage) -> Policy:
        actions = stage.velocities(np.tile(velocity, (stage.count, 1)))
        return lambda seen: actions

    return begin


def _always(action: Rows, stage: Stage) -> Policy:
    actions = np.tile(action, (stage.count, *(1 for _ in action.shape)))
    return lambda seen: actions


def _drawn(stage: Stage) -> Policy:
    stage.env.action_space.seed(0)
    return lambda seen: stage.env.action_space.sample()


def _out(stage: Stage) -> Policy:
    """Away from the goal, out of the arena."""
    away = np.zeros((stage.count, 3))

    def act(seen: Any) -> Rows:
        if not away.any():
            away[:, :2] = -np.sign(stage.goal()[:, :2]) * (1.0, 0.3)
        return stage.towards(away, 9.0)

    return act


def _crash(stage: Stage) -> Policy:
    """To the nearest thing that the lidar sees; where there is none, straight ahead and down."""

    def act(seen: Any) -> Rows:
        scan, state = stage.robot.scan, stage.robot.true_state()
        nearest = scan.argmin(axis=1)
        heading = state[:, 3] + np.where(np.isfinite(scan.min(axis=1)), stage.robot.angles[nearest], 0.0)
        down = np.where(np.isfinite(scan.min(axis=1)), 0.0, -1.0)
        return stage.towards(np.stack([np.cos(heading), np.sin(heading), down], axis=1), 2.0)

    return act


def _circle(stage: Stage) -> Policy:
    """As the baseline to near the goal, then round it, just outside of where it counts."""
    baseline = stage.baseline()
    radius = float(getattr(stage.task, "pad", getattr(stage.task, "radius", RADIUS)))
    if stage.preset.startswith("rover"):
        radius = max(radius, RADIUS)
    circles = np.zeros(stage.count, np.bool_)

    def act(seen: Any) -> Rows:
        actions, way = np.array(baseline(seen)), stage.goal()
        if hasattr(stage.task, "pad"):
            way[:, 2] += 1.0  # above the pad
        distance = np.sqrt((way[:, :2] ** 2).sum(axis=1))
        circles[distance < radius + NEAR] = True
        in_, round_ = way / np.maximum(distance, 1e-9)[:, None], np.stack([-way[:, 1], way[:, 0], 0 * distance], axis=1)
        wanted = in_ * (distance - RING * radius)[:, None] + 0.5 * round_ / np.maximum(distance, 1e-9)[:, None]
        wanted[:, 2] = way[:, 2]
        theirs = stage.towards(wanted, 0.6)
        actions[circles] = theirs[circles]
        return actions

    return act


def cheats_of(stage: Stage) -> dict[str, Callable[[Stage], Policy]]:
    """Ways to cheat, by name."""
    found: dict[str, Callable[[Stage], Policy]] = {
        "random": _drawn, "fly out": _out, "crash": _crash, "circle the goal": _circle,
    }  # fmt: skip
    if stage.task.flies:
        found["sink and stay"] = _constant((0.0, 0.0, -1.0, 0.0))
    space = stage.env.single_action_space
    corners: Any = range(space.n) if stage.is_discrete else product((-1.0, 1.0), repeat=space.shape[0])
    for corner in corners:
        name = f"always {corner}" if stage.is_discrete else "always " + "".join("-+"[c > 0] for c in corner)
        found[name] = partial(_always, np.asarray(corner, space.dtype))
    return found


def nothing(stage: Stage) -> Policy:
    """Stands, or hovers."""
    return _constant((0.0, 0.0, 0.0, 0.0))(stage)


def baseline(stage: Stage) -> Policy:
    """See ``Stage.baseline``."""
    return stage.baseline()


WRONG = {"gps/wrong=4": 0.0}
"""Faults with which "hide behind the estimate" flies: fixes lie 4 m to the north, and soon the estimate does, too."""
