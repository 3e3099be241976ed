# SPDX-License-Identifier: BSD-3-Clause
"""The radio: pulses of the receiver and of the ground station, and the stick positions that they mean.

Sources: ArduPilot's parameters RCn_*, RCMAP_*, RC_OVERRIDE_TIME; RC_CHANNELS_OVERRIDE and MANUAL_CONTROL write
``rc.override``.
"""

from __future__ import annotations

from ..core.kernels import law
from ..core.scalars import constrain
from .state import RC_INPUTS

RC_TICKS = 8
"""Ticks between two frames of the receiver: 50 Hz."""
FRAME_S = RC_TICKS * 0.0025

RECEIVER_PULSES = (1500, 1500, 1000, 1500, 1800, 1000, 1000, 1800)
"""What the simulated transmitter sends: sticks centred, throttle low, mode switch at position 6."""
_THROTTLE = 2


@law
def calibration(p, channel):
    """(min, trim, max [us], reversed, dead zone [us]) of channel 1 .. 8."""
    if channel == 1:
        return (p.RC[0].MIN, p.RC[0].TRIM, p.RC[0].MAX, p.RC[0].REVERSED, p.RC[0].DZ)
    if channel == 2:
        return (p.RC[1].MIN, p.RC[1].TRIM, p.RC[1].MAX, p.RC[1].REVERSED, p.RC[1].DZ)
    if channel == 3:
        return (p.RC[2].MIN, p.RC[2].TRIM, p.RC[2].MAX, p.RC[2].REVERSED, p.RC[2].DZ)
    if channel == 4:
        return (p.RC[3].MIN, p.RC[3].TRIM, p.RC[3].MAX, p.RC[3].REVERSED, p.RC[3].DZ)
    if channel == 5:
        return (p.RC[4].MIN, p.RC[4].TRIM, p.RC[4].MAX, p.RC[4].REVERSED, p.RC[4].DZ)
    if channel == 6:
        return (p.RC[5].MIN, p.RC[5].TRIM, p.RC[5].MAX, p.RC[5].REVERSED, p.RC[5].DZ)
    if channel == 7:
        return (p.RC[6].MIN, p.RC[6].TRIM, p.RC[6].MAX, p.RC[6].REVERSED, p.RC[6].DZ)
    return (p.RC[7].MIN, p.RC[7].TRIM, p.RC[7].MAX, p.RC[7].REVERSED, p.RC[7].DZ)


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
        channel = int(p.RCMAP.ROLL)
    elif axis == 1:
        channel = int(p.RCMAP.PITCH)
    elif axis == 2:
        channel = int(p.RCMAP.THROTTLE)
    else:
        channel = int(p.RCMAP.YAW)
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
def receive(v, throttle, timeout):
    """One frame of the receiver, fifty times a second: effective channels, and whether the radio is there.

    A receiver of the physics side takes the place of the simulated transmitter, and is lost when its frames stop.

    Args:
        v: the vehicle.
        throttle: pulse [us] of the throttle stick at rest in the simulated transmitter.
        timeout: silence that counts as lost [s].
    """
    rc, s = v.autopilot.rc, v.sensors
    overridden, is_real = False, s.rc_count > 0
    for k in range(18):
        if override_valid(v, k):
            rc.channels[k] = int(rc.override[k])
            overridden = True
        elif rc.has_receiver != 0 and is_real:
            rc.channels[k] = int(s.rc_channels[k]) if k < RC_INPUTS else 0
        elif rc.has_receiver != 0:
            rc.channels[k] = throttle if k == _THROTTLE else RECEIVER_PULSES[k] if k < 8 else 0
    if overridden or (rc.has_receiver != 0 and not is_real):
        rc.receiver_us = v.time_us
    elif rc.has_receiver != 0:
        rc.receiver_us = max(int(rc.receiver_us), int(s.rc_time_us))
    fresh = v.time_us - rc.receiver_us < timeout * 1e6
    rc.receiver_ok = 1 if fresh and int(rc.channels[stick_channel(v.autopilot.params, 2) - 1]) > 0 else 0


@law
def expo(x, softness):
    """Stick -1 .. 1 with a middle softened by a hyperbola that still reaches 1 at full stick."""
    k = constrain(softness, -0.5, 0.95)
    if k == 0.0:
        return x
    return (1.0 - k) * x / (1.0 - k * abs(x))
