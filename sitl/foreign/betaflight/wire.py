# SPDX-License-Identifier: BSD-3-Clause
"""Betaflight SITL's datagrams, little endian, by its UDP ports.

To 9003: 18 doubles: time [s]; rates of the body, forward right down [rad/s]; specific force in the same axes [m/s^2];
attitude body to NED, w x y z; velocity east, north, up [m/s]; longitude, latitude [deg], altitude [m]; pressure [Pa].
To 9004: time [s] as a double, 16 pulses of a receiver [us]. From 9001: u16 number of motors, two bytes unused, then 16
floats: pulses of motors and servos [us].
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

PULSES, STATE, STICKS = 9001, 9003, 9004
"""UDP ports: what the program sends (pulses of motors; 9002 has the same as parts of their range), and what it gets."""
CHANNELS = 16
IDLE = 1000.0
"""Pulse of a motor that stands [us]."""
MOTORS = 4
"""Motors of the mixer that the program begins with, QUADX."""
ORDER = (1, 2, 3, 0)
"""Our rotors by the program's numbers less one. Ours are in ArduPilot's order: front right, rear left, front left,
rear right; its own begin with rear right, front right."""

_state = struct.Struct("<18d").pack
_sticks = struct.Struct(f"<d{CHANNELS}H").pack
_pulses = struct.Struct("<Hxx16f")

Three = Sequence[float]


def state(
    time_s: float,
    rates: Three,
    force: Three,
    attitude: Sequence[float],
    velocity: Three,
    location: Three,
    pressure: float,
) -> bytes:
    """How the vehicle moves.

    Args:
        time_s: of the simulation [s].
        rates, force: of the body, forward right down [rad/s], [m/s^2].
        attitude: body to NED, w x y z.
        velocity: north, east, down [m/s].
        location: latitude, longitude [deg], altitude [m].
        pressure: of the air [Pa].
    """
    north, east, down = velocity
    lat, lon, alt = location
    return _state(time_s, *rates, *force, *attitude, east, north, -down, lon, lat, alt, pressure)


def sticks(time_s: float, pulses: Sequence[int]) -> bytes:
    """A frame of the receiver: 16 pulses [us]; roll, pitch, throttle, yaw, then switches."""
    return _sticks(time_s, *pulses)


def motors(datagram: bytes) -> tuple[float, ...]:
    """Pulses [us] of our rotors, in our order; none when it is no such datagram."""
    if len(datagram) != _pulses.size:
        return ()
    count, *pulses = _pulses.unpack(datagram)
    if count != MOTORS:
        return ()
    return tuple(pulses[theirs] for theirs in ORDER)
