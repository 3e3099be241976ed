# SPDX-License-Identifier: BSD-3-Clause
"""What vehicles of a swarm are to do together, and what it is worth to each."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from sitl.core import elementary_arrays as arrays
from sitl.core.elementary import cos, sin
from sitl.core.sums import lengths

Floats = npt.NDArray[np.float64]
HEIGHT = 5.0
"""At which copters begin [m]."""
NEAR = 1.0
"""A position is reached within this [m]."""


class Scene(NamedTuple):
    """Where the vehicles really are after a step, in their order; NED from the world's origin."""

    positions: Floats
    """[m], shape (n, 3)."""
    before: Floats
    """The same before the step."""
    goals: Floats
    """Where they are to be [m], shape (n, 3)."""
    goals_before: Floats
    """Where they were to be before the step [m], shape (n, 3)."""


class Task(Protocol):
    """A task; one object for each environment."""

    frames: tuple[str, ...]
    """Airframes of the vehicles."""
    spacing: float
    """Of the grid on which they begin [m]."""

    def begin(self, positions: Floats, rng: np.random.Generator) -> None:
        """A new episode, with the vehicles at positions [m], shape (n, 3)."""

    def goals(self, positions: Floats, time: float) -> Floats:
        """Where each is to be at a time since the beginning [s], as positions [m], shape (n, 3)."""

    def rewards(self, scene: Scene) -> Floats:
        """Of a step, shape (n,)."""

    def is_success(self, scene: Scene) -> npt.NDArray[np.bool_]:
        """Whether each is where it is to be, shape (n,)."""

    def is_over(self, scene: Scene) -> bool:
        """Whether the episode ends for all."""


def distances(scene: Scene) -> Floats:
    """From each to its goal [m], shape (n,)."""
    found: Floats = lengths(scene.positions - scene.goals)
    return found


class _Task:
    """What most tasks have in common: each vehicle has a position to be at."""

    spacing = 6.0

    def __init__(self, frames: tuple[str, ...]) -> None:
        self.frames = frames
        self._goals: Floats = np.zeros((len(frames), 3))

    def begin(self, positions: Floats, rng: np.random.Generator) -> None:
        """See ``Task``."""
        raise NotImplementedError

    def goals(self, positions: Floats, time: float) -> Floats:
        """See ``Task``."""
        return self._goals

    def rewards(self, scene: Scene) -> Floats:
        """How much less far it is from its position than before the step [m], and 0.1 for being there.

        Each distance is to the position of its time. So an episode pays what the distance has become less from its
        beginning to its end, however the position moves: to chase it earns nothing.
        """
        nearer: Floats = lengths(scene.before - scene.goals_before) - distances(scene)
        return nearer + 0.1 * self.is_success(scene)

    def is_success(self, scene: Scene) -> npt.NDArray[np.bool_]:
        """See ``Task``."""
        return distances(scene) < NEAR

    def is_over(self, scene: Scene) -> bool:
        """Never before its time."""
        return False


class Formation(_Task):
    """Copters keep their positions on a ring whose middle moves; radius [m] and direction are drawn."""

    SPEED, TURN = 0.5, 0.05
    """[m/s], [rad/s]"""

    def __init__(self, count: int = 4) -> None:
        super().__init__(("erle_copter",) * count)

    def begin(self, positions: Floats, rng: np.random.Generator) -> None:
        """See ``Task``."""
        n = len(positions)
        self._middle, self._direction = positions.mean(axis=0), rng.uniform(-math.pi, math.pi)
        self._middle[2] = -HEIGHT
        self._radius, self._first = max(rng.uniform(4.0, 7.0), 0.5 * n), rng.uniform(-math.pi, math.pi)

    def goals(self, positions: Floats, time: float) -> Floats:
        """See ``Task``."""
        angles = self._first + self.TURN * time + math.tau * np.arange(len(positions)) / len(positions)
        along = self.SPEED * time * np.array((cos(self._direction), sin(self._direction), 0.0))
        ring = np.stack((arrays.cos(angles), arrays.sin(angles), np.zeros(len(positions))), axis=1)
        found: Floats = self._middle + along + self._radius * ring
        return found


class Crossing(_Task):
    """Each copter changes places with the one opposite: their paths cross."""

    def __init__(self, count: int = 4) -> None:
        super().__init__(("erle_copter",) * count)

    def begin(self, positions: Floats, rng: np.random.Generator) -> None:
        """See ``Task``."""
        middle = positions.mean(axis=0)
        self._goals = 2.0 * middle - positions
        self._goals[:, :2] += rng.uniform(-0.5, 0.5, (len(positions), 2))
        self._goals[:, 2] = -HEIGHT


class Pursuit(_Task):
    """All copters but the last one are to come within 2 m of that one, which is to get away."""

    CAUGHT = 2.0

    def __init__(self, count: int = 3) -> None:
        super().__init__(("erle_copter",) * count)

    def begin(self, positions: Floats, rng: np.random.Generator) -> None:
        """See ``Task``."""
        self._direction = rng.uniform(-math.pi, math.pi)

    def goals(self, positions: Floats, time: float) -> Floats:
        """The pursued one for the others; for it, a position 20 m away in a direction that was drawn."""
        found: Floats = np.repeat(positions[-1:], len(positions), axis=0)
        found[-1] += 20.0 * np.array((cos(self._direction), sin(self._direction), 0.0))
        return found

    def _gap(self, positions: Floats) -> float:
        return float(lengths(positions[:-1] - positions[-1]).min())

    def rewards(self, scene: Scene) -> Floats:
        """What the least distance has become less [m], and 10 for the catch; the opposite for the last one."""
        gain = self._gap(scene.before) - self._gap(scene.positions) + 10.0 * self.is_over(scene)
        found = np.full(len(scene.positions), gain)
        found[-1] = -gain
        return found

    def is_success(self, scene: Scene) -> npt.NDArray[np.bool_]:
        """The catch is a success of the pursuers."""
        found = np.full(len(scene.positions), self.is_over(scene))
        found[-1] = not found[-1]
        return found

    def is_over(self, scene: Scene) -> bool:
        """When it is caught."""
        return self._gap(scene.positions) < self.CAUGHT


class Escort(_Task):
    """A rover drives to a position; the copters, of which there are all but one, keep around it,
    3 m above the ground."""

    RADIUS, ABOVE = 2.5, 3.0

    def __init__(self, count: int = 3) -> None:
        super().__init__((*("erle_copter",) * (count - 1), "ardupilot_rover"))

    def begin(self, positions: Floats, rng: np.random.Generator) -> None:
        """See ``Task``."""
        away, direction = rng.uniform(8.0, 15.0), rng.uniform(-math.pi, math.pi)
        self._to = positions[-1] + away * np.array((cos(direction), sin(direction), 0.0))

    def goals(self, positions: Floats, time: float) -> Floats:
        """See ``Task``."""
        n = len(positions) - 1
        angles = math.tau * np.arange(n) / n
        found: Floats = np.empty_like(positions)
        found[:-1] = positions[-1] + self.RADIUS * np.stack(
            (arrays.cos(angles), arrays.sin(angles), np.zeros(n)), axis=1
        )
        found[:-1, 2] = -self.ABOVE
        found[-1] = self._to
        return found


TASKS: dict[str, Any] = {"formation": Formation, "crossing": Crossing, "pursuit": Pursuit, "escort": Escort}
"""By name; each takes the number of vehicles."""
