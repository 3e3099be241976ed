# SPDX-License-Identifier: BSD-3-Clause
"""Environments as data: the options of each id."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from . import paper, tasks_v1
from .actions import VELOCITY, Continuous, Normalised
from .boxes import GoalConditioned
from .ids import FIRST, NEW, task_of
from .judge import ESTIMATE, TRUTH
from .navigate import Navigate
from .session import DETAILS
from .starts import Near
from .targets.among import Among
from .targets.gates import Gates
from .targets.hold import Hold
from .targets.landing import Land
from .targets.moving import Follow, Trajectory
from .targets.parking import Park
from .targets.waypoints import Waypoints
from .tasks import Task
from .tasks_v1 import TRACK
from .worlds import TRAINING

SEEN = ("goal", "velocity", "attitude", "rates", "last_action")
ON_A_PATH = ("path", "velocity", "attitude", "rates", "last_action")
AMONG = (*SEEN, "scan")
INDOORS = (*AMONG, "pose", "heading")
DRIVEN = ("goal", "velocity", "last_action")
DRIVEN_ON_A_PATH = ("path", "velocity", "last_action")


def _copter_moves(fast: float) -> dict[str, tuple[float, ...]]:
    slow, climb = 0.8, 0.8
    return {
        "stay": (0.0, 0.0, 0.0, 0.0),
        "forward": (fast, 0.0, 0.0, 0.0),
        "forward left": (fast, fast, 0.0, 0.0),
        "left": (0.0, fast, 0.0, 0.0),
        "back left": (-fast, fast, 0.0, 0.0),
        "back": (-fast, 0.0, 0.0, 0.0),
        "back right": (-fast, -fast, 0.0, 0.0),
        "right": (0.0, -fast, 0.0, 0.0),
        "forward right": (fast, -fast, 0.0, 0.0),
        "slowly forward": (slow, 0.0, 0.0, 0.0),
        "slowly left": (0.0, slow, 0.0, 0.0),
        "slowly back": (-slow, 0.0, 0.0, 0.0),
        "slowly right": (0.0, -slow, 0.0, 0.0),
        "up": (0.0, 0.0, climb, 0.0),
        "down": (0.0, 0.0, -climb, 0.0),
    }


COPTER_MOVES = _copter_moves(3.0)
COPTER_MOVES_AMONG = {**_copter_moves(1.5), "turn left": (0.0, 0.0, 0.0, 1.2), "turn right": (0.0, 0.0, 0.0, -1.2)}
"""Among solids: it stops within what its lidar sees, and turns the lidar, which is blind behind."""
ROVER_MOVES = {
    "forward": (1.2, 0.0, 0.0, 0.0),
    "left": (0.8, 0.0, 0.0, 0.6),
    "right": (0.8, 0.0, 0.0, -0.6),
    "back": (-1.2, 0.0, 0.0, 0.0),
    "back left": (-0.8, 0.0, 0.0, -0.6),
    "back right": (-0.8, 0.0, 0.0, 0.6),
    "stay": (0.0, 0.0, 0.0, 0.0),
}
"""Velocities: forward, left, up [m/s], turn [rad/s]."""
FIRST_DETAILS = ("rewards", "true_pose", "events")
"""What ``info`` of ids "-v0" has besides what the task tells."""


def _copter(task: Task, parts: tuple[str, ...] = SEEN, **options: Any) -> dict[str, Any]:
    return {
        "robot": "erle_copter", "world": "open", "take_off": 3.0, "step_time": 0.1, "task": task,
        "observation": list(parts), "action": "normalised", "setpoint": "velocity", "info": FIRST_DETAILS,
        "judge": ESTIMATE, "boots": 1, **options,
    }  # fmt: skip


def _rover(task: Task, parts: tuple[str, ...] = DRIVEN, **options: Any) -> dict[str, Any]:
    return {
        "robot": "erle_rover", "world": "open", "step_time": 0.2, "task": task, "observation": list(parts),
        "action": "normalised", "setpoint": "velocity", "info": FIRST_DETAILS, "judge": ESTIMATE,
        "boots": 1, **options,
    }  # fmt: skip


def _among(crash: float = -20.0, **others: Any) -> Task:
    """One position among solids. To leave the arena costs as much as a crash, or robots that are stuck learn to
    leave."""
    return Among(crash_reward=crash, out_reward=crash, **others)


def _slow() -> Normalised:
    """Velocities of a copter among solids, which stops within what its lidar sees."""
    return Normalised(Continuous(VELOCITY, (-2.0, -2.0, -1.0, -1.5), (2.0, 2.0, 1.0, 1.5)))


WIND = {"wind_speed": (0.0, 5.0), "wind_direction": (0.0, 360.0), "wind_turbulence": (0.0, 1.0)}
_CONTINUOUS: dict[str, Callable[[], dict[str, Any]]] = {
    "copter-hover": lambda: _copter(Hold(), randomise=WIND),
    "copter-reach-goal": lambda: _copter(
        Hold((5.0, 2.0), 1.0, is_sparse=True),
        observation=GoalConditioned(("heading", *SEEN[1:])),
        action=Normalised(Continuous(VELOCITY, (-5.0, -5.0, -2.0), (5.0, 5.0, 2.0), (0, 1, 2))),  # it does not turn
    ),
    "rover-reach-goal": lambda: _rover(
        Hold((8.0, 0.0), 1.0, is_sparse=True), observation=GoalConditioned(("heading", *DRIVEN[1:]))
    ),
    "copter-waypoint": lambda: _copter(Waypoints(1)),
    "copter-course": lambda: _copter(Waypoints(5), ON_A_PATH),
    "copter-gates": lambda: _copter(Gates(TRACK), ON_A_PATH),
    "copter-race": lambda: _copter(Gates(TRACK, laps=3), ON_A_PATH),
    "copter-trajectory": lambda: _copter(Trajectory("eight", speed=(1.0, 3.0)), ON_A_PATH),
    "copter-follow": lambda: _copter(Follow(), ON_A_PATH),
    "copter-land": lambda: _copter(Land()),
    "copter-land-moving": lambda: _copter(Land(speed=0.5), ON_A_PATH),
    "copter-forest": lambda: _copter(_among(ceiling=3.0), AMONG, world="forest:seed=1", take_off=1.5, action=_slow()),
    # Rooms: a crash costs less than to hover until the time limit, or policies learn to hover.
    "copter-rooms": lambda: _copter(
        _among(-10.0, ceiling=3.0), INDOORS, world="rooms:seed=1", take_off=1.5, action=_slow()
    ),
    "rover-waypoint": lambda: _rover(Waypoints(1)),
    "rover-course": lambda: _rover(Waypoints(4), DRIVEN_ON_A_PATH),
    "rover-labyrinth": lambda: _rover(
        _among(), (*DRIVEN, "scan", "pose", "heading"), world="labyrinth:seed=1,size=60,scale=3"
    ),
    "rover-slalom": lambda: _rover(
        Gates(crash_reward=-20.0), DRIVEN_ON_A_PATH, world="slalom:seed=1", start=Near((0.0, 0.0, 0.0), (1.0, 1.5, 0.4))
    ),
    "rover-race": lambda: _rover(Gates(laps=2, crash_reward=-20.0), (*DRIVEN_ON_A_PATH, "scan"), world="track:seed=1"),
    "rover-parking": lambda: _rover(
        Park(crash_reward=-20.0),
        ("goal", "goal_heading", "velocity", "last_action", "scan"),
        world="car_park:seed=1",
        start=Near((0.0, 0.0, 0.0), (8.0, 2.0, math.pi)),
    ),
}


def _discrete(preset: str) -> Callable[[], dict[str, Any]]:
    moves: Mapping[str, tuple[float, ...]] = COPTER_MOVES if preset.startswith("copter") else ROVER_MOVES
    if preset in ("copter-forest", "copter-rooms"):
        moves = COPTER_MOVES_AMONG
    return lambda: {**_CONTINUOUS[preset](), "action": moves}


_FIRST = {**_CONTINUOUS, **{f"{preset}discrete": _discrete(preset) for preset in _CONTINUOUS}}


def _second(preset: str) -> Callable[[], dict[str, Any]]:
    """Options of the id "-v1": the same robot, observations and actions, judged by the truth. Among solids, each
    episode has another world."""
    name = task_of(preset)
    receiver = {"sensors": tasks_v1.RECEIVERS[name]} if name in tasks_v1.RECEIVERS else {}
    world = {"world": TRAINING[name]} if name in TRAINING else {}
    task = tasks_v1.MADE[name]

    def options() -> dict[str, Any]:
        found = {**_FIRST[preset](), "task": task(), "judge": TRUTH, "info": DETAILS, **receiver, **world}
        del found["boots"]  # as many as usual
        return found

    return options


PRESETS: dict[str, Callable[[], dict[str, Any]]] = {
    **paper.PRESETS,
    **_FIRST,
    **{f"{preset}-v1": _second(preset) for preset in _FIRST},
}
"""Options of ``Navigate`` by the preset's name; ``sitl.envs.ids`` says which environment has which."""
assert all(listed.preset in PRESETS for listed in (FIRST | NEW).values())


