# SPDX-License-Identifier: BSD-3-Clause
"""What an environment needs of a robot. An object stands for one robot or for many, all alone in the same world.

Poses are in the frame of world files: x forward, y left, z up [m], yaw counter-clockwise [rad].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from sitl.vehicles.figures.figure import Figure
from sitl.worlds import World

from ..setpoints import Setpoint

if TYPE_CHECKING:
    from ..actions import Action

Floats = npt.NDArray[np.float64]
Pose = tuple[float, float, float, float]
"""x, y, z, yaw."""


@dataclass(frozen=True)
class Volume:
    """The vertical cylinder that a robot takes up."""

    radius: float
    """[m]."""
    bottom: float
    """Above the z of its pose [m]."""
    top: float
    """[m]."""


class Robot(Protocol):
    """One robot, or many. Its class is called with ``world`` and ``count``, and options of its own."""

    name: str
    count: int
    world: World
    volume: Volume
    tick: float
    """A step of an environment is a whole number of these [s]."""
    step_time: float
    """Of a step when the user does not say [s]."""
    crash_range: float
    """A reading below it is a crash [m], when the task does not say."""
    setpoints: tuple[Setpoint, ...]
    """Kinds that ``apply`` takes; the first is the default."""
    figures: Mapping[str, Figure]
    """What ``set_figure`` may change, and within which limits."""
    range_max: float
    """No reading but inf is greater [m]."""
    digit_when_inf: int
    """The paper's digit for a reading of inf."""
    angles: Floats
    """Of the readings [rad], counter-clockwise from straight ahead, shape (readings,)."""
    scan: npt.NDArray[np.float32]
    """Readings of the planar lidar [m], shape (count, readings), inf for nothing in range: each call writes into it."""

    @property
    def pose(self) -> Floats:
        """x, y, z [m], yaw [rad], shape (count, 4)."""

    @property
    def velocity(self) -> Floats:
        """Forward, left, up [m/s], turn rate [rad/s], shape (count, 4)."""

    @property
    def collided(self) -> npt.NDArray[np.int64]:
        """1 for each robot that hit something during the last ``advance``, shape (count,)."""

    @property
    def time(self) -> Floats:
        """Simulated time since the reset [s], shape (count,)."""

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """The usual actions of this robot: ``form`` "discrete" or "continuous", giving ``setpoint``."""

    def reset(self, index: int, pose: Pose, seed: int) -> None:
        """Put one robot to a pose, ready to move; ``look`` or ``advance`` follows. Same arguments, same future."""

    def look(self, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Read the lidars of these robots (None: all) where they are, without time passing."""

    def apply(self, setpoint: Setpoint, commands: Floats) -> None:
        """Set-points for the next ``advance``, shape (count, setpoint.width)."""

    def advance(self, seconds: float, rows: npt.NDArray[np.bool_] | None = None) -> None:
        """Move these robots (None: all) on by simulated time, and read all lidars; those not moved only look."""

    def set_figure(self, index: int, name: str, value: float) -> None:
        """Change a figure of one robot before its ``reset``."""

    def snapshot(self, index: int) -> Any:
        """All of one robot that ``restore`` needs to go on bit for bit; can be pickled."""

    def restore(self, index: int, snapshot: Any) -> None:
        """Put one robot back."""

    def close(self) -> None:
        """Let go of what is open."""


class LateRobot(Robot, Protocol):
    """What the option ``latency`` needs besides."""

    def advance_late(
        self, seconds: float, waits: npt.NDArray[np.int64], rows: npt.NDArray[np.bool_] | None = None
    ) -> None:
        """As ``advance``, but the commands of ``apply`` reach robot i only after ``waits[i]`` ticks; until then it goes
        on as before. A robot whose wait is as long as the step gets none."""
