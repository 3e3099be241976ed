# SPDX-License-Identifier: BSD-3-Clause
"""Experts that show how a task is done: the autopilot by its own modes, and policies.

The autopilot's path is shown by velocities: an expert lets a copy of the vehicle go on in GUIDED or AUTO, looks at what
velocity it comes to, and gives the environment's action that asks for it. So what is recorded has been done in the
environment itself, and can be done again.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.client import Client
from sitl.client.errors import ClientError
from sitl.core import code_in_files
from sitl.core.elementary import cos, sin
from sitl.core.sums import products
from sitl.envs.actions import POSITION, VELOCITY, Discrete
from sitl.envs.navigate import Navigate
from sitl.envs.robots.autopilot import AutopilotRobot
from sitl.worlds.shapes import from_heading, from_ned, to_ned

from . import learnt
from .errors import AgentError
from .expert import Expert, Shown, named
from .pilot import Pilot

Floats = npt.NDArray[np.float64]
AHEAD_S, AHEAD_OF_ROWS_S = 0.5, 2.0
"""So long before an action's velocity is to be reached it is asked for [s]: the autopilot takes time to reach it. Rows
of a table are far apart: the velocity is looked at when it has come near to one."""
GAIN = 0.5
"""Velocity for each metre, and rate of turn for each radian, that a vehicle is beside a flight in AUTO [1/s]."""
BEHIND_M = 2.0
"""A vehicle is led so far behind a gate, and in AUTO from so far before it [m]."""
AFTER_S = 10.0
"""A flight in AUTO is looked at for so long after its last item [s]: a copter comes to rest there."""
LONGEST_S = 600.0
"""A flight in AUTO is given up after this [s]."""


class _Autopilot(Expert):
    """What both experts that are autopilots need of an environment."""

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        navigate = env.unwrapped
        if not isinstance(navigate, Navigate) or not isinstance(navigate.robot, AutopilotRobot):
            raise AgentError(f"expert {self.name!r}: {named(env)} has no vehicle with an autopilot")
        session, robot = navigate.session, navigate.robot
        if session.action.setpoint is not VELOCITY or not hasattr(session.action, "nearest"):
            raise AgentError(
                f"expert {self.name!r}: actions of {named(env)} are {session.action.setpoint.name!r} set-points; it "
                f"shows velocities: setpoint={VELOCITY.name!r}"
            )
        if not hasattr(session.task, "positions"):
            raise AgentError(f"expert {self.name!r}: task {type(session.task).__name__} of {named(env)} has no targets")
        if POSITION not in robot.setpoints or not robot.has_snapshots:
            raise AgentError(f"expert {self.name!r}: {named(env)} needs a vehicle in process with our autopilot")
        self._robot = robot
        self._task: Any = session.task
        self._seconds = session.seconds
        self._shown = Shown(session.action)
        ahead = AHEAD_OF_ROWS_S if isinstance(session.action, Discrete) else AHEAD_S
        self._steps = max(round(ahead / session.seconds), 1)

    def _seen(self) -> Floats:
        """Where the present target is for the autopilot, which flies by its estimate: where the agent sees it, x, y, z
        [m]. Of tasks that are judged by where the vehicle really is, this is beside the target."""
        x, y, z, yaw = self._robot.pose[0]
        forward, left, up = self._task.offsets(1)[0, 0]
        c, s = cos(yaw), sin(yaw)
        return np.array([x + forward * c - left * s, y + forward * s + left * c, z + up])


class Guided(_Autopilot):
    """GUIDED, told by position targets where the task's present target is; a copter keeps its heading."""

    name = "guided"
    about = "the autopilot in GUIDED, told where the next target is (SET_POSITION_TARGET_LOCAL_NED)"

    def begin(self, seed: int) -> None:
        """See ``Expert``."""
        self._shown.begin()
        self._yaw = float(self._robot.pose[0, 3])

    def act(self, observation: Any) -> Any:
        """See ``Expert``."""
        robot = self._robot
        now = robot.snapshot(0)
        robot.apply(POSITION, np.array([[*self._aim(), self._yaw]]))
        for _ in range(self._steps):
            robot.advance(self._seconds)
        velocity = robot.velocity[0].copy()
        robot.restore(0, now)
        return self._shown.action_for(velocity)

    def _aim(self) -> Floats:
        """The present target; of a gate, a point behind it, or before it as long as the vehicle is too far beside."""
        position, gates = self._seen(), getattr(self._task, "gates", ())
        if not gates:
            return position
        yaw = gates[int(self._task.at[0]) % len(gates)].yaw
        through = np.array([cos(yaw), sin(yaw), 0.0])
        offset = position - self._robot.pose[0, :3]
        before = float(products(offset, through))
        beside = math.sqrt(max(float(products(offset, offset)) - before * before, 0.0))
        return position + (BEHIND_M if beside < 0.3 * before else -BEHIND_M) * through


