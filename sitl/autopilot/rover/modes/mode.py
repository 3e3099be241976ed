# SPDX-License-Identifier: BSD-3-Clause
"""What a mode of the rover is, and what most of them answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from ....core.algebra import horizontal
from ....core.kernels import law
from ....core.vectors import Vec2
from ...modes import Mode
from ..state import Vehicle
from .state import Modes

NO_DESTINATION, END_OF_PATH, POSITION_TO_HOLD, POSITION_ON_CIRCLE = 0, 1, 2, 3
"""Kinds of destination."""


class Destination(NamedTuple):
    """Where a mode drives to."""

    kind: int
    position: Vec2  # NE [m]


@law
def no_destination(modes: Modes) -> Destination:
    """Of a mode that drives to no position."""
    return Destination(NO_DESTINATION, Vec2(0.0, 0.0))


@law
def end_of_path(modes: Modes) -> Destination:
    """Of a mode that drives along planned legs."""
    return Destination(END_OF_PATH, horizontal(modes.nav.target))


def refuses_speed(v: Vehicle, wanted: float) -> bool:
    """DO_CHANGE_SPEED in a mode whose speed is not set so."""
    return False


@dataclass(frozen=True, kw_only=True)
class RoverMode(Mode[Vehicle]):
    """A driving mode."""

    needs_velocity: bool = False
    """Cannot be entered in motion without a speed, or a position."""
    car_needs_velocity: bool = False
    """The same, but a skid-steered vehicle does without."""
    manual_input: bool = False
    """The pilot's sticks drive."""
    controlled: bool = True
    """Steering is a controller's, not the pilot's."""
    armable: bool = True
    """The vehicle may be armed in it."""
    destination: Callable[[Modes], Destination] = no_destination
    """Law: where it drives to, for telemetry."""
    change_speed: Callable[[Vehicle, float], bool] = refuses_speed
    """DO_CHANGE_SPEED [m/s] until the mode changes, from the shell: whether it is taken."""
