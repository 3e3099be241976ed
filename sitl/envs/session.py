# SPDX-License-Identifier: BSD-3-Clause
"""Robot, world, task, observation and action of an environment, for one robot or many, below Gymnasium's classes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from functools import partial
from typing import Any, cast

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from sitl.core.array_kernels import Flags, Kernel, Line
from sitl.core.kernels import law
from sitl.worlds import World

from . import robots
from .actions import SETPOINTS, Action, Discrete
from .arena import normalised
from .costs import Costs
from .faults import EpisodeFaults, Faults
from .gathering import stands_for
from .judge import TRUTH, Judge
from .latency import LATENCY, Latency
from .latency import Memory as Late
from .observations import OBSERVATIONS, Observation
from .options import COMMON, EnvOptionError, unknown
from .parts import Part
from .past import Film, Remembering
from .pieces import observation_of
from .randomisation import Randomisation, Randomise, ranges_of
from .rewards import ByAction, Step
from .robots.robot import AskedRobot, LateRobot, PreparedRobot, Robot, TravellingRobot, world_of
from .senses import arrays_stay, reads_scan
from .starts import StartOption, Starts
from .tasks import TASKS, Task
from .worlds import PerWorld, WorldDraw, WorldOption, key_of, load_world

FORMS = ("discrete", "continuous", "normalised")
DETAILS = ("rewards", "true_pose", "estimate_error", "events")
"""What ``info`` may have besides what the task tells."""
RESET_OPTIONS = ("pose", "world", "reset_mask")
"""Options of ``reset``; the last one only in vector environments."""
MAX_STEP_S = 3600.0
"""Longest step, in simulated time [s]."""
RANDOMISE_STREAM, FAULTS_STREAM = 2 << 40, 3 << 40
"""Second words of the seeds of these random numbers. They have streams of their own, so that an episode with the same
seed has the same start and task with and without them."""


@law
def write_crash_rewards(crashed: Flags, rewards: Line, out: Line) -> None:
    """Write the rewards of steps that end in a crash, and 0 for others; shape (count,) each."""
    for i in range(out.shape[0]):
        out[i] = rewards[i] if crashed[i] else 0.0


_write_crashes = Kernel(write_crash_rewards)


@dataclass(frozen=True)
class Snapshot:
    """State of one robot and its episode; picklable."""

    robot: Any
    task: Any
    rng: Mapping[str, Any]
    """State of the random generator of later episodes."""
    steps: int = 0
    """Steps of the episode so far; counted by vector environments only."""
    ended: bool = False
    """Whether the next step of a vector environment starts another episode."""
    late: Late | None = None
    """Pending commands; None: there is no latency."""
    action: Any = None
    """The episode's last action; None: there was none."""
    films: tuple[Film, ...] = ()
    """Of what the observation remembers: pictures, parts that are seen late."""
    fault: tuple[int, float] | None = None
    """Number and time of the episode's fault; None: there are no faults."""
    world: str | World | None = None
    """The episode's world, by its name if that makes it; None: the only one that the environment has."""


