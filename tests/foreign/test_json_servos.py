# SPDX-License-Identifier: BSD-3-Clause
"""Frames of servos: 16 and 32 pulses, what is none, and what a pulse asks of an airframe."""

from __future__ import annotations

import struct

import pytest

from sitl.bridge.ardupilot_json.servos import ServoError, Servos, control, controls, decode, encode


@pytest.mark.parametrize(("pulses", "magic", "size"), [(16, 18458, 40), (32, 29569, 72)])
def test_a_frame_has_the_published_layout(pulses, magic, size):
    widths = tuple(range(1000, 1000 + pulses))
    datagram = struct.pack(f"<HHI{pulses}H", magic, 400, 4_000_000_000, *widths)
    assert len(datagram) == size
    frame = decode(datagram)
    assert frame == Servos(400, 4_000_000_000, widths)
    assert encode(frame) == datagram


@pytest.mark.parametrize(
    ("datagram", "why"),
    [
        (b"", "0 bytes"),
        (b"hello", "5 bytes"),
        (struct.pack("<HHI16H", 29569, 400, 0, *(0,) * 16), "begins with 29569"),
        (struct.pack("<HHI16H", 18458, 400, 0, *(0,) * 16) + b"\0", "41 bytes"),
    ],
)
def test_other_datagrams_are_refused_with_the_reason(datagram, why):
    with pytest.raises(ServoError, match=why):
        decode(datagram)


def test_only_16_or_32_pulses_make_a_frame():
    with pytest.raises(ServoError, match="not 8"):
        encode(Servos(400, 0, (1500,) * 8))


@pytest.mark.parametrize(
    ("pulse", "rotor", "servo"),
    [(0, 0.0, 0.0), (900, 0.0, -1.0), (1000, 0.0, -1.0), (1250, 0.25, -0.5), (1500, 0.5, 0.0), (2100, 1.0, 1.0)],
)
def test_a_pulse_is_a_rotors_or_a_servos_control(pulse, rotor, servo):
    assert control(pulse, False) == rotor
    assert control(pulse, True) == servo


def test_the_border_takes_sixteen_of_32_pulses():
    assert controls((1500,) * 16 + (2000,) * 16, False) == [0.5] * 16
