# SPDX-License-Identifier: BSD-3-Clause
"""Frames of an environment: where its robots are, what the chosen one sees, does and is rewarded with."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from sitl.core.algebra import quat_from_euler
from sitl.core.vectors import Euler, Vec3
from sitl.view import kind
from sitl.view.axes import FLIP
from sitl.view.frame import Company, Frame, Mark, Plan, Points, Stage
from sitl.view.layout import GRID, side_by_side
from sitl.view.record import hits
from sitl.view.shape import Shape, plain
from sitl.view.signals import SignalError
from sitl.worlds import World

from ..arena import flies
from ..robots.robot import Robot, world_of
from ..session import Session
from ..targets.target_task import TargetTask
from ..tasks import ReachGoal

_MOST = 256
"""Numbers of an observation that can be plotted: pictures are not."""
_DRAWN_EVERY = 1.0
"""Worlds of many robots are drawn anew so often, at most [1/s]: with many, there is always one that changes."""
_TURNING = 120.0
"""Speed at which rotors are drawn: robots do not tell it [rad/s]."""


class Captured(NamedTuple):
    """A moment of an environment."""

    chosen: int
    time: float
    """Of the chosen robot's episode [s]."""
    state: Points
    """Of all robots, shape (count, 12): see ``robots.truth``."""
    scan: npt.NDArray[np.float32]
    positions: Points
    """Those that the chosen robot is still to reach, shape (n, 3) [m]."""
    episode: int
    total: float
    """Sum of the rewards of its episode."""
    signals: dict[str, float]
    worlds: tuple[World, ...]
    """Of all robots, where episodes are in several."""


