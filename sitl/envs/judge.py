# SPDX-License-Identifier: BSD-3-Clause
"""By what tasks judge: where robots really are, or where they believe that they are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .options import unknown
from .robots.robot import Floats, Robot
from .senses import SensingRobot

TRUTH, ESTIMATE = "truth", "estimate"
JUDGES = (TRUTH, ESTIMATE)
"""Values of the option ``judge``."""


class Judge:
    """Poses and velocities that rewards, success and ends of episodes go by.

    Args:
        robot: the robots.
        asked: of ``JUDGES``. Where nobody knows the truth, as of a vehicle at a connection, it is the estimate.

    Raises:
        EnvOptionError: another value.
    """

    def __init__(self, robot: Robot, asked: str = TRUTH) -> None:
        if asked not in JUDGES:
            raise unknown("judge", asked, JUDGES)
        self._robot: Any = robot
        self.knows_truth = isinstance(robot, SensingRobot) and bool(getattr(robot, "knows_truth", False))
        """Whether anybody knows where the robots really are."""
        self.by = TRUTH if asked == TRUTH and self.knows_truth else ESTIMATE
        """Of ``JUDGES``: what it goes by."""
        self._state: Floats | None = None
        self._is_true = self.by == TRUTH

    def moved(self) -> None:
        """Robots have moved: what was known of them is old."""
        self._state = None

    def state(self) -> Floats:
        """True states, as ``SensingRobot.true_state``; calculated once a step. To be read only."""
        if self._state is None:
            self._state = self._robot.true_state()
        return self._state

    @property
    def pose(self) -> Floats:
        """x, y, z [m], yaw [rad] in the world's frame, shape (count, 4). To be read only."""
        out: Floats = self.state()[:, :4] if self._is_true else self._robot.pose
        return out

    @property
    def velocity(self) -> Floats:
        """Forward, left, up [m/s], turn rate [rad/s], shape (count, 4). To be read only."""
        out: Floats = self.state()[:, 4:8] if self._is_true else self._robot.velocity
        return out

    def error(self) -> Floats:
        """Estimate minus truth: x, y, z [m], yaw [rad] within -pi .. pi, shape (count, 4); where ``knows_truth``."""
        out: Floats = self._robot.pose - self.state()[:, :4]
        out[:, 3] = np.remainder(out[:, 3] + math.pi, math.tau) - math.pi
        return out

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_state": None}