@dataclass(frozen=True)
class NavigateOptions:
    """What an environment is made of; its constructor takes these by name, and the robot's own options beside them.

    Args:
        robot: name (``robots.ROBOTS``) or class.
        world: name (``sitl.worlds.names()``), .toml file or World; a list of such; seeds of one that is made
            ("rooms:seed=1..100"); or a function of a random generator that gives any of these. Each episode is in one
            of them, drawn by its seed, and ``info["world"]`` names it. None: the robot's usual one (``robots.WORLDS``).
        task: name (``tasks.TASKS``) or Task: rewards, and when an episode ends.
        observation: name (``observations.OBSERVATIONS``), names of parts (``parts.PARTS``; a list: one box of float32;
            "scan+velocity": a dict), pictures ("depth", "depth+velocity"; ``pictures.PICTURES``), a dict of such, or
            Observation.
        action: "discrete", "continuous" (in units), "normalised" (within [-1, 1]), a table (name of an action ->
            numbers of its set-point), or an Action.
        setpoint: kind of set-point of named actions, one that the robot accepts (``setpoints``); None: its default.
        step_time: simulated time of a step [s], exact; None: the robot's default.
        start: name of one of the world's start poses, "turned" (the robot's, with a random heading), "random",
            "random:N" (one of N random poses), a pose (x, y, yaw) or (x, y, z, yaw) in the world file's frame [m, rad],
            or a function of a random generator that gives one; None: the world's for the robot.
        randomise: property of the robot, "latency", or a fault whose amount is drawn -> (low, high), drawn for each
            episode; "draws" -> N: of N sets; "identified" -> True: within the airframe's intervals, too. "identified":
            within these alone.
        latency: simulated time from a decision until its command takes effect [s], a whole number of the robot's ticks.
            The previous command holds until then; at the start of an episode the robot stands or hovers.
        faults: fault, as "gps" or "motor:2=0.5" ("": none) -> when it begins in an episode [s], or (earliest, latest);
            each episode draws one of them.
        info: what ``info`` has besides what the task tells, of ``DETAILS``: "rewards", the terms of the reward as
            "reward_NAME"; "true_pose", x, y, z [m], yaw [rad] as they really are (left out where nobody knows);
            "estimate_error", the estimate minus the truth in the same columns, likewise; "events", "touched" and
            "outside".
        clip_actions: whether a number of an action in a box that is outside of its limits becomes the limit, as in
            Gymnasium's own environments; False: it is refused. Numbers that are not finite are always refused.
        judge: by what rewards, success and ends of episodes go: "truth", where the robot really is, or "estimate",
            where it believes to be. The truth of a vehicle at a connection is unknown, which is judged by its estimate
            (``Session.judge``). Observations are the estimate in any case.
        costs: what a step violates, for constrained learning: names of ``costs.COSTS``, objects of their classes,
            functions of a step, or arguments by name ({"cost": "tilt", "angle": 0.3}). ``info`` has each as "cost_NAME"
            and their sum as "cost"; ``safety.SafetyEnv`` returns it beside the reward. (): none.
        robot_options: further options of the robot's class, by name.

    Raises:
        EnvOptionError: an option that cannot be used; the message says what is allowed. (``Session`` checks them.)
    """

    robot: str | Callable[..., Robot] = "turtlebot"
    world: WorldOption | None = None
    task: str | Task = "wander"
    observation: str | Sequence[str | Part] | Mapping[str, Any] | Observation = "scan"
    action: str | Mapping[str, Sequence[float]] | Action = "discrete"
    setpoint: str | None = None
    step_time: float | None = None
    start: StartOption | None = None
    randomise: Randomise | None = None
    latency: float = 0.0
    faults: Faults | None = None
    info: Sequence[str] = ()
    clip_actions: bool = True
    judge: str = TRUTH
    costs: Any = ()
    robot_options: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> NavigateOptions:
        """From options by name; those that are not the environment's are the robot's."""
        own = {name: value for name, value in given.items() if name in COMMON}
        return cls(**own, robot_options={name: value for name, value in given.items() if name not in COMMON})


