# SPDX-License-Identifier: BSD-3-Clause
"""The rover's modes: to add one is a file and a line here.

Numbers: ArduRover's custom modes (https://ardupilot.org/rover/docs/rover-control-modes.html, ROVER_MODE of MAVLink).
"""

from __future__ import annotations

from ....core.dispatch import by_number
from ....core.kernels import law
from ...modes import numbers, with_registered
from . import (
    acro,
    auto,
    circle,
    dock,
    follow,
    guided,
    hold,
    initialising,
    loiter,
    manual,
    rtl,
    simple,
    smart_rtl,
    steering,
)
from .mode import RoverMode

MODES: tuple[RoverMode, ...] = with_registered(
    "rover",
    (
        manual.MODE,
        acro.MODE,
        steering.MODE,
        hold.MODE,
        loiter.MODE,
        simple.MODE,
        circle.MODE,
        auto.MODE,
        rtl.MODE,
        smart_rtl.MODE,
        follow.MODE,
        dock.MODE,
        guided.MODE,
        initialising.MODE,
    ),
)
"""In the order of AVAILABLE_MODES."""
NAMES = {mode.number: mode.name for mode in MODES}
_SHORT = {"STEERING": "STER", "SMART_RTL": "SRTL", "SIMPLE": "SMPL"}
SHORT_NAMES = {mode.number: _SHORT.get(mode.name, mode.name[:4]) for mode in MODES}
"""As some texts say them."""

run = by_number("run", {mode.number: mode.run for mode in MODES}, initialising.MODE.run)
start = by_number("start", {mode.number: mode.start for mode in MODES}, initialising.MODE.start)
destination = by_number("destination", {mode.number: mode.destination for mode in MODES}, initialising.MODE.destination)
CHANGE_SPEED = {mode.number: mode.change_speed for mode in MODES}

ALL = tuple(NAMES)
AUTONOMOUS = numbers(MODES, "autonomous")
NEED_POSITION = numbers(MODES, "needs_position")
NEED_VELOCITY = numbers(MODES, "needs_velocity")
CAR_NEEDS_VELOCITY = numbers(MODES, "car_needs_velocity")
ARMABLE = numbers(MODES, "armable")
_IN_ORDER = (manual, acro, steering, loiter, follow, simple, circle, auto, rtl, smart_rtl, guided, dock)
GCS_BLOCK = tuple(mode.MODE.number for mode in _IN_ORDER)
"""Modes in the order of the bits of FLTMODE_GCSBLOCK."""


@law
def is_known(number: int) -> bool:
    """Whether the firmware has this mode."""
    return number in ALL


@law
def is_autonomous(number: int) -> bool:
    """Whether the mode drives without the pilot's sticks."""
    return number in AUTONOMOUS


@law
def requires_position(number: int) -> bool:
    """Whether the mode needs a position."""
    return number in NEED_POSITION


@law
def requires_velocity(number: int, skid: bool) -> bool:
    """Whether the mode needs a speed (or a position); ``skid``: of a skid-steered vehicle."""
    return requires_position(number) or number in NEED_VELOCITY or (number in CAR_NEEDS_VELOCITY and not skid)


@law
def allows_arming(number: int) -> bool:
    """Whether the vehicle may be armed in this mode."""
    return number in ARMABLE


@law
def allows_arming_by_stick(number: int) -> bool:
    """Whether the steering stick arms and disarms in this mode."""
    return not is_autonomous(number)