class Auto(_Autopilot):
    """AUTO: a copy of the vehicle flies a mission of the task's targets, whose path the episode then follows."""

    name = "auto"
    about = "the autopilot in AUTO, on a mission of the task's targets, followed by velocities"

    def begin(self, seed: int) -> None:
        """See ``Expert``."""
        self._shown.begin()
        self._flight = self._flown()
        self._k = 0

    def _flown(self) -> Floats:
        """What the autopilot of the copy believes after each step: x, y, z [m], yaw [rad], their velocities [m/s],
        [rad/s], shape (steps, 8)."""
        robot = self._robot
        simulation = robot.simulation(0)
        client = Client(simulation)
        try:
            lat, lon, height, _ = simulation.home
            mission = [client.item("NAV_WAYPOINT", 0.0, 0.0)]
            ours, above = client.place_of(lat, lon), height - client.home()[2]
            for position in self._path():
                north, east, down = to_ned(*position)
                mission.append(client.item("NAV_WAYPOINT", ours[0] + north, ours[1] + east, above - down))
            client.upload(mission)
            if hasattr(self._task, "radius"):  # else corners are cut beside targets
                name, unit = ("WPNAV_RADIUS", 100.0) if client.flies else ("WP_RADIUS", 1.0)
                client.params[name] = 0.5 * unit * float(self._task.radius)
            client.start_mission()
        except ClientError as error:
            raise AgentError(f"expert {self.name!r}: no mission of the task's targets can be flown: {error}") from None
        rows: list[Floats] = []
        left = round(LONGEST_S / self._seconds)
        while left > 0:
            rows.append(_believed(simulation.v.autopilot.estimate))
            if len(mission) - 1 in client.reached:
                left = min(left, round(AFTER_S / self._seconds))
            client.delay(self._seconds)
            left -= 1
        client.close()
        flight = np.array(rows)
        flight[:, :3] += self._robot.pose[0, :3] - flight[0, :3]
        return flight

    def _path(self) -> list[Floats]:
        """Positions of the mission: the task's; of gates, one before and one behind each."""
        positions: Floats = self._task.positions[0] + (self._seen() - self._task.targets[0])
        gates = getattr(self._task, "gates", ())
        if not gates:
            return list(positions)
        found = []
        for k, position in enumerate(positions):
            yaw = gates[k % len(gates)].yaw
            through = BEHIND_M * np.array([cos(yaw), sin(yaw), 0.0])
            found += [position - through, position + through]
        return found

    def act(self, observation: Any) -> Any:
        """See ``Expert``."""
        here, flight = self._robot.pose[0], self._flight
        at, then = flight[min(self._k, len(flight) - 1)], min(self._k + self._steps, len(flight) - 1)
        self._k += 1
        velocity = flight[then, 4:8]
        x, y = velocity[:2] + GAIN * (at[:2] - here[:2])
        c, s = cos(here[3]), sin(here[3])
        turn = velocity[3] + GAIN * math.remainder(at[3] - here[3], math.tau)
        up = velocity[2] + GAIN * (at[2] - here[2])
        return self._shown.action_for(np.array([x * c + y * s, y * c - x * s, up, turn]))


class Learnt(Expert):
    """A policy: one that comes with the program, of a run's folder or of a file."""

    def __init__(self, env: gym.Env[Any, Any], path: Path) -> None:
        found = learnt.load(path, code_in_files.EVERY)
        found.policy.check(env.observation_space, env.action_space)
        self.name, self._policy = path.stem, found.policy
        self.about = f"a policy that was learnt by {found.config.algorithm} in {found.config.env}"

    def begin(self, seed: int) -> None:
        """See ``Expert``."""
        self._policy.begin(seed)

    def act(self, observation: Any) -> Any:
        """See ``Expert``."""
        return self._policy.act(observation)


def _believed(estimate: Any) -> Floats:
    """What an autopilot believes, in the frame of environments: see ``Auto._flown``."""
    heading, pos, vel = estimate.euler[2], estimate.pos, estimate.vel
    return np.array([*from_ned(*pos), from_heading(heading), *from_ned(*vel), -estimate.rates[2]])


AUTOPILOTS: dict[str, Callable[[gym.Env[Any, Any]], Expert]] = {"guided": Guided, "auto": Auto, "pilot": Pilot}
"""By name."""