class EnvSource:
    """An environment as the page sees it.

    Args:
        session: of the environment.
        name: of the environment.
    """

    def __init__(self, session: Session, name: str) -> None:
        self._session = session
        self._robot = robot = session.robot
        self.chosen, self.layout, self.episode, self.steps = 0, GRID, 0, 0
        self._wanted: tuple[str, ...] = ()
        self._total = 0.0
        self._observation: Any = None
        count = robot.count
        self._offsets = grid(session)
        shape = shape_of(robot)
        company = (shape,) * count if count > 1 else ()
        copies = self._offsets if count > 1 else None
        self.stage = Stage(name, shape, robot.world, (), flies(robot), company, copies)
        mount = getattr(robot, "camera_mount", None) or (0.0, 0.0, 0.0, 0.0)
        self._lidar, self._ahead = np.array([mount[0], -mount[1], -mount[2]]), float(mount[3])
        self._rotors = (_TURNING, _TURNING, -_TURNING, -_TURNING) * 4
        self._rolled, self._last = np.zeros(2), (0, math.nan)
        self._plan: tuple[bytes, Plan] = (b"", Plan())
        self._drawn: tuple[tuple[World, ...], int, World] | None = None
        """Worlds of all robots, when they were drawn last, and as one."""

    # ------------------------------------------------------------------ where the environment is

    def started(self, index: int) -> None:
        """An episode of a robot begins."""
        if index == self.chosen:
            self._total = 0.0
            self.episode += 1

    def stepped(self, observations: Any) -> None:
        """A step was made; ``observations``: of all robots."""
        self._observation = observations
        self._total += float(self._session.rewards[self.chosen])
        self.steps += 1

    def capture(self) -> Captured:
        """The environment as it is now."""
        k, robot = self.chosen, self._robot
        time = float(np.asarray(robot.time)[k])
        positions, signals = self._positions(k), self._signals(k)
        worlds = tuple(world_of(robot, j) for j in range(robot.count)) if self._session.varies else ()
        return Captured(
            k, time, states(robot), np.array(robot.scan[k]), positions, self.episode, self._total, signals, worlds
        )  # fmt: skip

    def _positions(self, k: int) -> Points:
        task = self._session.task
        if isinstance(task, ReachGoal):
            x, y = task.goals[k].tolist()
            return np.array([[x, y, float(states(self._robot)[k, 2])]])
        if isinstance(task, TargetTask):
            first = min(int(task.at[k]), task.per_robot - 1)
            return np.array(task.positions[k, first:])
        return np.zeros((0, 3))

    def _signals(self, k: int) -> dict[str, float]:
        session, found = self._session, {}
        for name in self._wanted:
            word, _, index = name.partition("[")
            if word in ("reward", "return", "episode"):
                own = {"reward": session.rewards[k], "return": self._total, "episode": self.episode}
                found[name] = float(own[word])
            elif word == "action":
                found[name] = float(np.ravel(session.actions[k])[int(index[:-1])])
            elif self._observation is not None:
                key, at = word.partition(".")[2], int(index[:-1])
                rows = self._observation[key] if key else self._observation
                found[name] = float(np.ravel(rows[k])[at])
        return found

    # ------------------------------------------------------------------ where the page is

    def choose(self, number: int) -> None:
        """Show another robot in full from now on."""
        self.chosen = number

    def signal_names(self) -> list[str]:
        """What can be plotted: rewards, actions and observations of the chosen robot."""
        actions = np.ravel(self._session.actions[0])
        names = ["reward", "return", "episode", *(f"action[{j}]" for j in range(len(actions)))]
        rows = self._observation
        parts = rows if isinstance(rows, Mapping) else {} if rows is None else {"": rows}
        for key, values in parts.items():
            count = int(np.size(values[0]))
            if count <= _MOST and np.asarray(values[0]).dtype.kind in "fiub":
                dot = "." if key else ""
                names += [f"observation{dot}{key}[{j}]" for j in range(count)]
        return names

    def choose_signals(self, names: tuple[str, ...]) -> None:
        """Frames have these signals from now on.

        Raises:
            SignalError: there is no such signal; those before stay.
        """
        known = self.signal_names()
        for name in names:
            if name not in known:
                raise SignalError(f"there is no signal {name!r} of this environment")
        self._wanted = names

    def frame(self, captured: Captured) -> Frame:
        """What the page shows of a moment."""
        k, state = captured.chosen, captured.state
        offset = self._offset(k)
        pos, q = poses(state, self._ahead)
        if len(state) > 1 and self.layout == GRID:
            pos = pos + self._offsets * FLIP
        vx, vy, vz, yaw = state[k, 4], state[k, 5], state[k, 6], state[k, 3]
        c, s = math.cos(yaw), math.sin(yaw)
        speed = math.hypot(vx, vy)
        whose = "truth" if knows_truth(self._robot) else "robot"
        self._roll(captured, float(vx))
        return Frame(
            time_us=round(captured.time * 1e6),
            pos=Vec3(*pos[k].tolist()), q=q[k], vel=Vec3(vx * c - vy * s, -(vx * s + vy * c), -vz),
            mode=f"episode {captured.episode}", armed=True, rotors=self._rotors,
            rolled=(float(self._rolled[0]), float(self._rolled[1])),
            world=self._world(captured), scan=self._scan(captured),
            plan=self._planned(captured.positions, offset), signals=captured.signals,
            company=Company(pos, np.array([tuple(each) for each in q]), k) if len(state) > 1 else None,
            facts=(
                ("time", f"{captured.time:.1f} s"), ("return", f"{captured.total:.2f}"),
                (f"position ({whose})", f"{state[k, 0]:.2f}, {state[k, 1]:.2f}, {state[k, 2]:.2f} m"),
                (f"speed ({whose})", f"{speed:.2f} m/s"),
            ),
        )  # fmt: skip

    def _world(self, captured: Captured) -> World | None:
        """What is drawn around robots that are in several worlds; None: what the stage has."""
        worlds = captured.worlds
        if not worlds:
            return None
        if len(worlds) == 1 or self.layout != GRID:
            return worlds[captured.chosen]
        now = round(_DRAWN_EVERY * captured.time)
        if self._drawn is None or (worlds != self._drawn[0] and now != self._drawn[1]):
            self._drawn = worlds, now, beside(worlds, self._offsets)
        return self._drawn[2]

    def _offset(self, k: int) -> Points:
        has = self._robot.count > 1 and self.layout == GRID
        return self._offsets[k] if has else np.zeros(3)

    def _roll(self, captured: Captured, forward: float) -> None:
        """Turn the wheels by the way since the frame before."""
        k, before = self._last
        seconds = captured.time - before
        self._last = (captured.chosen, captured.time)
        if k == captured.chosen and 0.0 < seconds < 10.0:
            half = 0.5 * 2.0 * self._robot.volume.radius * float(captured.state[captured.chosen, 7])
            self._rolled += seconds * np.array([forward - half, forward + half])

    def _scan(self, captured: Captured) -> Points | None:
        ranges, angles = captured.scan.astype(float), self._robot.angles
        if len(ranges) == 0:
            return None
        met = np.isfinite(ranges) & (ranges <= self._robot.range_max)
        return hits(ranges[met], np.asarray(angles)[met]) + self._lidar

    def _planned(self, positions: Points, offset: Points) -> Plan:
        key = positions.tobytes() + offset.tobytes()
        if key != self._plan[0]:
            at = (positions + offset) * FLIP
            marks = (Mark(f"target {j + 1}", Vec3(*each), j) for j, each in enumerate(at.tolist()))
            self._plan = (key, Plan(items=tuple(marks)))
        return self._plan[1]


