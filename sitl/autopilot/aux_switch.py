# SPDX-License-Identifier: BSD-3-Clause
"""Switches on the radio's channels: where each stands. What it does (RCn_OPTION) is in ``aux_functions``.

Source: https://ardupilot.org/copter/docs/common-auxiliary-functions.html
"""

from __future__ import annotations

from ..core.border import RC_INPUTS
from ..core.kernels import law
from .events import Event, Events, emit_and_return
from .mode_switch import DEBOUNCE_US
from .params.firmware_parameters import Parameters
from .state import Arming, Radio

LOW, MIDDLE, HIGH = 1, 2, 3
"""Positions of a switch."""
LOW_BELOW, HIGH_ABOVE = 1200, 1800
"""Pulses [us]."""
MOTOR_INTERLOCK = 32
"""Function of a switch."""

AUX_SWITCH = Event(30)  # a: channel, b: position, negative the first one since boot


@law
def position(pulse: int) -> int:
    """LOW, MIDDLE or HIGH of a pulse [us]; 0 for one that means nothing."""
    if pulse <= 800 or pulse >= 2200:
        return 0
    if pulse < LOW_BELOW:
        return LOW
    return HIGH if pulse > HIGH_ABOVE else MIDDLE


@law
def watch(rc: Radio, arming: Arming, events: Events, time_us: int, params: Parameters) -> None:
    """After each frame of the receiver: report to the shell every switch that was moved and stayed for DEBOUNCE_US."""
    arming.interlock_used = False
    for k in range(RC_INPUTS):
        option = int(params.RC[k].OPTION)
        if option == MOTOR_INTERLOCK:
            arming.interlock_used = True
        now = position(rc.channels[k]) if option != 0 else 0
        if now == 0:
            continue
        if now != rc.switch_candidate[k]:
            rc.switch_candidate[k] = now
            rc.switch_us[k] = time_us
        elif now != rc.switch_position[k] and time_us - rc.switch_us[k] >= DEBOUNCE_US:
            is_first = rc.switch_position[k] == 0
            rc.switch_position[k] = now
            emit_and_return(events, time_us, AUX_SWITCH, float(k + 1), float(-now if is_first else now))


@law
def has_function(params: Parameters, first: int, second: int) -> bool:
    """Whether a channel has one of two functions."""
    for k in range(RC_INPUTS):
        option = int(params.RC[k].OPTION)
        if option in (first, second):
            return True
    return False
