# SPDX-License-Identifier: BSD-3-Clause
"""The ground station's sticks.

RC_CHANNELS_OVERRIDE and MANUAL_CONTROL, only from the system named by MAV_GCS_SYSID.
"""

from __future__ import annotations

from typing import Any

from ..channel import Channel
from ..dialect import message
from .service import Handler, Sender, Service

RELEASE_EXTENDED = 65534
"""Channels 1..8: 0 gives the channel back; channels 9..18: 65534 does, and 0 means nothing. 65535 leaves a channel."""
CHANNELS = 18
FIRST_EXTENDED = message("RC_CHANNELS_OVERRIDE").fields.index("chan9_raw")
"""Place of channel 9 in the message as it is on the wire; the others follow."""
INVALID = 32767
FULL = 1000
"""Axes of MANUAL_CONTROL: greatest value."""
DEFAULT_RANGE = (1100.0, 1900.0)
LOWEST, HIGHEST = 800, 2200
"""Pulses outside cannot come from a receiver and are ignored [us]."""


class RcService(Service):
    """The ground station's sticks; the firmware forgets them after RC_OVERRIDE_TIME."""

    def __init__(self, bridge: Any) -> None:
        super().__init__(bridge)
        rc = bridge.vehicle.v.autopilot.rc
        self._pulses, self._times = rc.override, rc.override_us  # of the record: they stay in place

    def handlers(self) -> dict[str, Handler]:
        return {"RC_CHANNELS_OVERRIDE": self._override, "MANUAL_CONTROL": self._manual}

    def _put(self, channel: int, pulse: int) -> None:
        """Override channel 0.. with a pulse [us]; 0 gives it back."""
        self._pulses[channel] = pulse
        self._times[channel] = self.bridge.now_us

    def _note_ground_station(self) -> None:
        self.bridge.vehicle.v.autopilot.modes.failsafe.gcs_us = self.bridge.now_us

    def _override(self, channel: Channel, m: Any, sender: Sender) -> None:
        if sender[0] != self.bridge.ground_station:
            return
        for k, pulse in enumerate(m[:8]):  # these come first on the wire
            if pulse == 0 or LOWEST <= pulse <= HIGHEST:
                self._put(k, pulse)
        extended = m[FIRST_EXTENDED:]
        if any(extended):
            for k, pulse in enumerate(extended, 8):
                if pulse == RELEASE_EXTENDED:
                    self._put(k, 0)
                elif LOWEST <= pulse <= HIGHEST:
                    self._put(k, pulse)
        self._note_ground_station()

    def _manual(self, channel: Channel, m: Any, sender: Sender) -> None:
        """The firmware's profile says which axis drives which channel."""
        if sender[0] != self.bridge.ground_station or m.target != channel.system:
            return
        for stick in self.bridge.profile.sticks:
            value = getattr(m, stick.axis)
            number = int(self.bridge.parameter(stick.parameter) or stick.channel)
            if value == INVALID or not 1 <= number <= CHANNELS:
                continue
            value = min(max(value, stick.lowest), FULL)
            share = (FULL - value if stick.is_reversed else value - stick.lowest) / (FULL - stick.lowest)
            low, high = self._range(number)
            self._put(number - 1, int(low + (high - low) * share))
        self._note_ground_station()

    def _range(self, number: int) -> tuple[float, float]:
        low, high = self.bridge.parameter(f"RC{number}_MIN"), self.bridge.parameter(f"RC{number}_MAX")
        return (low, high) if low is not None and high is not None else DEFAULT_RANGE
