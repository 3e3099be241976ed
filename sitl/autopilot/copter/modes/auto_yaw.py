# SPDX-License-Identifier: BSD-3-Clause
"""Where the nose points in modes that fly by themselves.

Sources: ArduPilot's WP_YAW_BEHAVIOR, ATC_SLEW_YAW, MAV_CMD_CONDITION_YAW, MAV_CMD_DO_SET_ROI.
"""

from __future__ import annotations

import math

from ....core.kernels import law
from ....core.scalars import TWO_PI, wrap_pi
from ..control import attitude

HOLD = 0  # heading as it is
LOOK_AT_NEXT_WP = 1  # along the desired velocity
ROI = 2
FIXED = 3  # CONDITION_YAW
LOOK_AHEAD = 4  # along the course flown
RATE = 7  # turn rate from a set-point
ANGLE_RATE = 6  # angle that moves at a rate, from a set-point
PILOT_RATE = 9

_COURSE_SPEED = 1.0  # slower than this the course says nothing [m/s]


@law
def set_mode(v, mode):
    """Change what decides about the heading; keeps the heading under way."""
    yaw = v.autopilot.modes.auto_yaw
    if yaw.mode == mode:
        return
    yaw.mode = mode
    yaw.rate = 0.0
    yaw.yaw = v.autopilot.control.attitude.target_euler[2]
    yaw.look_ahead = v.autopilot.estimate.euler[2]


@law
def set_default(v, rtl):
    """What WP_YAW_BEHAVIOR says; ``rtl``: on the way home."""
    behaviour = int(v.autopilot.params.WP.YAW_BEHAVIOR)
    if behaviour == 0 or (behaviour == 2 and rtl != 0):
        set_mode(v, HOLD)
    elif behaviour == 3:
        set_mode(v, LOOK_AHEAD)
    else:
        set_mode(v, LOOK_AT_NEXT_WP)


@law
def fixed(v, angle, rate, direction, relative):
    """Turn to ``angle`` [rad] at ``rate`` [rad/s] (0: ATC_SLEW_YAW), then hold.

    ``direction``: 1 clockwise, -1 counter-clockwise, 0 the shorter way. An absolute angle is reached in the
    direction asked for, even if that is almost a full circle; a relative one is turned from the heading
    target.
    """
    ap = v.autopilot
    yaw = ap.modes.auto_yaw
    start = float(ap.control.attitude.target_euler[2])
    if relative != 0:
        offset = -angle if direction < 0 else angle
    else:
        offset = wrap_pi(angle - start)
        if direction < 0 and offset > 0.0:
            offset -= TWO_PI
        elif direction > 0 and offset < 0.0:
            offset += TWO_PI
    most = math.radians(ap.params.ATC.SLEW_YAW * 0.01)
    if rate > 0.0 and (rate < most or most <= 0.0):
        most = rate
    yaw.mode = FIXED
    yaw.yaw = start
    yaw.rate = 0.0
    yaw.offset = offset
    yaw.slew = most


@law
def angle_rate(v, angle, rate):
    """Heading ``angle`` [rad] that moves on at ``rate`` [rad/s]."""
    yaw = v.autopilot.modes.auto_yaw
    yaw.mode = ANGLE_RATE
    yaw.yaw = wrap_pi(angle)
    yaw.rate = rate


@law
def turn_rate(v, rate):
    """Turn at ``rate`` [rad/s]."""
    set_mode(v, RATE)
    v.autopilot.modes.auto_yaw.rate = rate


@law
def look_at(v, north, east, down):
    """Keep the nose on a point, NED [m]."""
    yaw = v.autopilot.modes.auto_yaw
    set_mode(v, ROI)
    yaw.roi[0] = north
    yaw.roi[1] = east
    yaw.roi[2] = down


@law
def stop_turning(v):
    """A set-point's turn rate is too old: keep the heading."""
    mode = v.autopilot.modes.auto_yaw.mode
    if mode in (RATE, ANGLE_RATE):
        set_mode(v, HOLD)


@law
def reached(v):
    """Whether CONDITION_YAW is done: all of the angle turned, and the nose within 2 degrees."""
    yaw = v.autopilot.modes.auto_yaw
    if yaw.mode != FIXED:
        return True
    error = wrap_pi(float(v.autopilot.estimate.euler[2]) - yaw.yaw)
    return abs(yaw.offset) < 1e-6 and abs(error) < math.radians(2.0)


@law
def advance(v, dt):
    """Move the heading on by ``dt`` [s]. Returns (heading [rad], rate [rad/s], 1 if the heading counts)."""
    ap = v.autopilot
    yaw = ap.modes.auto_yaw
    if yaw.mode == FIXED:
        step = float(yaw.offset)
        most = yaw.slew * dt if yaw.slew > 0.0 else abs(step)
        if step > most:
            step = most
        elif step < -most:
            step = -most
        yaw.offset -= step
        yaw.yaw = wrap_pi(yaw.yaw + step)
        return (float(yaw.yaw), 0.0, 1)
    if yaw.mode == ROI:
        north = yaw.roi[0] - ap.estimate.pos[0]
        east = yaw.roi[1] - ap.estimate.pos[1]
        if north * north + east * east > 0.01:
            yaw.yaw = math.atan2(east, north)
        return (float(yaw.yaw), 0.0, 1)
    if yaw.mode == LOOK_AHEAD:
        north, east = float(ap.estimate.vel[0]), float(ap.estimate.vel[1])
        if north * north + east * east > _COURSE_SPEED * _COURSE_SPEED:
            yaw.look_ahead = math.atan2(east, north)
        return (float(yaw.look_ahead), 0.0, 1)
    if yaw.mode == LOOK_AT_NEXT_WP:
        north, east = float(ap.control.pos_ne.vel_desired[0]), float(ap.control.pos_ne.vel_desired[1])
        speed2 = north * north + east * east
        least = 0.05 * ap.control.pos_ne.speed_max
        rate = 0.0
        if speed2 > least * least and speed2 > 1e-6:
            yaw.yaw = math.atan2(east, north)
            rate = (north * ap.control.pos_ne.accel_desired[1] - east * ap.control.pos_ne.accel_desired[0]) / speed2
        return (float(yaw.yaw), rate, 1)
    if yaw.mode == ANGLE_RATE:
        yaw.yaw = wrap_pi(yaw.yaw + yaw.rate * dt)
        return (float(yaw.yaw), float(yaw.rate), 1)
    if yaw.mode == RATE or yaw.mode == PILOT_RATE:
        return (0.0, float(yaw.rate), 0)
    return (0.0, 0.0, 0)


@law
def pilot(v):
    """Let the yaw stick take over, and keep the heading when it is released."""
    ap = v.autopilot
    rate = float(ap.modes.pilot.yaw_rate)
    if abs(rate) > 1e-4 and ap.modes.failsafe.radio == 0:
        set_mode(v, PILOT_RATE)
        ap.modes.auto_yaw.rate = rate
    elif ap.modes.auto_yaw.mode == PILOT_RATE:
        set_mode(v, HOLD)


@law
def apply(v, thrust):
    """Send the thrust direction (NED vector) with this mode's heading to the attitude controller."""
    ap = v.autopilot
    heading, rate, absolute = advance(v, 0.0025)
    if absolute != 0:
        attitude.input_thrust_vector_heading(ap, thrust, heading, rate)
    else:
        attitude.input_thrust_vector_heading_rate(ap, thrust, rate)
