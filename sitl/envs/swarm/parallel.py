# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles of a swarm as agents of PettingZoo's parallel interface.

Actions are velocities by MAVLink, SET_POSITION_TARGET_LOCAL_NED in GUIDED; observations are what the vehicles'
telemetry says, and where their goals are. Rewards and ends are judged by where they really are.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.error import InvalidAction, ResetNeeded

from sitl.core.elementary import cos

from ...client.client import Client
from ...client.endpoint import Endpoint
from ...client.session import RATES_HZ
from ...client.swarm import clients_of
from ...errors import MissingExtra
from ...swarm import MOST, Swarm, SwarmSnapshot
from ..options import EnvOptionError
from ..robots.boots import SINGLE, booted, check_boots, draw
from .sight import SCAN_MESSAGE, Sight
from .tasks import HEIGHT, TASKS, Floats, Scene, Task

try:
    from pettingzoo import ParallelEnv
except ImportError:
    raise MissingExtra("sitl.envs.swarm needs PettingZoo: pip install 'gym-sitl[pettingzoo]'") from None

Narrow = npt.NDArray[np.float32]
VELOCITY_ONLY = {True: 0x5C7, False: 0xDC7}
"""Type masks: what flies keeps its heading, a rover turns to where it is to go."""
TELEMETRY, TELEMETRY_HZ, SCAN_HZ = "GLOBAL_POSITION_INT", 20, 10
FASTEST = {True: (3.0, 3.0, 1.5), False: (2.0, 2.0)}
"""North, east and, of what flies, up [m/s] of an action of 1."""
FAR, SPEEDY = 100.0, 20.0
"""Bounds of observations [m], [m/s]; what is beyond is clipped."""
HIT = -10.0
"""Reward of a hit, which ends the episode of those that were hit."""


