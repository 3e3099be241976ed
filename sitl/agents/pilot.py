# SPDX-License-Identifier: BSD-3-Clause
"""The expert "pilot": leads a vehicle by velocities, around what stands in its way; the autopilot flies them in GUIDED.

Where there are targets, he knows the world: paths are planned around its solids. Where there are none, as in the
paper's environments, he sees the lidar only, and turns to where there is space.
"""

from __future__ import annotations

import math
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.elementary import atan2, cos, hypot, sin
from sitl.core.sums import lengths, products, separation
from sitl.envs.actions import VELOCITY, Discrete
from sitl.envs.arena import REACH
from sitl.envs.navigate import Navigate
from sitl.envs.senses import SensingRobot
from sitl.envs.targets.hold import Hold
from sitl.envs.targets.landing import Land
from sitl.envs.targets.moving import AHEAD_S, MovingTask
from sitl.envs.targets.parking import Park
from sitl.envs.worlds import PerWorld
from sitl.worlds import World

from .errors import AgentError
from .expert import Expert, Shown, named
from .grid_a_star import GridAStar

Floats = npt.NDArray[np.float64]
GAIN = 1.2
"""Velocity for each metre to go [1/s]."""
TRACKING_GAIN = 1.5
"""The same of what moves, whose velocity of three quarters of a second later is added: so late is the vehicle [1/s]."""
FAST, AMONG = 4.0, 1.2
"""Greatest speed of a copter in the open, and among solids [m/s]."""
LOOK, LOOK_DRIVING = 1.2, 2.5
"""So far ahead on its way a copter, a rover is led [m]."""
BEHIND = 2.0
"""A path through a gate begins so far before it, and ends so far behind it [m]."""
CIRCLE = 2.2
"""Radius that a rover turns in [m]; of a position within, it backs first."""
ASTRAY = 1.5
"""A path is planned anew when the vehicle is so far beside it [m]."""
REPLAN = 10
"""Steps between two plans for the same target, at least."""
APPROACH = 5.0
"""A bay is approached along its heading from so far before it [m]."""
SINK, LOW = 0.6, 1.5
"""Down onto a pad [m/s]; below this height the vehicle must be over it [m]."""
COMFORT, COMFORT_DRIVING = 0.8, 2.0
"""Clearance that he likes a copter, a rover to have [m]."""
SIGHT, CONE, SIDE, CLEARANCE = 5.0, math.radians(15.0), math.radians(100.0), 1.2
"""Readings count up to this [m]; what is beside him, from .. to; half of the lane that he needs, in crash ranges."""
STRAIGHT = math.radians(12.0)
"""A gap within this is straight on."""


