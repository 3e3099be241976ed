# SPDX-License-Identifier: BSD-3-Clause
"""Tasks of the ids "-v1". Ending early never pays, and neither does staying near the goal.

Three rules, which ``benchmarks.cheating`` checks for every id by playing against them:

- From whatever state, a crash, the floor or the end of the arena is worth less than whatever else until the time limit.
  ``FAIL`` is less than the price of the whole time plus all that progress could still lose: see ``worst_of``.
- Reaching the goal pays more than all progress. Progress is the difference of a potential (Ng, Harada and Russell,
  "Policy invariance under reward transformations", ICML 1999), so that paths that come back to their start earn
  nothing.
- Where each second near a target pays, it pays by a curve that is steep about the radius of success.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from sitl.core.elementary import cos, sin

from .ids import TASKS
from .targets.among import Among
from .targets.gates import Gate, Gates
from .targets.hold import Hold
from .targets.landing import Land
from .targets.moving import Follow, Trajectory
from .targets.parking import Park
from .targets.waypoints import Waypoints
from .tasks import Task

TRACK = [
    Gate(10.0 + 8.0 * cos(angle), 12.0 * sin(angle), 2.5 + sin(2.0 * angle), angle + math.pi / 2)
    for angle in (math.radians(-120.0 + 60.0 * k) for k in range(6))
]
"""An oval of six gates, counter-clockwise."""
COPTER_STEP, ROVER_STEP = 0.1, 0.2
"""Simulated time of a step [s]."""
WHOLE_TIME = 5.0
"""What an episode pays for all of its time."""
GOAL = 20.0
"""For reaching it."""
NEARBY = 12.0
"""Distance from which on progress counts, where a failure is near each success [m]: so a crash need not cost the whole
arena's, and who has not learnt yet dares to try."""
HALF, HOVER_HALF = 0.7, 0.5
"""Of curves of nearness [m]. Hovering has its radius of success, or circles just outside of it pay almost half."""
FAR = 20.0
"""Of goal-conditioned tasks: see ``Hold`` [m]."""


def _price(preset: str, progress: float, fail: float, whole: float = WHOLE_TIME, **others: Any) -> dict[str, Any]:
    """Arguments of a task in which a goal is to be reached; ``whole``: what the whole time costs."""
    step = COPTER_STEP if preset.startswith("copter") else ROVER_STEP
    return {
        "progress": progress, "each_second": -whole / (step * TASKS[preset].steps), "crash_reward": fail,
        "out_reward": fail, "floor_ends": True, **others,
    }  # fmt: skip


def _waypoints(preset: str, count: int) -> Task:
    return Waypoints(count, place_reward=GOAL, **_price(preset, 0.5, -30.0))


def _land(preset: str, **others: Any) -> Task:
    return Land(far=NEARBY, success_reward=GOAL, **{**_price(preset, 1.0, -16.0, 2.0), "floor_ends": False}, **others)


def _among(preset: str, progress: float, fail: float, **others: Any) -> Task:
    return Among(place_reward=GOAL, **_price(preset, progress, fail, **others))


def _sparse(offset: tuple[float, float], limit: float) -> Task:
    """Nothing ends an episode early in the world without solids. A crash pays for all steps that it saves. Where no
    episode reaches the goal, each is worth less the farther it ends: who has not learnt yet does not drift away."""
    return Hold(offset, 1.0, is_sparse=True, far=FAR, out_ends=False, crash_reward=-limit, out_reward=0.0)


_LOST: dict[str, Any] = {"half": HALF, "floor_ends": True, "lost_reward": -10.0}
MADE: dict[str, Callable[[], Task]] = {
    "copter-hover": lambda: Hold(half=HOVER_HALF, floor_ends=True),
    "copter-reach-goal": lambda: _sparse((5.0, 2.0), TASKS["copter-reach-goal"].steps),
    "rover-reach-goal": lambda: _sparse((8.0, 0.0), TASKS["rover-reach-goal"].steps),
    "copter-waypoint": lambda: _waypoints("copter-waypoint", 1),
    "copter-course": lambda: _waypoints("copter-course", 5),
    "copter-gates": lambda: Gates(TRACK, **_price("copter-gates", 0.5, -40.0)),
    "copter-race": lambda: Gates(TRACK, laps=3, **_price("copter-race", 0.5, -40.0)),
    "copter-trajectory": lambda: Trajectory("eight", speed=(1.0, 3.0), **_LOST),
    "copter-follow": lambda: Follow(**_LOST),
    "copter-land": lambda: _land("copter-land"),
    "copter-land-moving": lambda: _land("copter-land-moving", speed=0.5),
    "copter-forest": lambda: _among("copter-forest", 0.5, -50.0, ceiling=3.0),
    "copter-rooms": lambda: _among("copter-rooms", 0.5, -40.0, ceiling=3.0),
    "rover-waypoint": lambda: _waypoints("rover-waypoint", 1),
    "rover-course": lambda: _waypoints("rover-course", 4),
    "rover-labyrinth": lambda: _among("rover-labyrinth", 0.2, -40.0),
    "rover-slalom": lambda: Gates(far=NEARBY, **_price("rover-slalom", 1.0, -16.0, 2.0)),
    "rover-race": lambda: Gates(laps=2, **_price("rover-race", 0.5, -40.0)),
    "rover-parking": lambda: Park(success_reward=GOAL, turn_progress=1.0, **_price("rover-parking", 0.5, -40.0)),
}
"""By the name of the preset."""


RECEIVERS = {
    **dict.fromkeys(
        (
            "copter-hover",
            "copter-reach-goal",
            "rover-reach-goal",
            "copter-trajectory",
            "copter-follow",
            "rover-parking",
        ),
        "rtk",
    ),
    "copter-rooms": "uwb",
}
"""Receivers (option ``sensors``) of tasks whose success is finer than what an ordinary GPS tells: 0.4 to 1 m, for
seconds or on average; and in a house, where there are no satellites."""


def worst_of(task: Any, seconds: float) -> float:
    """The least that an episode can still be worth that goes on until its time limit, from whatever state.

    Args:
        task: a prepared one.
        seconds: time limit of an episode [s].
    """
    time, per_metre = float(getattr(task, "each_second", 0.0)), float(getattr(task, "progress", 0.0))
    (x0, y0, z0), (x1, y1, z1) = task._limits
    x, y, z = x1 - x0, y1 - y0, (z1 - max(z0, 0.0)) if task.flies else 0.0
    width = min(math.sqrt(x * x + y * y + z * z), float(getattr(task, "far", math.inf)))
    turn = math.pi * float(getattr(task, "turn_progress", 0.0))
    effort = float(getattr(task, "effort", 0.0)) * seconds
    return time * seconds - per_metre * width - turn - effort
