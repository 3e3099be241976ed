# SPDX-License-Identifier: BSD-3-Clause
"""The copter's auxiliary functions."""

from __future__ import annotations

import math

from ...core.mavlink import MavCmd, MavFrame, MavSeverity
from .. import aux_functions as shared
from .. import payload
from ..aux_functions import AuxFunction, Holder
from ..aux_switch import HIGH, LOW, MIDDLE, MOTOR_INTERLOCK
from ..command_results import CommandResult
from ..mission.item import MissionItem
from ..mission.notes import Note
from ..notes import Text
from . import arming
from .modes import autotune_gains, mode_commands, simple, zigzag
from .modes.auto import AUTO
from .modes.mode_list import NAMES
from .modes.set_mode import request

TRIMMED_IN = (0, 2)
"""Modes, STABILIZE and ALT_HOLD."""
STICK_LEAN, MOST_TRIM = math.radians(45.0), math.radians(10.0)
"""What a full stick adds to AHRS_TRIM, and its limit [rad]."""
TAKEOFF_LEAST = 1.0
"""Height of a take-off that is saved, at least [m]."""

_MODES = {2: 14, 4: 6, 16: 3, 17: 15, 18: 9, 33: 17, 37: 18, 42: 21, 52: 1, 55: 4, 56: 5, 57: 23, 60: 24, 68: 0, 69: 16,
          70: 2, 71: 22, 72: 7, 73: 11, 99: 27, 151: 28}  # fmt: skip
"""Function -> mode, as far as the firmware has the mode."""


def _save_waypoint(holder: Holder, position: int) -> list[Note]:
    """The first one is preceded by a take-off; with the throttle closed it is a landing."""
    ap = holder.v.autopilot
    if position != HIGH or ap.modes.number == AUTO or not ap.arming.armed:
        return []
    item = shared.item_here(holder)
    items: list[MissionItem] = []
    if not holder.sequencer.mission.present:
        items.append(MissionItem(MavCmd.NAV_TAKEOFF, MavFrame.GLOBAL_RELATIVE_ALT, z=max(item.z, TAKEOFF_LEAST)))
    if ap.modes.pilot.throttle <= 0.0:
        item = item._replace(command=MavCmd.NAV_LAND)
    shared.append_items(holder, [*items, item])
    return []


def _interlock(holder: Holder, position: int) -> list[Note]:
    holder.v.autopilot.arming.interlock_on = position != LOW
    return []


def _simple(holder: Holder, position: int) -> list[Note]:
    simple.choose(holder.v, simple.OFF if position == LOW else simple.SIMPLE)
    return []


def _super_simple(holder: Holder, position: int) -> list[Note]:
    simple.choose(holder.v, position - LOW)
    return []


def _zigzag(holder: Holder, position: int) -> list[Note]:
    v = holder.v
    if v.autopilot.modes.number == zigzag.ZIGZAG:
        if position == MIDDLE:
            zigzag.give_back(v)
        else:
            zigzag.choose(v, zigzag.A if position == LOW else zigzag.B)
    return []


def _sweep(holder: Holder, position: int) -> list[Note]:
    v = holder.v
    if v.autopilot.modes.number == zigzag.ZIGZAG:
        if position == HIGH:
            zigzag.sweep(v)
        else:
            zigzag.suspend(v)
    return []


def _try_gains(holder: Holder, position: int) -> list[Note]:
    if position != MIDDLE:
        autotune_gains.try_gains(holder.v, position == HIGH)
    return []


def _reset_heading(holder: Holder, position: int) -> list[Note]:
    if position != HIGH:
        return []
    ap = holder.v.autopilot
    simple.begin(ap.modes.simple, ap.estimate.yaw)
    return [Text(MavSeverity.INFO, "Simple heading reset")]


def _train(holder: Holder, position: int) -> list[Note]:
    holder.v.autopilot.params.ACRO.TRAINER = float(position - LOW)
    return []


def _feed_forward(holder: Holder, position: int) -> list[Note]:
    holder.v.autopilot.params.ATC.RATE_FF_ENAB = float(position == HIGH)
    return []


