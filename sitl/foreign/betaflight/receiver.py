# SPDX-License-Identifier: BSD-3-Clause
"""The receiver that Betaflight hears: sticks and switches from MAVLink, as pulses [us], as they were sent last.

Channels: roll, pitch, throttle, yaw; AUX1 arms, AUX2 chooses the mode. The others are a client's to set.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ...bridge.services.rc import FIRST_CHANNELS, FULL, HIGHEST, INVALID, LOWEST, RELEASE_EXTENDED
from .airframe import LEAST_THROTTLE, pulse_of
from .msp import ACTUAL, Rates
from .wire import CHANNELS

ROLL, PITCH, THROTTLE, YAW, ARM, MODE = range(6)
CENTRE, LOW, HIGH = 1500, 1000, 2000


class Mode(NamedTuple):
    """A flight mode."""

    name: str
    number: int
    """``custom_mode`` of its HEARTBEAT: 0, and the permanent ids of Betaflight's boxes."""
    pulse: int
    """Of the channel ``MODE``."""


MODES = (Mode("ACRO", 0, 1000), Mode("ANGLE", 1, 1900), Mode("HORIZON", 2, 1500))
ACRO = MODES[0]


def deflection(rate: float, centre: float, greatest: float, expo: float) -> float:
    """The part of a stick's way, -1 .. 1, that asks for a rate [deg/s] by the curve ACTUAL: x c + (m - c)+ e(x), with
    e(x) = |x| (expo x^5 + (1 - expo) x). Rates beyond the greatest are cut off."""
    span = max(0.0, greatest - centre)
    wanted, low, high = abs(rate), 0.0, 1.0
    if span == 0.0:
        return math.copysign(min(wanted / centre, 1.0), rate) if centre > 0.0 else 0.0
    for _ in range(24):  # it rises
        x = 0.5 * (low + high)
        square = x * x
        if x * centre + span * x * (expo * square * square * x + (1.0 - expo) * x) < wanted:
            low = x
        else:
            high = x
    return math.copysign(0.5 * (low + high), rate)


class Sticks:
    """What the receiver sends now."""

    def __init__(self) -> None:
        self.mode = MODES[1]
        self.is_armed = False
        """Whether the switch says so."""
        self.rates: Rates | None = None
        """As the program tells them; None: not yet."""
        self._pulses = [CENTRE, CENTRE, LOW, CENTRE, *(CHANNELS - 4) * [LOW]]

    @property
    def throttle_is_low(self) -> bool:
        """Whether it may be armed."""
        return self._pulses[THROTTLE] <= LEAST_THROTTLE

    def override(self, m: Any) -> None:
        """RC_CHANNELS_OVERRIDE. Switches for arming and mode are set by commands, not by it."""
        for k in range(CHANNELS):
            pulse = getattr(m, f"chan{k + 1}_raw")
            if k in (ARM, MODE):
                continue
            released = pulse == (0 if k < FIRST_CHANNELS else RELEASE_EXTENDED)
            if released:
                self._pulses[k] = CENTRE if k in (ROLL, PITCH, YAW) else LOW
            elif LOWEST <= pulse <= HIGHEST:
                self._pulses[k] = pulse

    def manual(self, m: Any) -> None:
        """MANUAL_CONTROL: right is roll, forward is nose down, up is throttle from 0 on, turn is yaw."""
        for k, axis, low in ((ROLL, m.y, -FULL), (PITCH, m.x, -FULL), (THROTTLE, m.z, 0), (YAW, m.r, -FULL)):
            if axis != INVALID:
                share = (min(max(axis, low), FULL) - low) / (FULL - low)
                self._pulses[k] = round(LOW + (HIGH - LOW) * share)

    def turn(self, rates: Sequence[float], throttle: float) -> None:
        """Rates of the body, forward right down [rad/s], and a part of the throttle's way, 0 .. 1, by its curves."""
        if self.rates is None or self.rates.kind != ACTUAL:
            return
        for k, rate, axis in zip((ROLL, PITCH, YAW), rates, range(3)):
            centre, most, expo = (each[axis] for each in (self.rates.centre, self.rates.greatest, self.rates.expo))
            x = deflection(math.degrees(rate), 10.0 * centre, 10.0 * most, 0.01 * expo)
            self._pulses[k] = round(CENTRE + 500.0 * (-x if k == PITCH else x))  # forward is up, and nose down
        self._pulses[THROTTLE] = pulse_of(throttle)

    def pulses(self) -> tuple[int, ...]:
        """All of them [us]."""
        found = list(self._pulses)
        found[ARM] = HIGH - 100 if self.is_armed else LOW
        found[MODE] = self.mode.pulse
        return tuple(found)