class SwarmEnv(ParallelEnv):
    """Vehicles in one world with a task.

    An agent's action is a velocity north, east and, of a copter, up, each -1 .. 1 of its fastest. It observes, as
    float32: its own velocity north, east, down [m/s]; its goal from where it is [m]; and of each other vehicle, in
    their order, where it is from there [m], and its velocity against its own [m/s].

    Args:
        task: "formation", "crossing", "pursuit", "escort", or a ``Task``.
        count: number of vehicles; None: the task's own.
        step: simulated time of a step [s], whole ticks of 2.5 ms.
        steps: after which episodes are truncated.
        observation: "state", as above; "scan" (of the lidar [m], the last one of 10 a second), "depth", "camera",
            "grey" (``sitl.envs.pictures``); names joined by "+", or a dict of names and pictures, give a dict. Scans
            and pictures show the other vehicles, too.
        boots: number of prepared boots of the whole swarm, 1 .. 1024, one of which each episode begins with, by its
            seed: the estimators' errors, receivers' slow ones among them, are those of that boot. 1: one boot, with
            which all episodes begin; these errors are then the same constants in all of them.
        clip_actions: whether a finite number of an action outside of -1 .. 1 becomes -1 or 1; False: it is refused.
        options: as of ``sitl.Swarm``: params (wind), world, home ....

    Raises:
        EnvOptionError: there is no such task, or a number cannot be.
    """

    def __init__(
        self,
        task: str | Task = "formation",
        count: int | None = None,
        *,
        step: float = 0.2,
        steps: int = 200,
        observation: Any = "state",
        boots: int = 1,
        clip_actions: bool = True,
        **options: Any,
    ) -> None:
        check_boots(boots)
        if isinstance(task, str):
            if task not in TASKS:
                raise EnvOptionError(f"task {task!r} is none of {', '.join(TASKS)}")
            if count is not None and not (isinstance(count, int) and 2 <= count <= 250):
                raise EnvOptionError(f"count = {count!r}; a whole number from 2 to 250 is needed")
            task = TASKS[task]() if count is None else TASKS[task](count)
        assert not isinstance(task, str)
        if not (0.0 < step < math.inf and round(step * 400) == step * 400):
            raise EnvOptionError(f"step = {step!r}; a multiple of 0.0025 s above 0 is needed")
        if not isinstance(steps, int | np.integer) or steps < 1:
            raise EnvOptionError(f"steps = {steps!r}; a whole number from 1 on is needed")
        self._options, self.boots = options, boots
        if not isinstance(clip_actions, bool):
            raise EnvOptionError(f"clip_actions = {clip_actions!r}; it must be True or False")
        self._given = {
            "step": step, "steps": steps, "observation": observation, "boots": boots,
            "clip_actions": clip_actions, **options,
        }  # fmt: skip
        self._clips = clip_actions
        self.task, self.step_us, self.steps = task, round(step * 1e6), steps
        self.metadata = {"name": "sitl_swarm_v0", "render_modes": [], "is_parallelizable": True}
        self.render_mode = None
        self.swarm = Swarm(list(task.frames), spacing=task.spacing, **options)
        """The vehicles; agents are named after their kinds, in this order."""
        kinds = [vehicle.kind for vehicle in self.swarm.vehicles]
        self.possible_agents = [f"{kind.name}_{k}" for k, kind in enumerate(kinds)]
        self.agents: list[str] = []
        self._flies = [kind.flies for kind in kinds]
        self._number = {agent: k for k, agent in enumerate(self.possible_agents)}
        n = len(kinds)
        high = np.array([SPEEDY] * 3 + [FAR] * 3 + ([FAR] * 3 + [SPEEDY] * 3) * (n - 1), np.float32)
        self._observation_space = gym.spaces.Box(-high, high)
        try:
            self._sight = Sight(observation, self.swarm, step, self._observation_space)
        except EnvOptionError:
            self.swarm.close()
            raise
        self._ready: SwarmSnapshot | None = None
        self.prepared: dict[int, SwarmSnapshot] = {}
        """States after other boots than the first one, by their numbers; swarms that are made alike may share them."""
        self._rng = np.random.default_rng()

    @functools.cache  # noqa: B019 - the interface wants the same object each time
    def observation_space(self, agent: str) -> gym.Space[Any]:
        """Of an agent."""
        return self._sight.space(self._number[agent])

    @functools.cache  # noqa: B019
    def action_space(self, agent: str) -> gym.spaces.Box:
        """Of an agent."""
        return gym.spaces.Box(-1.0, 1.0, (len(FASTEST[self._flies[self._number[agent]]]),))

    # ------------------------------------------------------------------ episodes

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """Begin an episode: copters hover at 5 m over their starts, rovers stand on theirs, all in GUIDED.

        Args:
            seed: of all that is drawn from now on: noise, gusts, goals; None: they go on.
            options: not used.
        """
        if seed is not None:
            self._rng = np.random.default_rng(seed)
        if self._ready is None:
            self._ready = self._prepared()
        noise = int(self._rng.integers(1 << 31))
        self.swarm.restore(self._booted(draw(self.boots, noise).boot))
        self.swarm.reseed(noise)
        for endpoint in self._ends:
            endpoint.link.receive()
            endpoint.sequence = 0
        self.agents = list(self.possible_agents)
        self._count, self._hits = 0, self._hit_counts()
        self.swarm.advance_to(self.swarm.time_us + self.step_us)
        self._listen()
        self.task.begin(self._true_positions(), self._rng)
        self._goals = self.task.goals(self._true_positions(), 0.0).copy()
        self._sight.start(noise)
        return self._observe(self._goals), {agent: {} for agent in self.agents}

    def _prepared(self) -> SwarmSnapshot:
        """All of them ready to be flown, after the first boot."""
        clients = self._prepare(self.swarm)
        self._ends: list[Endpoint] = [client.connection.endpoint for client in clients]
        self._reported: Floats = np.zeros((len(clients), 6))
        return self.swarm.snapshot()

    def _prepare(self, swarm: Swarm) -> list[Client]:
        """Bring all vehicles of a swarm that boots to where episodes begin."""
        clients = clients_of(swarm)
        for flies, client in zip(self._flies, clients, strict=True):
            client.wait_ready()
            if flies:
                client.take_off(HEIGHT)
            else:
                client.set_mode("GUIDED")
                client.arm()
        for client in clients:
            for name in RATES_HZ:
                client.set_rate(name, TELEMETRY_HZ if name == TELEMETRY else 1)
            if self._sight.reads_scan:
                client.set_rate(SCAN_MESSAGE, SCAN_HZ)
        swarm.advance(5.0)
        return clients

    def _booted(self, number: int) -> SwarmSnapshot:
        """The state after a boot; calculated on first use."""
        if number == SINGLE:
            assert self._ready is not None
            return self._ready
        if number not in self.prepared:
            scenarios = self.swarm.scenarios
            seed = scenarios[0].seed_or_default + MOST * number  # no vehicle has the seed of another one in any boot
            frames = [booted(each, each.airframe, seed + k) for k, each in enumerate(scenarios)]
            swarm = Swarm(
                [replace(each, frame=airframe) for each, airframe in frames],
                starts=[each.start for each in scenarios if each.start is not None],
                **{**self._options, "seed": seed},
            )
            try:
                self._prepare(swarm)
                self.prepared[number] = swarm.snapshot()
            finally:
                swarm.close()
        return self.prepared[number]

    def step(
        self, actions: dict[str, Narrow]
    ) -> tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]]:
        """Velocities of the agents for a step; what PettingZoo's parallel ``step`` gives.

        Raises:
            InvalidAction: an agent has no action or one that is not in its space (``clip_actions``), or there is
                no such agent.
            ResetNeeded: before the first ``reset``.
        """
        given = self.check(actions)
        acting = self.agents
        before = self._true_positions()
        for agent, k in self._number.items():
            self._send(k, given.get(agent, (0.0, 0.0, 0.0)))
        self.swarm.advance_to(self.swarm.time_us + self.step_us)
        self._listen()
        self._count += 1
        positions = self._true_positions()
        goals = self.task.goals(positions, 1e-6 * self.step_us * self._count)
        scene = Scene(positions, before, goals, self._goals)
        self._goals = goals.copy()
        rewards, is_success = self.task.rewards(scene), self.task.is_success(scene)
        over, hits = self.task.is_over(scene), self._hit_counts()
        was_hit = hits > self._hits
        self._hits = hits
        too_long = self._count >= self.steps
        self._sight.note()
        observations = self._observe(goals)
        numbers = {agent: self._number[agent] for agent in acting}
        terminations = {agent: bool(over or was_hit[k]) for agent, k in numbers.items()}
        truncations = dict.fromkeys(acting, too_long)
        self.agents = [agent for agent in acting if not (terminations[agent] or too_long)]
        return (
            {agent: observations[agent] for agent in acting},
            {agent: float(rewards[k] + HIT * was_hit[k]) for agent, k in numbers.items()},
            terminations,
            truncations,
            {
                agent: {
                    "is_success": bool(is_success[k]),
                    "was_hit": bool(was_hit[k]),
                    "true_place": positions[k].copy(),
                }
                for agent, k in numbers.items()
            },
        )

    def check(self, actions: Mapping[str, Any]) -> dict[str, Sequence[float]]:
        """Actions of a step as numbers, each -1 .. 1, of the agents whose episode goes on; others are left out.

        Raises:
            InvalidAction, ResetNeeded: see ``step``.
        """
        if self._ready is None:
            raise ResetNeeded("step() before the first reset(): call reset() first")
        if not isinstance(actions, Mapping):
            raise InvalidAction(f"actions {actions!r} are no dict of agents' actions")
        for agent in actions:
            if agent not in self._number:
                raise InvalidAction(f"action of agent {agent!r}: agents are {', '.join(self.possible_agents)}")
        missing = [agent for agent in self.agents if agent not in actions]
        if missing:
            raise InvalidAction(f"no action of agent {', '.join(missing)}: each one in `agents` needs one")
        return {agent: self._checked(agent, actions[agent]) for agent in self.agents}

    def _checked(self, agent: str, action: Any) -> Sequence[float]:
        names = ("north", "east", "up")[: len(FASTEST[self._flies[self._number[agent]]])]
        try:
            row = np.asarray(action, np.float32)
            if self._clips and np.isfinite(row).all():
                row = np.clip(row, -1.0, 1.0)
            numbers: list[float] = row.tolist()
            if len(numbers) == len(names) and all(-1.0 <= number <= 1.0 for number in numbers):
                return numbers
        except (TypeError, ValueError):
            pass
        allowed = ", ".join(f"{name} -1 .. 1" for name in names)
        raise InvalidAction(f"agent {agent!r}: action {action!r} is not in {self.action_space(agent)}: {allowed}")

    # ------------------------------------------------------------------ the vehicles

    def _send(self, k: int, action: Sequence[float]) -> None:
        scale = FASTEST[self._flies[k]]
        north, east, *up = (a * most for a, most in zip(action, scale))
        velocity = {"vx": north, "vy": east, "vz": -up[0] if up else 0.0}
        fields = {"target_system": k + 1, "coordinate_frame": 1, "type_mask": VELOCITY_ONLY[self._flies[k]], **velocity}
        self._ends[k].send("SET_POSITION_TARGET_LOCAL_NED", **fields)

    def _listen(self) -> None:
        """Note what the vehicles' telemetry says: north, east, down of the world's origin [m], velocities [m/s]."""
        lat0, lon0, alt0, _ = self.swarm[0].home
        metres = 111_318.845
        for k, endpoint in enumerate(self._ends):
            for name, m in endpoint.receive():
                if name == TELEMETRY:
                    north = (m.lat * 1e-7 - lat0) * metres
                    east = (m.lon * 1e-7 - lon0) * metres * cos(math.radians(lat0))
                    self._reported[k] = north, east, alt0 - m.alt * 1e-3, m.vx * 0.01, m.vy * 0.01, m.vz * 0.01
                elif name == SCAN_MESSAGE:
                    self._sight.hear(k, m)

    def _true_positions(self) -> Floats:
        return np.array([tuple(vehicle.v.physics.body.pos) for vehicle in self.swarm.vehicles])

    def _hit_counts(self) -> npt.NDArray[np.int64]:
        return np.array([vehicle.v.physics.obstacles.hit_count for vehicle in self.swarm.vehicles])

    def _observe(self, goals: Floats) -> dict[str, Any]:
        reported = self._reported
        found = {}
        for agent, k in self._number.items():
            others = np.delete(reported - reported[k], k, axis=0).ravel()
            row = np.concatenate((reported[k, 3:], goals[k] - reported[k, :3], others)).astype(np.float32)
            space = self._observation_space
            found[agent] = self._sight.observe(k, np.clip(row, space.low, space.high))
        return found

    # ------------------------------------------------------------------ copies

    def __getstate__(self) -> dict[str, Any]:
        """All of it, within an episode, too: a copy goes on bit for bit."""
        begun = self._ready is not None
        return {
            "task": self.task, "given": self._given, "rng": self._rng, "agents": self.agents,
            "begun": (
                self.swarm.snapshot(), self._reported, self._count, self._hits, [end.sequence for end in self._ends],
                self._sight.memory(), self._goals,
            )
            if begun
            else None,
        }  # fmt: skip

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["task"], **state["given"])  # type: ignore[misc]
        self._rng, self.agents = state["rng"], list(state["agents"])
        if state["begun"] is not None:
            self._ready = self._prepared()  # it is the same each time
            now, reported, self._count, self._hits, sequences, seen, self._goals = state["begun"]
            self.swarm.restore(now)
            self._sight.recall(seen)
            self._reported = reported.copy()
            for endpoint, sequence in zip(self._ends, sequences, strict=True):
                endpoint.link.receive()
                endpoint.sequence = sequence

    def render(self) -> None:
        """There is nothing to see."""

    def close(self) -> None:
        """Let go of the vehicles."""
        self.swarm.close()