class Session:
    """Robot, task, observation and action of an environment with ``count`` robots."""

    def __init__(self, count: int, options: NavigateOptions) -> None:
        self.worlds = WorldDraw(robots.world_of(options.robot) if options.world is None else options.world)
        """What draws the worlds of episodes."""
        world = self._made_in = self.worlds.first
        self.robot = robots.load(options.robot, world, count, options.robot_options)
        scan, touched = self.robot.scan, self.robot.collided
        if scan.dtype != np.float32 or not scan.flags.c_contiguous or touched.dtype != np.int64:
            raise EnvOptionError(
                f"robot {self.robot.name!r}: scan is {scan.dtype}, collided {touched.dtype}; they must be float32, "
                "row by row in memory, and int64"
            )
        self.count = count
        self.action = self._choose_action(options.action, options.setpoint)
        self.seconds = self._check_step_time(options.step_time)
        ranges = ranges_of(options.randomise)
        self.latency = self._make_latency(options.latency, ranges)
        """None: commands take effect at once."""
        self.randomisation = Randomisation(ranges, self.robot, self.latency)
        self.faults = None if options.faults is None else EpisodeFaults(options.faults, self.robot)
        """None: nothing fails."""
        self._starts_in = PerWorld(partial(Starts, options.start, self.robot))
        self.starts = self._starts_in(world)
        """What draws start poses in the world of the last episode."""
        if self.starts.fixed is None and getattr(self.robot, "is_live", False):
            name = world.start(self.robot.name).name
            raise EnvOptionError(
                f"start {options.start!r}: a vehicle at a connection begins where it is; give the option "
                f"start={name!r} (sitl evaluate --option start={name})"
            )
        if self.starts.fixed is not None and isinstance(self.robot, PreparedRobot):
            self.robot.prepare_at(self.starts.fixed)
        self.task: Task = _named("task", options.task, TASKS, "judge")
        self.observation: Observation = observation_of(options.observation, OBSERVATIONS) or _named(
            "observation", options.observation, OBSERVATIONS, "observe"
        )
        if not isinstance(self.action.space, gym.spaces.Discrete) and any(
            isinstance(term, ByAction) for term in getattr(self.task, "terms", ())
        ):
            raise EnvOptionError('task: a reward by action (as "paper" has) needs a table of actions, as "discrete"')
        if not isinstance(options.clip_actions, bool | np.bool_):
            raise EnvOptionError(f"clip_actions = {options.clip_actions!r}; it must be True or False")
        self.check: Callable[[Any], Any] = self.action.check
        """One robot's action as a row of ``actions``; raises ``InvalidAction``."""
        self.clip_all: Callable[[Any, Any], bool] | None = None
        """The same for an array of actions: see ``Continuous.clip_all``; None: they are not clipped."""
        if options.clip_actions and hasattr(self.action, "clip"):
            self.check, self.clip_all = self.action.clip, getattr(self.action, "clip_all", None)
        self.actions = self.action.buffer(count)
        """Actions of the next ``advance``, a row a robot, as ``check`` returns them."""
        self.acted = np.zeros(count, np.bool_)
        """Whether each robot's episode has had an action, shape (count,)."""
        self.commands = np.zeros((count, self.action.setpoint.width))
        self.rewards = np.zeros(count)
        self.terminated = np.zeros(count, np.bool_)
        self.judge = Judge(self.robot, options.judge)
        """Says where robots are for the task; ``judge.by`` is "truth" or "estimate"."""
        self.step = Step(self.robot, self.seconds, self.judge)
        self.step.actions, self.step.commands, self.step.crashed = self.actions, self.commands, self.terminated
        self._touched = np.zeros(count, np.bool_)
        self._crash_paid = np.zeros(count)
        """What crashes were worth in the last step."""
        self.details = _checked_details(options.info)
        """See ``NavigateOptions.info``."""
        self.varies = False
        """Whether episodes are, or have been, in several worlds: then ``info`` names them."""
        self.world_names = np.full(count, world.name, object)
        """Of each robot's world, shape (count,)."""
        if isinstance(self.task, Task):
            self.task.judge_of = self.judge
        self.task.prepare(self.robot)
        self.costs = Costs(options.costs)
        self.costs.prepare(self.robot, self.task)
        self._allow(self.worlds)
        watch = getattr(self.observation, "watch", None)
        if watch is not None:
            watch(self.task)
        prepare = getattr(self.observation, "prepare", None)
        if prepare is not None:
            prepare(self)
        self.observation_space = self.observation.space(self.robot)
        self.remembers: tuple[Remembering, ...] = tuple(getattr(self.observation, "remembers", ()))
        """Pieces of the observation that remember the last steps."""
        readers = {"observation": self.observation, "task": self.task, "costs": self.costs}
        reading = [name for name, piece in readers.items() if reads_scan(piece)]
        if reading and not len(self.robot.angles):
            raise EnvOptionError(
                f"{' and '.join(reading)}: lidar readings are needed, and {self.robot.name!r} has no lidar "
                "(its lidar_samples is 0); choose others, or give the airframe one"
            )
        if isinstance(self.robot, AskedRobot):
            self.robot.use_scan(bool(reading))
            if self.robot.is_live:
                self._rehearse()

    def set_worlds(self, option: WorldOption) -> None:
        """Draw the worlds of later episodes from others: a curriculum. Those that have begun go on in theirs.

        Args:
            option: as the option ``world``.

        Raises:
            EnvOptionError: no such world, or one that robot or task cannot be in; those before stay.
        """
        draw = WorldDraw(option)
        self._allow(draw)
        self.worlds = draw

    def _allow(self, draw: WorldDraw) -> None:
        """Refuse worlds that the robot or the task cannot be in."""
        now = world_of(self.robot, 0)
        if not (draw.varies or self.varies) and draw.first is now:
            return
        if not isinstance(self.robot, TravellingRobot):
            raise EnvOptionError(f"world: robot {self.robot.name!r} stays in the world {now.name!r}; give one world")
        if getattr(self.task, "is_of_one_world", False):
            raise EnvOptionError(
                f"world: task {type(self.task).__name__} was given positions of one world (goal, places, gates or "
                "bays); leave them out, and each world has its own; or give one world"
            )
        try:
            for world in draw.listed or [draw.first]:
                self._enter(0, world)
        finally:
            self._enter(0, now)
        self.varies = True

    def _enter(self, index: int, world: World) -> None:
        """Let the next episode of a robot be in a world."""
        if world is not world_of(self.robot, index):
            cast(TravellingRobot, self.robot).enter(index, world)
        self.starts, self.world_names[index] = self._starts_in(world), world.name
        enter = getattr(self.task, "enter", None)
        if enter is not None:
            enter(index, self.robot)
        self.costs.enter(index, self.robot, self.task)

    @property
    def judged_by(self) -> str:
        """By what success goes: "truth" or "estimate" (``judge.JUDGES``)."""
        sees = self.judge.knows_truth and getattr(self.task, "sees_truth", False)
        return TRUTH if sees else self.judge.by

    def _rehearse(self) -> None:
        """Do once, on a robot that stands nowhere, what each step does: compiled pieces are loaded now, and not while a
        vehicle waits for its first set-point."""
        self.action.commands(self.actions, self.commands)
        self.task.start(0, self.robot, np.random.default_rng(0))
        self.observation.observe(self.robot)
        self.task.judge(self.step, self.rewards, self.terminated)
        self.info()

    def _choose_action(self, action: str | Mapping[str, Sequence[float]] | Action, setpoint: str | None) -> Action:
        robot = self.robot
        kinds = {kind.name: kind for kind in robot.setpoints}
        if setpoint is not None and (not isinstance(setpoint, str) or setpoint not in kinds):
            if isinstance(setpoint, str) and setpoint in SETPOINTS:
                why = f" ({SETPOINTS[setpoint].only})" if SETPOINTS[setpoint].only else ""
                raise EnvOptionError(f"setpoint {setpoint!r}: {robot.name} takes {', '.join(kinds)}{why}")
            raise unknown("setpoint", setpoint, kinds)
        usual = robot.setpoints[0] if setpoint is None else kinds[setpoint]
        if isinstance(action, Mapping):
            return Discrete(usual, action)
        if isinstance(action, str):
            if action not in FORMS:
                raise unknown("action", action, FORMS)
            return normalised(robot, usual) if action == "normalised" else robot.action(action, usual)
        if isinstance(action, type) or not hasattr(action, "commands"):
            raise EnvOptionError(f"action {action!r} is neither a name ({', '.join(FORMS)}) nor a table nor an Action")
        if action.setpoint.name not in kinds:
            raise EnvOptionError(f"action gives {action.setpoint.name!r}; {robot.name} takes {', '.join(kinds)}")
        return action

    def _check_step_time(self, step_time: float | None) -> float:
        seconds, tick = self.robot.step_time if step_time is None else step_time, self.robot.tick
        valid = isinstance(seconds, int | float | np.number) and math.isfinite(seconds)
        ticks = round(seconds / tick) if valid else 0
        if not 1 <= ticks <= MAX_STEP_S / tick or abs(seconds / tick - ticks) > 1e-5:
            raise EnvOptionError(
                f"step_time = {seconds!r}; it must be above 0 s, at most {MAX_STEP_S:g} s, and a whole number of "
                f"{tick:g} s"
            )
        return round(ticks * tick, 9)  # exact, also for a float32 or a sum of tenths

    def _make_latency(self, seconds: float, randomise: Randomise) -> Latency | None:
        drawn = LATENCY.name in randomise
        if drawn and seconds != 0.0:
            raise EnvOptionError(f"latency = {seconds!r}, and randomise draws one: give one of them")
        none = isinstance(seconds, int | float) and not isinstance(seconds, bool) and seconds == 0.0 and not drawn
        return None if none else Latency(self.robot, seconds, self.seconds, self.action.setpoint.width)

    def reset(self, index: int, rng: np.random.Generator, options: Mapping[str, Any] | None) -> None:
        """Start an episode of one robot; call ``look`` afterwards.

        Args:
            index: index of the robot.
            rng: random generator of its episodes.
            options: "pose": start pose (x, y, yaw) or (x, y, z, yaw) in the world frame [m, rad]; "world": that of
                this episode, in place of one that is drawn.
        """
        for option in options or ():
            if option not in RESET_OPTIONS:
                raise unknown("reset: option", option, RESET_OPTIONS[:2])
        self.acted[index] = False
        given = options.get("world") if options else None
        self._begin_in(index, self.worlds.draw(rng) if given is None else load_world(given))
        pose = self.starts.draw(rng)
        if options and options.get("pose") is not None:
            pose = self.starts.pose(options["pose"])
        seed = int(rng.integers(1 << 32))
        self.randomisation.draw(index, self.robot, (seed, RANDOMISE_STREAM))
        if self.latency is not None:
            self.latency.begin(index)
        self.robot.reset(index, pose, seed)
        self.judge.moved()
        self.randomisation.begin(index, self.robot)
        if self.faults is not None:
            self.faults.begin(index, np.random.default_rng((seed, FAULTS_STREAM)))
        self.task.start(index, self.robot, rng)
        for k, piece in enumerate(self.remembers):
            piece.start(index, seed + (k << 32))  # noise of its own

    def _begin_in(self, index: int, world: World) -> None:
        """Let a robot be in the world of its next episode."""
        if not self.varies and world is not world_of(self.robot, index):
            self._allow(WorldDraw(world))
        if self.varies:
            self._enter(index, world)

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Read the lidars of these robots (None: all) after ``reset``; ``rows`` has shape (count,)."""
        self.robot.look(rows)
        self.begin(rows)

    def begin(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """What the observation remembers begins anew for these robots (None: all), whose lidars have been read after
        ``reset``; ``look`` does this, too."""
        for piece in self.remembers:
            piece.begin(rows)

    def advance(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Advance these robots (None: all) by one step; fills ``rewards`` and ``terminated``, shapes (count,)."""
        self.action.commands(self.actions, self.commands)
        self.acted[... if rows is None else rows] = True
        if self.latency is None:
            self.robot.apply(self.action.setpoint, self.commands)
            self.robot.advance(self.seconds, rows)
        else:
            self._advance_late(self.latency, rows)
        self.judge.moved()
        if "rewards" in self.details:
            self.step.terms = {}
        self.task.judge(self.step, self.rewards, self.terminated)
        for piece in self.remembers:
            piece.note(rows)

    def _advance_late(self, latency: Latency, rows: npt.NDArray[np.bool_] | None) -> None:
        latency.post(self.commands, rows)
        self.robot.apply(self.action.setpoint, latency.due)
        cast(LateRobot, self.robot).advance_late(self.seconds, latency.waits, rows)

    def info(self) -> dict[str, npt.NDArray[Any]]:
        """What the task reports of this step, what ``details`` names, and the number of the fault that has begun; a row
        a robot. The arrays are written anew by the next step."""
        found = self.task.info(self.step)
        if self.details:
            self.write_details()
            found |= self._details_of_step()
        if self.costs:
            found |= self.costs.of(self.step)
        return found if self.faults is None else {**found, "fault": self.faults.seen(self.robot.time)}

    def infos_stay(self) -> bool:
        """Whether ``info`` returns the same arrays in each step, and ``write_details`` alone brings them up to date."""
        if not stands_for(self.task, "info_stays", "info") or self.task.terms or self.costs or self.faults is not None:
            return False
        return self.task.info_stays and arrays_stay(self.robot)

    def write_details(self) -> None:
        """Bring the arrays up to date that ``details`` names and nothing else writes."""
        details, judge = self.details, self.judge
        if "rewards" in details:
            _write_crashes.unchecked()(np.ascontiguousarray(self.step.crashed), self.rewards, self._crash_paid)
        if judge.knows_truth:
            if "true_pose" in details:
                judge.state()
            if "estimate_error" in details:
                judge.error()
        if "events" in details:
            np.not_equal(self.robot.collided, 0, self._touched)

    def _details_of_step(self) -> dict[str, npt.NDArray[Any]]:
        """What ``details`` names."""
        found: dict[str, npt.NDArray[Any]] = {}
        step, crashed = self.step, self.step.crashed
        if "rewards" in self.details:
            for name, term in (step.terms or {}).items():
                found[f"reward_{name}"] = np.where(crashed, 0.0, term)
            for name, line in self.task.paid.items() if isinstance(self.task, Task) else ():
                found[f"reward_{name}"] = line
            found["reward_crash"] = self._crash_paid
        if self.judge.knows_truth:
            if "true_pose" in self.details:
                found["true_pose"] = self.judge.state()[:, :4]
            if "estimate_error" in self.details:
                found["estimate_error"] = self.judge.error()
        if "events" in self.details:
            found["touched"], found["outside"] = self._touched, step.outside
        return found

    def abandon(self, error: BaseException) -> None:
        """A step or a reset has raised: a vehicle at a connection is handed over."""
        abandon = getattr(self.robot, "abandon", None)
        if abandon is not None:
            abandon(error)

    def snapshot(self, index: int, rng: np.random.Generator) -> Snapshot:
        """A snapshot of one robot, with the state of its random generator."""
        late = None if self.latency is None else self.latency.memory(index)
        fault = None if self.faults is None else self.faults.memory(index)
        return Snapshot(
            self.robot.snapshot(index), self.task.memory(index), rng.bit_generator.state, late=late, fault=fault,
            action=np.copy(self.actions[index]) if self.acted[index] else None,
            films=tuple(piece.memory(index) for piece in self.remembers),
            world=key_of(world_of(self.robot, index)) if self.varies else None,
        )  # fmt: skip

    def restore(self, index: int, snapshot: Snapshot, rng: np.random.Generator) -> None:
        """Restore one robot and its random generator.

        Raises:
            EnvOptionError: no snapshot, or one of another kind of robot.
        """
        if not isinstance(snapshot, Snapshot):
            raise EnvOptionError(f"{snapshot!r} is no snapshot of an environment")
        if (snapshot.late is None) != (self.latency is None):
            raise EnvOptionError("snapshot cannot be restored: of it and this environment, one has a latency")
        if (snapshot.fault is None) != (self.faults is None):
            raise EnvOptionError("snapshot cannot be restored: of it and this environment, one has faults")
        if len(snapshot.films) != len(self.remembers):
            raise EnvOptionError("snapshot cannot be restored: of it and this environment, one has other pictures or "
                                 "parts that are seen late")  # fmt: skip
        self._begin_in(index, self._made_in if snapshot.world is None else load_world(snapshot.world))
        self.task.recall(index, snapshot.task)
        self.robot.restore(index, snapshot.robot)
        self.judge.moved()
        if self.latency is not None and snapshot.late is not None:
            self.latency.recall(index, snapshot.late)
        if self.faults is not None and snapshot.fault is not None:
            self.faults.recall(index, snapshot.fault)
        for piece, film in zip(self.remembers, snapshot.films):
            piece.recall(index, film)
        self.acted[index] = snapshot.action is not None
        if snapshot.action is not None:
            self.actions[index] = snapshot.action
        rng.bit_generator.state = dict(snapshot.rng)


def _checked_details(given: Any) -> tuple[str, ...]:
    if not isinstance(given, str | Iterable):
        raise EnvOptionError(f"info = {given!r}; it must be names of {', '.join(DETAILS)}, or () for none")
    details = (given,) if isinstance(given, str) else tuple(given)
    for name in details:
        if name not in DETAILS:
            raise unknown("info", name, DETAILS)
    return details


def _named(option: str, value: Any, known: Mapping[str, Callable[[], Any]], method: str) -> Any:
    """The object of a name, or a copy of the given object, so that two environments do not share its state."""
    if isinstance(value, str):
        if value not in known:
            raise unknown(option, value, known)
        return known[value]()
    if isinstance(value, type) or not hasattr(value, method):
        raise EnvOptionError(f"{option} {value!r} is neither a name ({', '.join(known)}) nor an object with {method}()")
    return deepcopy(value)
