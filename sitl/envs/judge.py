# SPDX-License-Identifier: BSD-3-Clause
"""By what tasks judge: where robots really are, or where they believe that they are."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sitl.core.array_kernels import Kernel, Table
from sitl.core.kernels import law

from .options import unknown
from .robots.robot import Floats, Robot
from .senses import SensingRobot, arrays_stay

TRUTH, ESTIMATE = "truth", "estimate"
JUDGES = (TRUTH, ESTIMATE)
"""Values of the option ``judge``."""


@law
def write_errors(pose: Table, truth: Table, out: Table) -> None:
    """Write estimates minus truth: x, y, z [m], yaw [rad] within -pi .. pi, shape (count, 4 or more) each."""
    for i in range(out.shape[0]):
        for k in range(4):
            out[i, k] = pose[i, k] - truth[i, k]
        out[i, 3] = (out[i, 3] + math.pi) % math.tau - math.pi


_errors = Kernel(write_errors)


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
        self._is_reported = False
        """Whether somebody says when robots move."""
        self._stays = arrays_stay(robot)
        self._is_true = self.by == TRUTH
        self._error = np.zeros((len(robot.pose), 4))

    def moved(self) -> None:
        """Robots have moved: what was known of them is old."""
        self._state, self._is_reported = None, True

    def state(self) -> Floats:
        """True states, as ``SensingRobot.true_state``; calculated once a step. To be read only."""
        if self._state is None or not self._is_reported:
            self._state = self._robot.true_state()
        return self._state

    def table(self) -> Floats:
        """Columns of ``pose`` and ``velocity``, and maybe more, in one piece, shape (count, 8 or more). To be read
        only."""
        if self._is_true:
            return np.ascontiguousarray(self.state(), np.float64)
        robot = self._robot
        found: Floats = robot.state if self._stays else np.concatenate([robot.pose, robot.velocity], axis=1)
        return found

    def true_table(self) -> Floats:
        """The same as it really is; where nobody knows, the estimate."""
        return np.ascontiguousarray(self.state(), np.float64) if self.knows_truth else self.table()

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
        """Estimate minus truth: x, y, z [m], yaw [rad] within -pi .. pi, shape (count, 4); where ``knows_truth``.
        The array is used again."""
        _errors.unchecked()(np.ascontiguousarray(self._robot.pose), self.true_table(), self._error)
        return self._error

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_state": None}
