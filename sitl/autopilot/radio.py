# SPDX-License-Identifier: BSD-3-Clause
"""The radio: pulses of the receiver and of the ground station, and the stick positions that they mean.

Sources: ArduPilot's parameters RCn_*, RCMAP_*, RC_OVERRIDE_TIME; RC_CHANNELS_OVERRIDE and MANUAL_CONTROL write
``rc.override``.
"""

from __future__ import annotations

from ..core.border import RC_INPUTS, Sensors
from ..core.kernels import law
from ..core.scalars import constrain
from .params.firmware_parameters import Parameters
from .params.radio import RcChannel, RcMap
from .state import Radio

RC_TICKS = 8
"""Ticks between two frames of the receiver: 50 Hz."""
FRAME_S = RC_TICKS * 0.0025

RECEIVER_PULSES = (1500, 1500, 1000, 1500, 1800, 1000, 1000, 1800)
"""What the simulated transmitter sends: sticks centred, throttle low, mode switch at position 6."""
FAILED_THROTTLE = 950
"""Pulse of a receiver that has lost its transmitter and does not fall silent [us]."""
ROLL, PITCH, THROTTLE, YAW = 0, 1, 2, 3
"""Sticks."""


@law
def centred(pulse: int, channel: RcChannel, dead: float) -> float:
    """-1 .. 1 of a stick that springs to the middle; 0 within ``dead`` [us] of its rest."""
    low, trim, high = channel.MIN, channel.TRIM, channel.MAX
    value = 0.0
    if pulse > trim + dead and high > trim + dead:
        value = (pulse - trim - dead) / (high - trim - dead)
    elif pulse < trim - dead and trim - dead > low:
        value = (pulse - trim + dead) / (trim - dead - low)
    if channel.REVERSED > 0.5:
        value = -value
    return constrain(value, -1.0, 1.0)


@law
def ranged(pulse: int, channel: RcChannel) -> float:
    """0 .. 1 of a throttle stick; 0 up to the dead zone above the lowest pulse."""
    low, high, dead = channel.MIN, channel.MAX, channel.DZ
    p = constrain(float(pulse), low, high)
    if channel.REVERSED > 0.5:
        p = high - (p - low)
    if p > low + dead and high > low + dead:
        return (p - low - dead) / (high - low - dead)
    return 0.0


@law
def ranged_middle(channel: RcChannel) -> float:
    """What ``ranged`` gives, 0 .. 1, for a throttle stick in the middle of its channel; below 0.5 by the dead zone."""
    low, high, dead = channel.MIN, channel.MAX, channel.DZ
    middle = (0.5 * (high - low) - dead) / (high - low - dead) if high > low + dead else 0.0
    return middle if middle > 0.0 else 0.5


@law
def stick_channel(params: RcMap, stick: int) -> int:
    """Channel of ROLL, PITCH, THROTTLE or YAW, from 0 on."""
    channel = int(params.YAW)
    if stick == ROLL:
        channel = int(params.ROLL)
    elif stick == PITCH:
        channel = int(params.PITCH)
    elif stick == THROTTLE:
        channel = int(params.THROTTLE)
    return channel - 1 if 1 <= channel <= RC_INPUTS else stick


@law
def stick_pulse(rc: Radio, params: RcMap, stick: int) -> int:
    """Pulse of a stick [us]; 0 unknown."""
    return rc.channels[stick_channel(params, stick)]


@law
def stick_position(rc: Radio, params: Parameters, stick: int) -> float:
    """-1 .. 1 of a stick that springs to the middle."""
    channel = stick_channel(params.RCMAP, stick)
    pulse = rc.channels[channel]
    return centred(pulse, params.RC[channel], params.RC[channel].DZ) if pulse != 0 else 0.0


@law
def is_overridden(rc: Radio, k: int, time_us: int, duration: float) -> bool:
    """Whether a ground station gave a pulse for channel ``k`` (from 0) less than ``duration`` [s] ago; -1: ever."""
    if rc.override[k] == 0:
        return False
    return duration < 0.0 or (duration > 0.0 and time_us - rc.override_us[k] < duration * 1e6)


@law
def spoil(rc: Radio, params: Parameters, overridden: bool) -> None:
    """Sticks of a transmitter that fails without falling silent; noise on all channels."""
    if rc.is_neutral and not overridden:
        for k in range(RC_INPUTS):
            rc.channels[k] = 1500
        rc.channels[stick_channel(params.RCMAP, THROTTLE)] = FAILED_THROTTLE
    if rc.noise > 0.0:
        for k in range(RC_INPUTS):
            rc.noise_state = (rc.noise_state * 1103515245 + 12345) & 0x7FFFFFFF  # ISO C's example of rand()
            if rc.channels[k] != 0 and not rc.stuck >> k & 1:
                rc.channels[k] += int(rc.noise * ((rc.noise_state >> 12) / 262144.0 - 1.0))


@law
def receive(rc: Radio, sensors: Sensors, params: Parameters, time_us: int, throttle: int, timeout: float) -> None:
    """One frame of the receiver, fifty times a second: effective channels, and whether the radio is there.

    A receiver of the physics side takes the place of the simulated transmitter, and is lost when its frames stop.

    Args:
        rc: the radio.
        sensors: with what the receiver of the physics side gives.
        params: with RC_OVERRIDE_TIME and RCMAP_*.
        time_us: now [us].
        throttle: pulse [us] of the throttle stick at rest in the simulated transmitter.
        timeout: silence that counts as lost [s].
    """
    overridden, is_real, has_receiver = False, sensors.rc_count > 0, rc.has_receiver
    stuck = rc.stuck if rc.is_faulty else 0
    duration = params.RC_OVERRIDE_TIME
    for k in range(18):
        if stuck >> k & 1:
            continue
        if is_overridden(rc, k, time_us, duration):
            rc.channels[k] = rc.override[k]
            overridden = True
        elif has_receiver and is_real:
            rc.channels[k] = sensors.rc_channels[k] if k < RC_INPUTS else 0
        elif has_receiver:
            rc.channels[k] = throttle if k == THROTTLE else RECEIVER_PULSES[k] if k < 8 else 0
    if rc.is_faulty:
        spoil(rc, params, overridden)
    if overridden or (has_receiver and not is_real):
        rc.receiver_us = time_us
    elif rc.has_receiver:
        rc.receiver_us = max(rc.receiver_us, min(sensors.rc_time_us, time_us))
    fresh = time_us - rc.receiver_us < timeout * 1e6
    rc.receiver_ok = fresh and stick_pulse(rc, params.RCMAP, THROTTLE) > 0


@law
def expo(x: float, softness: float) -> float:
    """Stick -1 .. 1 with a middle softened by a hyperbola that still reaches 1 at full stick."""
    k = constrain(softness, -0.5, 0.95)
    if k == 0.0:
        return x
    return (1.0 - k) * x / (1.0 - k * abs(x))
