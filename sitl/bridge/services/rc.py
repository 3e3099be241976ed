# SPDX-License-Identifier: BSD-3-Clause
"""The ground station's sticks.

RC_CHANNELS_OVERRIDE and MANUAL_CONTROL, only from the system named by MAV_GCS_SYSID. The firmware forgets them after
RC_OVERRIDE_TIME.
"""

from __future__ import annotations

from ...core.kernels import law
from ...core.records import Ints
from ...vehicle.record import Vehicle
from ..wire.message import Message, consecutive

RELEASE_EXTENDED = 65534
"""Channels 1..8: 0 gives the channel back; channels 9..18: 65534 does, and 0 means nothing. 65535 leaves a channel."""
FIRST_CHANNELS, CHANNELS = 8, 18
INVALID = 32767
FULL = 1000
"""Axes of MANUAL_CONTROL: greatest value."""
DEFAULT_MIN, DEFAULT_MAX = 1100.0, 1900.0
"""Of channels without parameters [us]."""
LOWEST, HIGHEST = 800, 2200
"""Pulses outside cannot come from a receiver and are ignored [us]."""


class RcChannelsOverride(Message, name="RC_CHANNELS_OVERRIDE"):
    """Pulses [us]."""

    pulses: Ints = consecutive(*(f"chan{k}_raw" for k in range(1, 9)))
    more_pulses: Ints = consecutive(*(f"chan{k}_raw" for k in range(9, 19)))
    target_system: int
    target_component: int


class ManualControl(Message, name="MANUAL_CONTROL"):
    """Axes of a joystick, -1000 .. 1000; ``INVALID``: there is none."""

    target: int
    x: int
    y: int
    z: int
    r: int


@law
def rc_channels_override(m: RcChannelsOverride, v: Vehicle, sender: int) -> None:
    """Override channels of the radio."""
    if not is_ground_station(v, sender):
        return
    for k in range(FIRST_CHANNELS):
        pulse = m.pulses[k]
        if pulse == 0 or LOWEST <= pulse <= HIGHEST:
            override(v, k, pulse)
    for k in range(CHANNELS - FIRST_CHANNELS):
        pulse = m.more_pulses[k]
        if pulse == RELEASE_EXTENDED:
            override(v, FIRST_CHANNELS + k, 0)
        elif LOWEST <= pulse <= HIGHEST:
            override(v, FIRST_CHANNELS + k, pulse)
    note_ground_station(v)


@law
def is_ground_station(v: Vehicle, sender: int) -> bool:
    """Whether a system is the pilot's ground station (MAV_GCS_SYSID)."""
    return sender == int(v.autopilot.params.MAV.GCS_SYSID)


@law
def is_driver(m: ManualControl, v: Vehicle, sender: int) -> bool:
    """Whether the axes are the ground station's, for us: MANUAL_CONTROL names its target in a field of its own."""
    return is_ground_station(v, sender) and m.target == min(max(int(v.autopilot.params.MAV.SYSID), 1), 255)


@law
def note_ground_station(v: Vehicle) -> None:
    """The ground station is there."""
    v.autopilot.modes.failsafe.gcs_us = v.time_us


@law
def override(v: Vehicle, k: int, pulse: int) -> None:
    """Override channel ``k`` (from 0) with a pulse [us]; 0 gives it back."""
    if v.autopilot.rc.override_blocked:
        return
    v.autopilot.rc.override[k] = pulse
    v.autopilot.rc.override_us[k] = v.time_us


@law
def move_stick(v: Vehicle, channel: float, default: int, axis: int, lowest: int, is_reversed: bool) -> None:
    """Override the channel of a stick.

    Args:
        v: the vehicle.
        channel: value of the RCMAP_ parameter, 1 ..
        default: the channel if that is 0.
        axis: value of the axis.
        lowest: the axis' value that means the channel's least pulse; ``FULL`` means its greatest.
        is_reversed: the other way round.
    """
    number = int(channel) if channel != 0.0 else default
    if axis == INVALID or not 1 <= number <= CHANNELS:
        return
    low, high = DEFAULT_MIN, DEFAULT_MAX
    if number <= len(v.autopilot.params.RC):
        calibration = v.autopilot.params.RC[number - 1]
        low, high = calibration.MIN, calibration.MAX
    value = min(max(axis, lowest), FULL)
    share = (FULL - value if is_reversed else value - lowest) / (FULL - lowest)
    override(v, number - 1, int(low + (high - low) * share))