WITHOUT_EFFECT = {
    10: "Rangefinder", 25: "", 29: "", 75: "SurfaceTracking", 76: "", 84: "AirMode", 109: "", 112: "", 159: "",
    160: "Weathervane", 182: "",
}  # fmt: skip
"""As in all firmwares."""


def _hold_over_target(holder: Holder, position: int) -> list[Note]:
    if position != MIDDLE:
        holder.v.autopilot.modes.loiter.seeks_target = position == HIGH
    return []


def _pause(holder: Holder, position: int) -> list[Note]:
    if position == MIDDLE:
        return []
    done = mode_commands.set_paused(holder.v.autopilot.modes, position == HIGH) == CommandResult.OK
    return [Text(MavSeverity.WARNING, "Flight Mode Pause failed")] if position == HIGH and not done else []


def _save_trim(holder: Holder, position: int) -> list[Note]:
    ap = holder.v.autopilot
    pilot, trim = ap.modes.pilot, ap.params.AHRS.TRIM
    if position != HIGH or ap.modes.number not in TRIMMED_IN or pilot.throttle > 0.0:
        return []
    trim.X = min(max(trim.X + STICK_LEAN * pilot.roll, -MOST_TRIM), MOST_TRIM)
    trim.Y = min(max(trim.Y + STICK_LEAN * pilot.pitch, -MOST_TRIM), MOST_TRIM)
    return [Text(MavSeverity.INFO, "Trim saved")]


FUNCTIONS = shared.by_number(
    (
        *shared.COMMON,
        *(shared.change_mode(number, NAMES[mode], mode, request) for number, mode in _MODES.items() if mode in NAMES),
        AuxFunction(3, _simple, "high or middle: SIMPLE; low: off"),
        AuxFunction(7, _save_waypoint, "high, armed, not in AUTO: adds the position to the mission", "SaveWaypoint"),
        AuxFunction(13, _super_simple, "high: SUPER_SIMPLE; middle: SIMPLE; low: off"),
        AuxFunction(MOTOR_INTERLOCK, _interlock, "low: motors stand; else they may turn", "MotorInterlock"),
        shared.fitted(payload.SWITCH_WINCH, "high: the winch holds its line; else it lets go", "WinchEnable"),
        shared.fitted(
            payload.SWITCH_WINDING, "high: the winch lowers; low: it raises; middle: it stops", "WinchControl"
        ),
        *shared.without_effect(WITHOUT_EFFECT),
        AuxFunction(26, _feed_forward, "high: ATC_RATE_FF_ENAB 1; else 0"),
        AuxFunction(
            39, _hold_over_target, "high: LOITER holds over a landing target (PLND_*); low: not", "PrecisionLoiter"
        ),
        shared.fitted(payload.SWITCH_PARACHUTE_ENABLE, "high: the parachute is enabled; else not", "ParachuteEnable"),
        shared.fitted(payload.SWITCH_PARACHUTE_RELEASE, "high: releases the parachute", "ParachuteRelease"),
        shared.fitted(
            payload.SWITCH_PARACHUTE,
            "the parachute: low not enabled, middle enabled, high released",
            "Parachute3Position",
        ),
        AuxFunction(61, _zigzag, "in ZIGZAG: low stores or flies to A, high B, middle gives back to the sticks"),
        AuxFunction(
            83, _sweep, "in ZIGZAG, with ZIGZ_AUTO_ENABLE: high begins a sweep or goes on with it; else pauses it"
        ),
        AuxFunction(152, _reset_heading, "high: the heading now is forwards in SIMPLE"),
        AuxFunction(180, _try_gains, "high: flies with the gains that AUTOTUNE found; low: with those from before"),
        shared.arm_or_disarm(153, arming),
        shared.arm_or_disarm(154, arming),
        shared.disarm(arming),
        shared.arm_or_stop(arming),
        AuxFunction(
            5, _save_trim, "high, throttle closed, in STABILIZE or ALT_HOLD: the sticks' lean goes into AHRS_TRIM"
        ),
        AuxFunction(14, _train, "ACRO_TRAINER: low 0, middle 1, high 2"),
        AuxFunction(178, _pause, "high: pauses GUIDED or AUTO; low: goes on"),
    )
)
