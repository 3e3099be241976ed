# SPDX-License-Identifier: BSD-3-Clause
"""The copter's flight modes: to add one is a file and a line here.

Numbers: ArduCopter's custom modes (https://ardupilot.org/copter/docs/flight-modes.html, COPTER_MODE of MAVLink).
"""

from __future__ import annotations

from ....core.dispatch import by_number
from ....core.kernels import law
from ...modes import numbers, with_registered
from . import (
    acro,
    alt_hold,
    auto,
    auto_rtl,
    autotune,
    avoid_adsb,
    brake,
    circle,
    drift,
    flip,
    flowhold,
    follow,
    guided,
    guided_nogps,
    land,
    loiter,
    poshold,
    rtl,
    smart_rtl,
    stabilize,
    systemid,
    throw,
    turtle,
    zigzag,
)
from .mode import CopterMode

MODES: tuple[CopterMode, ...] = with_registered(
    "copter",
    (
        stabilize.MODE,
        acro.MODE,
        alt_hold.MODE,
        auto.MODE,
        guided.MODE,
        loiter.MODE,
        rtl.MODE,
        circle.MODE,
        land.MODE,
        drift.MODE,
        flip.MODE,
        poshold.MODE,
        brake.MODE,
        throw.MODE,
        avoid_adsb.MODE,
        guided_nogps.MODE,
        smart_rtl.MODE,
        follow.MODE,
        zigzag.MODE,
        systemid.MODE,
        flowhold.MODE,
        turtle.MODE,
        auto_rtl.MODE,
        autotune.MODE,
    ),
)
"""In the order of AVAILABLE_MODES."""
NAMES = {mode.number: mode.name for mode in MODES}
TITLES = {mode.number: mode.title or mode.name for mode in MODES}
"""As texts say them."""

run = by_number("run", {mode.number: mode.run for mode in MODES}, stabilize.MODE.run)
start = by_number("start", {mode.number: mode.start for mode in MODES}, stabilize.MODE.start)
may_arm = by_number("may_arm", {mode.number: mode.may_arm for mode in MODES}, stabilize.MODE.may_arm)
is_landing = by_number("is_landing", {mode.number: mode.is_landing for mode in MODES}, stabilize.MODE.is_landing)
is_taking_off = by_number(
    "is_taking_off", {mode.number: mode.is_taking_off for mode in MODES}, stabilize.MODE.is_taking_off
)

ALL = tuple(NAMES)
MANUAL_THROTTLE = numbers(MODES, "manual_throttle")
CLIMB_STICK = numbers(MODES, "climb_stick")
NEED_POSITION = numbers(MODES, "needs_position")
NEED_PILOT = numbers(MODES, "needs_pilot")
AUTONOMOUS = numbers(MODES, "autonomous")
IDLE_ARMED = numbers(MODES, "idles_armed")
IGNORE_SIMPLE = numbers(MODES, "ignores_simple")
ARM_AT_ANY_THROTTLE = numbers(MODES, "arms_at_any_throttle")
_SPORT, _AUTOROTATE = 13, 26  # modes of other builds, which have bits all the same
GCS_BLOCK = (
    *(mode.MODE.number for mode in (stabilize, acro, alt_hold, auto, guided, loiter, circle, drift)),
    _SPORT,
    *(mode.MODE.number for mode in (flip, autotune, poshold, brake, throw, avoid_adsb, guided_nogps, smart_rtl)),
    *(mode.MODE.number for mode in (flowhold, follow, zigzag, systemid)),
    _AUTOROTATE,
    *(mode.MODE.number for mode in (auto_rtl, turtle)),
)
"""Modes in the order of the bits of FLTMODE_GCSBLOCK."""


@law
def is_known(number: int) -> bool:
    """Whether the firmware has this mode."""
    return number in ALL


@law
def has_manual_throttle(number: int) -> bool:
    """Whether the throttle stick drives the motors directly."""
    return number in MANUAL_THROTTLE


@law
def has_climb_stick(number: int) -> bool:
    """Whether the throttle stick is a climb rate."""
    return number in CLIMB_STICK


@law
def requires_position(number: int) -> bool:
    """Whether the mode needs a horizontal position (LAND does without)."""
    return number in NEED_POSITION


@law
def requires_pilot(number: int) -> bool:
    """Whether the mode cannot be entered in radio failsafe."""
    return number in NEED_PILOT


@law
def is_autonomous(number: int) -> bool:
    """Whether the mode flies without the pilot's sticks."""
    return number in AUTONOMOUS


@law
def arms_at_any_throttle(number: int) -> bool:
    """Whether a ground station may arm the mode whatever the throttle stick says."""
    return number in ARM_AT_ANY_THROTTLE


@law
def idles_armed(number: int) -> bool:
    """Whether the vehicle stays armed on the ground."""
    return number in IDLE_ARMED


@law
def ignores_simple(number: int) -> bool:
    """Whether SIMPLE and SUPER_SIMPLE do nothing in the mode."""
    return number in IGNORE_SIMPLE
