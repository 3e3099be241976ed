# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks, as the copter's flight modes understand them (PILOT_*, THR_DZ)."""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.scalars import constrain
from ..radio import (
    FRAME_S,
    PITCH,
    RECEIVER_PULSES,
    ROLL,
    THROTTLE,
    YAW,
    expo,
    ranged,
    receive,
    stick_channel,
    stick_position,
)

THROTTLE_ZERO_US = 400_000
"""The throttle counts as zero when it was low for so long."""
_THROTTLE_LOW = RECEIVER_PULSES[2]


@law
def init(v):
    """A receiver is fitted; channels are not known yet."""
    v.autopilot.rc.has_receiver = 1
    pilot = v.autopilot.modes.pilot
    pilot.throttle_zero = 1
    pilot.throttle_zero_us = -THROTTLE_ZERO_US
    pilot.switch_position = -1
    pilot.switch_candidate = -1


@law
def read(v):
    """One frame: effective channels, then the sticks. Called at 50 Hz."""
    ap = v.autopilot
    receive(ap.rc, v.sensors, ap.params, v.time_us, _THROTTLE_LOW, ap.params.RC_FS_TIMEOUT)
    read_sticks(v)


@law
def read_sticks(v):
    """Sticks from effective channels; the radio failsafe centres them and closes the throttle."""
    ap = v.autopilot
    pilot = ap.modes.pilot
    if ap.modes.failsafe.radio != 0 or ap.rc.receiver_ok == 0:
        pilot.roll = 0.0
        pilot.pitch = 0.0
        pilot.yaw = 0.0
        pilot.throttle = 0.0
    else:
        pilot.roll = stick_position(ap.rc, ap.params, ROLL)
        pilot.pitch = stick_position(ap.rc, ap.params, PITCH)
        pilot.yaw = stick_position(ap.rc, ap.params, YAW)
        channel = stick_channel(ap.params.RCMAP, THROTTLE)
        pilot.throttle = ranged(ap.rc.channels[channel], ap.params.RC[channel])
    if pilot.throttle > 0.0:
        pilot.throttle_zero_us = v.time_us
        pilot.throttle_zero = 0
    elif v.time_us - pilot.throttle_zero_us >= THROTTLE_ZERO_US:
        pilot.throttle_zero = 1
    cutoff = ap.params.PILOT.THR_FILT
    gain = 1.0
    if cutoff > 0.0:
        gain = FRAME_S / (FRAME_S + 1.0 / (2.0 * math.pi * cutoff))
    pilot.throttle_filtered += gain * (pilot.throttle - pilot.throttle_filtered)
    tc = ap.params.PILOT.Y_RATE_TC
    gain = 1.0 if tc <= 0.0 else FRAME_S / (FRAME_S + tc)
    wanted = math.radians(ap.params.PILOT.Y_RATE) * expo(float(pilot.yaw), ap.params.PILOT.Y_EXPO)
    pilot.yaw_rate += gain * (wanted - pilot.yaw_rate)


@law
def lean_angles(ap, angle_max, limit):
    """(roll, pitch) [rad] asked by the sticks; ``angle_max`` at full stick, tilt at most ``limit`` [rad].

    Sticks are horizontal thrusts (tangents), so that the tilt of a diagonal stick is limited as a vector.
    """
    pilot = ap.modes.pilot
    forward = -math.tan(angle_max * pilot.pitch)
    right = math.tan(angle_max * pilot.roll)
    size = math.sqrt(forward * forward + right * right)
    most = math.tan(min(limit, angle_max))
    if size > most and size > 0.0:
        forward *= most / size
        right *= most / size
    pitch = -math.atan(forward)
    return (math.atan(math.cos(pitch) * right), pitch)


@law
def climb_rate(ap):
    """Climb rate of the throttle stick [m/s], up positive; 0 within THR_DZ of the middle."""
    if ap.modes.failsafe.radio != 0 or ap.rc.receiver_ok == 0:
        return 0.0
    dead = constrain(ap.params.THR_DZ * 0.001, 0.0, 0.4)
    throttle = float(ap.modes.pilot.throttle)
    top = 0.5 + dead
    bottom = 0.5 - dead
    up = ap.params.PILOT.SPEED_UP * 0.01
    down = ap.params.PILOT.SPEED_DN * 0.01
    if down <= 0.0:
        down = up
    if throttle < bottom:
        return down * (throttle - bottom) / bottom
    if throttle > top:
        return up * (throttle - top) / (1.0 - top)
    return 0.0


@law
def throttle_out(throttle, hover):
    """Motor throttle 0 .. 1 of the stick in STABILIZE: a cubic through 0, 1 and ``hover`` near the middle.

    Source: ArduPilot's manual throttle curve, out = x (1 - e) + e x^3 with e from MOT_THST_HOVER.
    """
    e = constrain(-(hover - 0.5) / 0.375, -0.5, 1.0)
    return throttle * (1.0 - e) + e * throttle * throttle * throttle
