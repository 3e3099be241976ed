# SPDX-License-Identifier: BSD-3-Clause
"""What a mode of the rover is, and what most of them answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...modes import Mode
from ..state import Vehicle


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
    destination: str = ""
    """Field of ``modes`` with the place that it drives to, for telemetry; "" none."""
    change_speed: Callable[[Vehicle, float], bool] = refuses_speed
    """DO_CHANGE_SPEED [m/s] until the mode changes, from the shell: whether it is taken."""
