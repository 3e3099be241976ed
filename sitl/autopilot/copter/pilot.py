# SPDX-License-Identifier: BSD-3-Clause
"""The pilot's sticks: pulses of the receiver and of the ground station to what the flight modes understand.

Sources: ArduPilot's parameters RCn_*, RCMAP_*, RC_OVERRIDE_TIME, PILOT_*, THR_DZ; RC_CHANNELS_OVERRIDE and
MANUAL_CONTROL write ``rc.override``.
"""

from __future__ import annotations

import math

from ..core.kernels import law
from ..core.rotations import constrain

RC_TICKS = 8
"""Ticks between two frames of the receiver: 50 Hz."""
_FRAME_S = RC_TICKS * 0.0025

RECEIVER_PULSES = (1500, 1500, 1000, 1500, 1800, 1000, 1000, 1800)
"""What the simulated transmitter sends: sticks centred, throttle low, mode switch at position 6."""

THROTTLE_ZERO_US = 400_000
"""The throttle counts as zero when it was low for so long."""


@law
def init(v):
    """A receiver is fitted; channels are not known yet."""
    pilot = v.autopilot.modes.pilot
    pilot.has_receiver = 1
    pilot.throttle_zero = 1
    pilot.throttle_zero_us = -THROTTLE_ZERO_US
    pilot.switch_position = -1
    pilot.switch_candidate = -1


@law
def calibration(p, channel):
    """(min, trim, max [us], reversed, dead zone [us]) of channel 1 .. 8."""
    if channel == 1:
        return (p.RC1_MIN, p.RC1_TRIM, p.RC1_MAX, p.RC1_REVERSED, p.RC1_DZ)
    if channel == 2:
        return (p.RC2_MIN, p.RC2_TRIM, p.RC2_MAX, p.RC2_REVERSED, p.RC2_DZ)
    if channel == 3:
        return (p.RC3_MIN, p.RC3_TRIM, p.RC3_MAX, p.RC3_REVERSED, p.RC3_DZ)
    if channel == 4:
        return (p.RC4_MIN, p.RC4_TRIM, p.RC4_MAX, p.RC4_REVERSED, p.RC4_DZ)
    if channel == 5:
        return (p.RC5_MIN, p.RC5_TRIM, p.RC5_MAX, p.RC5_REVERSED, p.RC5_DZ)
    if channel == 6:
        return (p.RC6_MIN, p.RC6_TRIM, p.RC6_MAX, p.RC6_REVERSED, p.RC6_DZ)
    if channel == 7:
        return (p.RC7_MIN, p.RC7_TRIM, p.RC7_MAX, p.RC7_REVERSED, p.RC7_DZ)
    return (p.RC8_MIN, p.RC8_TRIM, p.RC8_MAX, p.RC8_REVERSED, p.RC8_DZ)


@law
def centred(pulse, low, trim, high, reverse, dead):
    """-1 .. 1 of a stick that springs to the middle; 0 inside the dead zone around ``trim``."""
    value = 0.0
    if pulse > trim + dead and high > trim + dead:
        value = (pulse - trim - dead) / (high - trim - dead)
    elif pulse < trim - dead and trim - dead > low:
        value = (pulse - trim + dead) / (trim - dead - low)
    if reverse > 0.5:
        value = -value
    return constrain(value, -1.0, 1.0)


@law
def ranged(pulse, low, high, reverse, dead):
    """0 .. 1 of a throttle stick; 0 up to ``dead`` above ``low``."""
    p = constrain(float(pulse), low, high)
    if reverse > 0.5:
        p = high - (p - low)
    if p > low + dead and high > low + dead:
        return (p - low - dead) / (high - low - dead)
    return 0.0


@law
def stick_channel(p, axis):
    """Channel 1 .. 8 of roll (0), pitch (1), throttle (2), yaw (3)."""
    if axis == 0:
        channel = int(p.RCMAP_ROLL)
    elif axis == 1:
        channel = int(p.RCMAP_PITCH)
    elif axis == 2:
        channel = int(p.RCMAP_THROTTLE)
    else:
        channel = int(p.RCMAP_YAW)
    if channel < 1 or channel > 8:
        channel = axis + 1
    return channel


@law
def centred_channel(ap, axis):
    """-1 .. 1 of a stick."""
    channel = stick_channel(ap.params, axis)
    pulse = int(ap.rc.channels[channel - 1])
    if pulse == 0:
        return 0.0
    low, trim, high, reverse, dead = calibration(ap.params, channel)
    return centred(pulse, low, trim, high, reverse, dead)


@law
def override_valid(v, k):
    """Whether the ground station's pulse for channel ``k`` (from 0) is there and fresh."""
    rc = v.autopilot.rc
    if rc.override[k] == 0:
        return False
    limit = v.autopilot.params.RC_OVERRIDE_TIME
    if limit < 0.0:
        return True
    return limit > 0.0 and v.time_us - rc.override_us[k] < limit * 1e6


@law
def receive(v):
    """One frame: effective channels, then the sticks. Called at 50 Hz."""
    ap = v.autopilot
    rc = ap.rc
    pilot = ap.modes.pilot
    overridden = False
    for k in range(18):
        if override_valid(v, k):
            rc.channels[k] = int(rc.override[k])
            overridden = True
        elif pilot.has_receiver != 0:
            rc.channels[k] = RECEIVER_PULSES[k] if k < 8 else 0
    if overridden or pilot.has_receiver != 0:
        ap.modes.failsafe.receiver_us = v.time_us
    fresh = v.time_us - ap.modes.failsafe.receiver_us < ap.params.RC_FS_TIMEOUT * 1e6
    rc.receiver_ok = 1 if fresh and int(rc.channels[stick_channel(ap.params, 2) - 1]) > 0 else 0
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
        pilot.roll = centred_channel(ap, 0)
        pilot.pitch = centred_channel(ap, 1)
        pilot.yaw = centred_channel(ap, 3)
        channel = stick_channel(ap.params, 2)
        low, _trim, high, reverse, dead = calibration(ap.params, channel)
        pilot.throttle = ranged(int(ap.rc.channels[channel - 1]), low, high, reverse, dead)
    if pilot.throttle > 0.0:
        pilot.throttle_zero_us = v.time_us
        pilot.throttle_zero = 0
    elif v.time_us - pilot.throttle_zero_us >= THROTTLE_ZERO_US:
        pilot.throttle_zero = 1
    cutoff = ap.params.PILOT_THR_FILT
    gain = 1.0
    if cutoff > 0.0:
        gain = _FRAME_S / (_FRAME_S + 1.0 / (2.0 * math.pi * cutoff))
    pilot.throttle_filtered += gain * (pilot.throttle - pilot.throttle_filtered)
    tc = ap.params.PILOT_Y_RATE_TC
    gain = 1.0 if tc <= 0.0 else _FRAME_S / (_FRAME_S + tc)
    wanted = math.radians(ap.params.PILOT_Y_RATE) * expo(float(pilot.yaw), ap.params.PILOT_Y_EXPO)
    pilot.yaw_rate += gain * (wanted - pilot.yaw_rate)


@law
def expo(x, softness):
    """Stick -1 .. 1 with a middle softened by a hyperbola that still reaches 1 at full stick."""
    k = constrain(softness, -0.5, 0.95)
    if k == 0.0:
        return x
    return (1.0 - k) * x / (1.0 - k * abs(x))


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
    up = ap.params.PILOT_SPEED_UP * 0.01
    down = ap.params.PILOT_SPEED_DN * 0.01
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
