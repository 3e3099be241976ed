# SPDX-License-Identifier: BSD-3-Clause
"""What a robot says of itself, by name: columns of its state, as telemetry reports it or as it really is."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from .mavlink import reports
from .robots.robot import Floats

FASTEST, FASTEST_TURN = 50.0, 40.0
"""Bounds of velocities [m/s] and of rates of turn [rad/s]; what is beyond is clipped."""
FAR = 10_000.0
"""Bound of coordinates [m]: that of world files."""


class Report(NamedTuple):
    """Columns of what a vehicle reports besides its state."""

    columns: tuple[str, ...]
    """Name and unit of each number."""
    low: tuple[float, ...]
    high: tuple[float, ...]
    """What is beyond is clipped."""
    first: int
    """Column of ``ReportingRobot.reports`` where they begin."""
    message: str
    """Of MAVLink, which is asked for."""


_SHOCK, _GALE = 160.0, 50.0
"""Bounds of specific force [m/s^2], of wind [m/s]."""
REPORTS = {
    "acceleration": Report(
        ("specific force forward [m/s^2]", "left [m/s^2]", "up [m/s^2]"), 3 * (-_SHOCK,), 3 * (_SHOCK,),
        reports.ACCELERATION, "SCALED_IMU",
    ),
    "battery": Report(
        ("voltage [V]", "current [A]", "charge left [0, 1]"), 3 * (0.0,), (66.0, 330.0, 1.0), reports.BATTERY,
        "SYS_STATUS",
    ),
    "wind": Report(
        ("wind forward [m/s]", "wind to the left [m/s]"), 2 * (-_GALE,), 2 * (_GALE,), reports.WIND, "WIND"
    ),
    "range_finder": Report(("range below [m]",), (0.0,), (601.0,), reports.RANGE, "RANGEFINDER"),
}  # fmt: skip
"""By name."""


_WIND = REPORTS["wind"]
TRUE_REPORTS = {
    "true_acceleration": REPORTS["acceleration"]._replace(first=0, message=""),
    "true_battery": REPORTS["battery"]._replace(first=3, message=""),
    "true_wind": Report((*_WIND.columns, "wind up [m/s]"), 3 * (-_GALE,), 3 * (_GALE,), 6, ""),
}
"""By name; columns are those of ``ReportingRobot.true_reports``."""


class Sense(NamedTuple):
    """Columns of a robot's state."""

    columns: tuple[str, ...]
    """Name and unit of each number."""
    bounds: tuple[float, ...]
    """Each number is within +- its bound."""
    first: int
    """Column of the state where they begin."""


_POSE = Sense(("x [m]", "y [m]", "z [m]", "yaw [rad]"), (FAR, FAR, FAR, math.pi), 0)
_VELOCITY = Sense(
    ("forward [m/s]", "left [m/s]", "up [m/s]", "turn [rad/s]"), (FASTEST, FASTEST, FASTEST, FASTEST_TURN), 4
)
_ATTITUDE = Sense(("roll [rad]", "pitch [rad]"), (math.pi, math.pi), 8)
_RATES = Sense(("roll rate [rad/s]", "pitch rate [rad/s]"), (FASTEST_TURN, FASTEST_TURN), 10)
SENSES = {"pose": _POSE, "velocity": _VELOCITY, "attitude": _ATTITUDE, "rates": _RATES}
"""By name; "true_..." is the same of where the robot really is."""
TRUE = "true_"


@runtime_checkable
class SensingRobot(Protocol):
    """A robot with a state of 12 numbers: x, y, z [m], yaw [rad] in the world's frame; forward, left, up [m/s], turn
    [rad/s]; roll to the right, pitch up [rad], their rates [rad/s]."""

    @property
    def state(self) -> Floats:
        """As telemetry reports it, shape (count, 12)."""

    def true_state(self) -> Floats:
        """As it really is, shape (count, 12).

        Raises:
            EnvOptionError: nobody knows, of a vehicle in another process.
        """

    def judged_state(self) -> Floats:
        """What tasks judge by, shape (count, 12): as it really is; where nobody knows, as telemetry reports it."""


@runtime_checkable
class ReportingRobot(Protocol):
    """A robot that tells more when it is asked to: a vehicle with an autopilot."""

    reports: Floats
    """What ``REPORTS`` says and whether it has landed (``mavlink.reports``), shape (count, 10); zeros where it was not
    asked for."""

    def ask_for(self, message: str) -> None:
        """Let it send a message of MAVLink with each step; before the first reset.

        Raises:
            EnvOptionError: the robot does not have what the message reports.
        """

    def true_reports(self) -> Floats:
        """What it would measure without errors, shape (count, 9): see ``robots.truth.write_true_reports``.

        Raises:
            EnvOptionError: nobody knows, of a vehicle in another process.
        """


@runtime_checkable
class LandingRobot(ReportingRobot, Protocol):
    """A robot that knows when it stands on the ground: a vehicle with an autopilot that flies."""

    def has_landed(self) -> npt.NDArray[np.bool_]:
        """Whether its autopilot says so, shape (count,).

        False until it is asked for EXTENDED_SYS_STATE (``ask_for``).
        """

    def let_down(self, height: float) -> bool:
        """Whether it is a vehicle that runs elsewhere, whose true height nobody knows; before the first ``reset``.

        Such a one is put down level by its autopilot, instead of flown by the agent, as soon as it believes that it is
        lower than ``height`` above the floor [m].
        """


def reads_scan(piece: Any) -> bool:
    """Whether an observation, a part of one, a task or a reward term needs lidar readings: its attribute
    ``reads_scan``; one that does not say may. Where none does, a vehicle at a connection need not send any."""
    return bool(getattr(piece, "reads_scan", True))


def arrays_stay(robot: Any) -> bool:
    """Whether a robot's ``state``, ``scan``, ``reports``, ``time`` and ``collided``, and what ``true_state`` and
    ``true_reports`` return, are the same arrays in one piece each time: its attribute ``arrays_stay``."""
    return bool(getattr(robot, "arrays_stay", False))