def beside(worlds: Sequence[World], offsets: Points) -> World:
    """Worlds side by side as one, for drawing; ``offsets``: where each stands [m], shape (n, 3)."""
    solids = [
        replace(solid, centre=tuple((np.array(solid.centre) + at).tolist()))
        for world, at in zip(worlds, offsets)
        for solid in world.solids
    ]
    markings = [
        replace(marking, centre=tuple((np.array(marking.centre) + at[:2]).tolist()))
        for world, at in zip(worlds, offsets)
        for marking in world.markings
    ]
    return World("side by side", tuple(solids), worlds[0].starts, floor_z=worlds[0].floor_z, markings=tuple(markings))


def knows_truth(robot: Robot) -> bool:
    """Whether it is known where a robot really is: its physics is here."""
    return getattr(robot, "camera_mount", None) is not None


def states(robot: Robot) -> Points:
    """Where robots really are, or where they say that they are when nobody knows better, shape (count, 12)."""
    if knows_truth(robot):
        return np.array(robot.true_state())  # type: ignore[attr-defined]
    out = np.zeros((robot.count, 12))
    out[:, :4], out[:, 4:8] = robot.pose, robot.velocity
    return out


def poses(state: Points, ahead: float) -> tuple[Points, list[Any]]:
    """Positions NED [m], shape (count, 3), and attitudes of the bodies.

    Args:
        state: see ``states``.
        ahead: how far the robot's base lies ahead of its body's origin [m].
    """
    x = state[:, 0] - ahead * np.cos(state[:, 3])
    y = state[:, 1] - ahead * np.sin(state[:, 3])
    pos = np.column_stack([x, -y, -state[:, 2]])
    return pos, [quat_from_euler(Euler(row[8], row[9], -row[3])) for row in state.tolist()]


def shape_of(robot: Robot) -> Shape:
    """What a robot looks like: from its airframe, else a box of its size."""
    airframe = getattr(robot, "airframe", None)
    if airframe is not None:
        return kind.shape_of(airframe)
    volume = robot.volume
    return plain(2.0 * volume.radius, 1.4 * volume.radius, max(volume.top - volume.bottom, volume.radius))


def grid(session: Session) -> Points:
    """Positions of the worlds of all robots side by side, in the scene's axes [m], shape (count, 3)."""
    task, (x0, y0, x1, y1) = session.task, session.robot.world.bounds
    if isinstance(task, TargetTask):
        low, high = task.arena.low, task.arena.high
        x0, y0, x1, y1 = min(x0, low[0]), min(y0, low[1]), max(x1, high[0]), max(y1, high[1])
    return side_by_side(session.robot.count, (x0, y0), (x1, y1))
