# SPDX-License-Identifier: BSD-3-Clause
"""Commands of MAVLink to the mode under way (shell): take off, turn, look at, fly slower, pause.

Each function returns OK, or says why it left the record as it was.
"""

from __future__ import annotations

from math import trunc

from ....core.kernels import law
from ....core.vectors import Vec3
from ...command_results import CommandResult
from ..control import altitude_start, position_start
from ..control.state import Control
from ..parameters import Parameters
from ..state import Autopilot
from . import auto, auto_yaw, guided, takeoff
from .auto import AUTO
from .auto_yaw import Turn
from .guided import GUIDED, GUIDED_NOGPS
from .mode_list import has_climb_stick
from .rtl import RTL
from .state import Modes

LARGEST = 1e9
"""Metres, metres a second, radians beyond this are refused; what is on the globe is less."""

HORIZONTAL, CLIMB, DESCENT = 0, 1, 2
"""Kinds of speed that change_speed knows."""


@law
def is_usable(x: float) -> bool:
    """Whether a number is neither NaN nor infinite nor absurdly large."""
    return abs(x) <= LARGEST


@law
def is_usable_vector(x: Vec3) -> bool:
    """Whether all of them are usable numbers."""
    return is_usable(x.x) and is_usable(x.y) and is_usable(x.z)


def take_off(ap: Autopilot, height: float) -> int:
    """MAV_CMD_NAV_TAKEOFF to ``height`` [m] above home."""
    mode = ap.modes.number
    if not is_usable(height):
        return CommandResult.NOT_FINITE
    if not ap.arming.armed:
        return CommandResult.NOT_ARMED
    if not ap.arming.landed and not (mode == GUIDED and guided.is_taking_off(ap.modes)):
        return CommandResult.ALREADY_FLYING
    if mode != GUIDED and not has_climb_stick(mode):
        return CommandResult.WRONG_MODE
    target_d = ap.home.pos.z - height
    if height <= trunc(100.0 * (ap.home.pos.z - ap.estimate.pos.z)) / 100.0:  # in centimetres, as ArduPilot has it
        return CommandResult.TOO_LOW
    if not ap.arming.landed:  # repeated in the climb: a client that missed the acknowledgement
        ap.modes.takeoff.target_d = target_d
        return CommandResult.OK
    control, est, p = ap.control, ap.estimate, ap.params
    if mode == GUIDED:
        ap.modes.guided.submode = guided.TAKEOFF
        auto_yaw.set_mode(ap.modes.auto_yaw, auto_yaw.HOLD, control.attitude, est)
        takeoff.begin(ap.modes.takeoff, target_d, True, control, est, p)
    else:
        takeoff.begin_user(ap.modes.takeoff, height, control, est, p)
    ap.arming.auto_armed = True
    return CommandResult.OK


def condition_yaw(ap: Autopilot, turn: Turn) -> int:
    """MAV_CMD_CONDITION_YAW: in modes that turn the nose by themselves, until the next one; nothing in others."""
    if not (is_usable(turn.angle) and is_usable(turn.rate)):
        return CommandResult.NOT_FINITE
    if turn.rate < 0.0:
        return CommandResult.OUT_OF_RANGE
    start = ap.control.attitude.target_euler.yaw
    auto_yaw.turn_to(ap.modes.auto_yaw, turn, start, auto_yaw.slew_max(ap.params.ATC))
    return CommandResult.OK


def set_roi(ap: Autopilot, position: Vec3) -> int:
    """Keep the nose on a point, NED [m]."""
    if not is_usable_vector(position):
        return CommandResult.NOT_FINITE
    auto_yaw.look_at(ap.modes.auto_yaw, position, ap.control.attitude, ap.estimate)
    return CommandResult.OK


def clear_roi(ap: Autopilot) -> int:
    """Give the heading back to WP_YAW_BEHAVIOR."""
    yaw = ap.modes.auto_yaw
    if yaw.mode == auto_yaw.ROI:
        auto_yaw.set_default(yaw, ap.params.WP, ap.modes.number == RTL, ap.control.attitude, ap.estimate)
    return CommandResult.OK


def change_speed(control: Control, p: Parameters, kind: int, speed: float) -> int:
    """MAV_CMD_DO_CHANGE_SPEED: HORIZONTAL, CLIMB or DESCENT speed limit [m/s] until the mode or the
    kind of set-point changes.
    """
    if not is_usable(speed):
        return CommandResult.NOT_FINITE
    if speed <= 0.0:
        return CommandResult.OUT_OF_RANGE
    path = control.pos_d
    if kind == HORIZONTAL:
        position_start.set_max_speed_accel_ne(control.pos_ne, p, speed, control.pos_ne.accel_max)
    elif kind == CLIMB:
        altitude_start.set_max_speed_accel_d(path, p.PSC, path.speed_down, speed, path.accel_max)
    elif kind == DESCENT:
        altitude_start.set_max_speed_accel_d(path, p.PSC, speed, path.speed_up, path.accel_max)
    else:
        return CommandResult.OUT_OF_RANGE
    return CommandResult.OK


def set_paused(modes: Modes, paused: bool) -> int:
    """MAV_CMD_DO_PAUSE_CONTINUE in GUIDED and AUTO: stop and hold, or go on; GUIDED_NOGPS takes it and flies on."""
    if modes.number in (GUIDED, GUIDED_NOGPS):
        modes.guided.paused = paused
    elif modes.number == AUTO and paused and not auto.is_on_a_path(modes.nav):
        return CommandResult.NOT_ON_A_PATH
    elif modes.number == AUTO:
        modes.nav.paused = paused
    else:
        return CommandResult.WRONG_MODE
    return CommandResult.OK