_OTHERS = ("connection", "robot", "frame")
"""Options with which a vehicle has receivers of its own."""


_ONE_WORLD = ("connection", "gcs")
"""Options with which a vehicle stays in one world."""


def _stays(given: Mapping[str, Any]) -> bool:
    """Whether options ask for a robot or a task that can be in one world only."""
    vehicle = any(given.get(name) not in (None, "inprocess", "native") for name in _ONE_WORLD)
    return vehicle or callable(given.get("robot")) or bool(getattr(given.get("task"), "is_of_one_world", False))


def options_of(preset: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a preset, with those that are given in their place; a box that is made for one kind of set-point
    gives way to the usual one when another kind is asked for. A vehicle at a connection keeps its own wind, and what
    belongs to one world is in that of the first version."""
    options = {**PRESETS[preset](), **given}
    if "world" not in given and _stays(given):
        options["world"] = PRESETS[preset.removesuffix("-v1")]()["world"]
    if options.get("sensors") == "uwb" and "sensors" not in given and options.get("autopilot", "native") != "native":
        options["sensors"] = "rtk"  # another autopilot simulates its receiver itself, and beacons are none of its own
    if options.get("connection", "inprocess") != "inprocess" and "randomise" not in given:
        options["randomise"] = None
    if "sensors" not in given and any(given.get(name, "inprocess") != "inprocess" for name in _OTHERS):
        options.pop("sensors", None)
    action = options.get("action")
    if isinstance(action, Normalised) and options.get("setpoint", action.setpoint.name) != action.setpoint.name:
        options["action"] = "normalised"
    return options


class PresetNavigate(Navigate):
    """An environment of a preset; every option of ``Navigate`` can still be replaced."""

    def __init__(self, preset: str, **options: Any) -> None:
        super().__init__(**options_of(preset, options))