class Pilot(Expert):
    """See the module."""

    name = "pilot"
    about = "a pilot who leads the autopilot by velocities along paths that he plans around the world's solids"

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        navigate = env.unwrapped
        if not isinstance(navigate, Navigate):
            raise AgentError(f"expert {self.name!r}: {named(env)} has no robot of ours")
        session = navigate.session
        self._robot: Any = navigate.robot
        self._turns: dict[int, Any] | None = None
        self._plans_in: PerWorld[GridAStar] | None = None
        self._path: Floats = np.zeros((0, 2))
        """x, y [m] of the path that was planned, for the position of number ``_of``; ``_at`` of it he is, ``_since`` so
        many steps it has been there."""
        self._of, self._at, self._since = -1, 0, 0
        self._backs = False
        """Whether a rover backs, because it could not turn to the position ahead."""
        self._task: Any = session.task
        if not hasattr(self._task, "offsets"):
            self._turns = _table_of_turns(env, session.action)
            return
        if session.action.setpoint is not VELOCITY or not hasattr(session.action, "nearest"):
            raise AgentError(
                f"expert {self.name!r}: actions of {named(env)} are {session.action.setpoint.name!r} set-points; it "
                f"shows velocities: setpoint={VELOCITY.name!r}"
            )
        self._shown = Shown(session.action)
        self._flies = bool(getattr(self._task, "flies", False))
        if self._robot.world.solids or session.varies or not self._flies:
            self._plans_in = PerWorld(self._planned)

    def _planned(self, world: World) -> GridAStar:
        return GridAStar(self._robot, REACH, COMFORT if self._flies else COMFORT_DRIVING)

    @property
    def _plans(self) -> GridAStar | None:
        """Paths in the world of the present episode."""
        return None if self._plans_in is None else self._plans_in(self._robot.world)

    def begin(self, seed: int) -> None:
        """See ``Expert``."""
        if self._turns is None:
            self._shown.begin()
            self._path, self._of, self._at, self._since = np.zeros((0, 2)), -1, 0, 0
            self._backs = False

    def act(self, observation: Any) -> Any:
        """See ``Expert``."""
        if self._turns is not None:
            return self._turns[self._gap()]
        offsets = self._task.offsets(3)[0]
        return self._shown.action_for(self._flown(offsets) if self._flies else self._driven(offsets[0]))

    # ------------------------------------------------------------------ copters

    def _flown(self, offsets: Floats) -> Floats:
        """Velocity forward, left, up [m/s], turn [rad/s]: after what moves, around what stands."""
        offset, task = offsets[0], self._task
        if isinstance(task, MovingTask):
            velocity = TRACKING_GAIN * offset + (offsets[2] - offsets[1]) / AHEAD_S
            if isinstance(task, Land):
                is_over = hypot(offset[0], offset[1]) < 0.7 * task.pad
                velocity[2] = -SINK if is_over or -offset[2] > LOW else 0.0
            return np.append(velocity, 0.0)
        fast = FAST
        if getattr(task, "gates", ()):
            offset = self._turned(self._through() - self._here()[:3])
        elif self._plans is not None and hypot(offset[0], offset[1]) > LOOK:
            here = self._here()
            there = here[:2] + self._unturned(offset)[:2]
            offset, fast = self._turned(np.append(self._ahead(here[:2], [there], LOOK) - here[:2], offset[2])), AMONG
        velocity = GAIN * offset
        return np.append(velocity * min(1.0, fast / max(float(lengths(velocity)), 1e-9)), 0.0)

    def _through(self) -> Floats:
        """A position behind the present gate, or before it as long as the vehicle is too far beside: x, y, z [m]."""
        here, k = self._here()[:3], int(self._task.at[0])
        yaw = self._task.gates[k % len(self._task.gates)].yaw
        position, along = here + self._unturned(self._task.offsets(1)[0, 0]), np.array([cos(yaw), sin(yaw), 0.0])
        offset = position - here
        before = float(products(offset, along))
        beside = math.sqrt(max(float(products(offset, offset)) - before * before, 0.0))
        out: Floats = position + (BEHIND if beside < 0.3 * before else -BEHIND) * along
        return out

    # ------------------------------------------------------------------ rovers

    def _driven(self, offset: Floats) -> Floats:
        """Velocity of a rover: towards a position ahead on its way, along an arc."""
        here, task = self._here(), self._task
        there = here[:2] + self._unturned(offset)[:2]
        ahead = self._ahead(here[:2], self._stations(there), LOOK_DRIVING)
        forward, left, _ = self._turned(np.append(ahead - here[:2], 0.0))
        bearing, away, left_over = atan2(left, forward), hypot(forward, left), hypot(offset[0], offset[1])
        speed = 1.2 if abs(bearing) < 0.6 else 0.8
        if isinstance(task, Park | Hold):
            if left_over < 0.5 * task.radius:
                return np.zeros(4)
            speed = min(speed, 0.5 * left_over)
        within = 2.0 * CIRCLE * abs(sin(bearing)) - away
        self._backs = within > (-1.0 if self._backs else -0.2) and abs(bearing) > (0.3 if self._backs else 0.6)
        if self._backs:
            return np.array([-0.8, 0.0, 0.0, math.copysign(0.4, bearing)])
        turn = 2.0 * speed * sin(bearing) / max(away, 0.5)
        if abs(bearing) > 0.5 * math.pi:
            turn = math.copysign(0.6, bearing)
        return np.array([speed, 0.0, 0.0, turn])

    def _stations(self, there: Floats) -> list[Floats]:
        """Positions (x, y [m]) that a path of a rover leads over: through gates, into a bay along its heading."""
        task, gates = self._task, getattr(self._task, "gates", ())
        if isinstance(task, Park):
            yaw = float(task.headings[0])
            return [there - APPROACH * np.array([cos(yaw), sin(yaw)]), there]
        if not gates:
            return [there]
        found = []
        for k in range(int(task.at[0]), min(int(task.at[0]) + 2, task.per_robot)):
            position = there if k == int(task.at[0]) else task.positions[0, k, :2]
            yaw = gates[k % len(gates)].yaw
            along = np.array([cos(yaw), sin(yaw)])
            found += [position - BEHIND * along, position + BEHIND * along]
        return found

    # ------------------------------------------------------------------ paths

    def _here(self) -> Floats:
        """Where the vehicle really is, by which it is led around solids: x, y, z [m], yaw [rad]."""
        robot = self._robot
        state: Floats = robot.judged_state() if isinstance(robot, SensingRobot) else robot.pose
        return state[0, :4]

    def _ahead(self, here: Floats, stations: list[Floats], look: float) -> Floats:
        """A position ``look`` [m] ahead on the path over stations; it is planned where there is none that leads
        there."""
        k = int(self._task.at[0])
        self._since += 1
        if self._of == k and len(self._path):
            away = lengths(self._path - here)
            self._at += int(away[self._at : self._at + 40].argmin())
            is_astray = away[self._at] > ASTRAY
            is_over = self._at >= len(self._path) - 2 and len(stations) > 1  # and the gate has not been passed
            if self._since < REPLAN or not (is_astray or is_over):
                return self._beyond(here, look)
        assert self._plans is not None
        legs, last = [], here
        for station in stations:
            legs.append(self._plans.path(last, station))
            last = station
        self._path, self._of, self._at, self._since = np.concatenate(legs), k, 0, 0
        return self._beyond(here, look)

    def _beyond(self, here: Floats, look: float) -> Floats:
        out: Floats = self._path[-1]
        for position in self._path[self._at :]:
            if separation(position.tolist(), here.tolist()) >= look:
                return np.asarray(position)
        return out

    def _turned(self, offset: Floats) -> Floats:
        """x, y, z of the world as forward, left, up."""
        yaw = float(self._here()[3])
        c, s = cos(yaw), sin(yaw)
        return np.array([offset[0] * c + offset[1] * s, offset[1] * c - offset[0] * s, offset[2]])

    def _unturned(self, offset: Floats) -> Floats:
        yaw = float(self._here()[3])
        c, s = cos(yaw), sin(yaw)
        return np.array([offset[0] * c - offset[1] * s, offset[0] * s + offset[1] * c, offset[2]])

    # ------------------------------------------------------------------ without targets

    def _gap(self) -> int:
        """Where the most space is: 0 straight on, 1 to the left, -1 to the right."""
        angles, robot = self._robot.angles, self._robot
        scan = np.minimum(robot.scan[0], SIGHT).astype(np.float64)
        half = max(CLEARANCE * robot.crash_range, 1.2 * robot.volume.radius) + 0.1
        tried = np.linspace(-1.6, 1.6, 33)
        turned = angles - tried[:, None]
        forward, aside = scan * arrays.cos(turned), np.abs(scan * arrays.sin(turned))
        clearance = np.where((forward > 0.0) & (aside < half) & (scan < SIGHT), forward, SIGHT).min(axis=1)
        side = [scan[(sign * angles > CONE) & (sign * angles < SIDE)].min(initial=SIGHT) for sign in (1.0, -1.0)]
        centred = (min(side[0], 2.0 * half) - min(side[1], 2.0 * half)) * tried
        best = float(tried[int(np.argmax(clearance - 0.3 * np.abs(tried) + centred))])
        return 0 if abs(best) <= STRAIGHT else 1 if best > 0.0 else -1


def _table_of_turns(env: gym.Env[Any, Any], action: Any) -> dict[int, Any]:
    """Of a table with "forward", "left" and "right": the action for 0, 1 and -1."""
    names = action.names if isinstance(action, Discrete) else ()
    if not {"forward", "left", "right"} <= set(names):
        raise AgentError(
            f"expert {Pilot.name!r}: the task of {named(env)} has no targets; then it needs discrete actions named "
            f'"forward", "left" and "right": action="discrete"'
        )
    return {turn: np.int64(names.index(name)) for turn, name in ((0, "forward"), (1, "left"), (-1, "right"))}
