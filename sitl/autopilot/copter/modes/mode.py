# SPDX-License-Identifier: BSD-3-Clause
"""What a mode of the copter is, and what most of them answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ....core.kernels import law
from ...modes import Mode
from ..parameters import Parameters
from ..state import Vehicle
from .state import Modes


@law
def always_arms(p: Parameters, method: int) -> bool:
    """Whether the mode may be armed by ``method``: yes."""
    return True


@law
def never_arms(p: Parameters, method: int) -> bool:
    """Whether the mode may be armed by ``method``: no."""
    return False


@law
def no(modes: Modes) -> bool:
    """The answer of a mode that neither lands nor takes off."""
    return False


@law
def yes(modes: Modes) -> bool:
    """The answer of a mode that does nothing else."""
    return True


@dataclass(frozen=True, kw_only=True)
class CopterMode(Mode[Vehicle]):
    """A flight mode."""

    manual_throttle: bool = False
    """The throttle stick drives the motors directly; every other mode needs a height."""
    climb_stick: bool = False
    """The throttle stick is a climb rate: it takes off, and lands when it is closed."""
    arms_at_any_throttle: bool = False
    """A ground station may arm it whatever the throttle stick says."""
    idles_armed: bool = False
    """Left alone on the ground it stays armed (no DISARM_DELAY)."""
    ignores_simple: bool = False
    """SIMPLE and SUPER_SIMPLE do not turn the sticks."""
    may_arm: Callable[[Parameters, int], bool] = always_arms
    """Law: whether it may be armed by a method (BY_*)."""
    is_landing: Callable[[Modes], bool] = no
    """Law: whether it is on its way to the ground."""
    is_taking_off: Callable[[Modes], bool] = no
    """Law: whether it raises the throttle from the ground by itself, and will say when it flies."""
