# SPDX-License-Identifier: BSD-3-Clause
"""GUIDED: drives what the set-points say (``guided`` takes them); a set-point too old stops the vehicle.

Positions are good until the next set-point.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ...events import GUIDED_REACHED, GUIDED_TIMEOUT, emit
from ..control import motors, speed
from ..navigation import waypoint
from . import drive
from .guided_state import HEADING_AND_SPEED, POSITION, STEERING_AND_THROTTLE, STOP, TURN_RATE_AND_SPEED
from .numbers import ACCEPTED

TIMEOUT_US = 3_000_000
"""Velocity, heading, turn-rate and throttle set-points are good for so long (ArduRover's)."""


@law
def start(v):
    """Enter: stops until a set-point comes."""
    guided = v.autopilot.modes.guided
    waypoint.start(v.autopilot)
    guided.submode = STOP
    guided.has_target = 0
    guided.reached_told = 1
    return ACCEPTED


@law
def check_age(v):
    """Drop a set-point that is too old, and say so once."""
    guided = v.autopilot.modes.guided
    if guided.has_target != 0 and v.time_us - guided.update_us > TIMEOUT_US:
        guided.has_target = 0
        emit(v.autopilot.events, v.time_us, GUIDED_TIMEOUT, TIMEOUT_US * 1e-6, 0.0)


@law
def run_position(v):
    """One period of a position target."""
    ap = v.autopilot
    if not waypoint.reached(ap):
        drive.along_path(v)
        return
    if ap.modes.guided.reached_told == 0:
        ap.modes.guided.reached_told = 1
        emit(ap.events, v.time_us, GUIDED_REACHED, 0.0, 0.0)
    speed.stop(v)


@law
def run(v):
    """One period."""
    ap = v.autopilot
    guided = ap.modes.guided
    kind = guided.submode
    if kind == POSITION:
        run_position(v)
        return
    check_age(v)
    if kind == STOP or guided.has_target == 0:
        speed.stop(v)
    elif kind == STEERING_AND_THROTTLE:
        motors.set_steering_unscaled(ap, float(guided.steering))
        motors.set_throttle(ap, float(guided.throttle))
    else:
        if kind == TURN_RATE_AND_SPEED:
            drive.turn(v, float(guided.turn_rate))
        elif kind == HEADING_AND_SPEED:
            drive.to_heading(v, float(guided.heading))
        speed.drive(v, drive.nudged(ap, float(guided.speed)))


@law
def is_at_limit(v):
    """Guided within a mission: whether its time is over or it has gone too far (DO_GUIDED_LIMITS)."""
    ap = v.autopilot
    guided = ap.modes.guided
    if guided.limit_us > 0 and v.time_us - guided.limit_since_us >= guided.limit_us:
        return True
    north = float(ap.estimate.pos[0]) - float(guided.limit_from[0])
    east = float(ap.estimate.pos[1]) - float(guided.limit_from[1])
    return guided.limit_distance > 0.0 and math.sqrt(north * north + east * east) > guided.limit_distance


@law
def begin_limits(v):
    """Guided within a mission begins here and now."""
    ap = v.autopilot
    ap.modes.guided.limit_since_us = v.time_us
    ap.modes.guided.limit_from[0] = ap.estimate.pos[0]
    ap.modes.guided.limit_from[1] = ap.estimate.pos[1]
