# SPDX-License-Identifier: BSD-3-Clause
"""Datagrams, MSP and sticks, without the program."""

from __future__ import annotations

import struct

import pytest

from sitl.foreign.betaflight import msp, wire
from sitl.foreign.betaflight.configuration import lines, settings
from sitl.foreign.betaflight.receiver import CENTRE, LOW, MODES, Sticks, deflection


def test_motion_is_eighteen_doubles_with_east_before_north_and_longitude_before_latitude():
    data = wire.state(1.5, (1, 2, 3), (4, 5, -9.8), (1, 0, 0, 0), (10, 20, 30), (-35.0, 149.0, 584.0), 94500.0)
    assert struct.unpack("<18d", data) == (
        1.5, 1, 2, 3, 4, 5, -9.8, 1, 0, 0, 0, 20, 10, -30, 149.0, -35.0, 584.0, 94500.0
    )  # fmt: skip


def test_motors_come_in_our_order():
    theirs = dict(zip(("rear right", "front right", "rear left", "front left"), (1100.0, 1200.0, 1300.0, 1400.0)))
    data = struct.pack("<Hxx16f", 4, *theirs.values(), *12 * [0.0])
    ours = "front right", "rear left", "front left", "rear right"
    assert wire.motors(data) == tuple(theirs[where] for where in ours)
    assert wire.motors(data[:-1]) == ()
    assert wire.motors(struct.pack("<Hxx16f", 6, *16 * [0.0])) == ()


def status_payload(armed: bool, arming: int) -> bytes:
    return struct.pack("<3HIBH2BB", 125, 0, 33, int(armed), 0, 7, 4, 4, 0) + struct.pack("<BIBHB", 29, arming, 0, 0, 4)


def answer(number: int, payload: bytes) -> bytes:
    return msp.request(number, payload).replace(b"$M<", b"$M>")


def test_status_says_what_prevents_arming():
    found = msp.status(status_payload(False, 1 << 7 | 1 << 12))
    assert found is not None
    assert found.reasons == "THROTTLE, CALIB" and not found.armed
    assert msp.status(status_payload(True, 0)).armed
    assert msp.status(b"\0" * 10) is None


def test_answers_are_cut_out_of_any_pieces_and_wrong_checksums_left_out():
    good = answer(msp.STATUS_EX, status_payload(True, 0))
    data = b"noise$" + good[:-1] + bytes((good[-1] ^ 1,)) + good + answer(3, b"")
    for size in (1, 5, len(data)):
        answers, found = msp.Answers(), []
        for at in range(0, len(data), size):
            found += answers.feed(data[at : at + size])
        assert [number for number, _ in found] == [msp.STATUS_EX, 3]


@pytest.mark.parametrize(("centre", "greatest", "expo"), [(670, 670, 0.0), (70, 670, 0.0), (100, 800, 0.5)])
def test_the_stick_is_where_its_curve_gives_the_rate(centre, greatest, expo):
    for rate in (-600.0, -50.0, 0.0, 3.0, 200.0, 650.0):
        x = deflection(rate, centre, greatest, expo)
        made = x * centre + max(0, greatest - centre) * abs(x) * (x**5 * expo + x * (1 - expo))
        assert made == pytest.approx(rate, abs=0.01)
    assert abs(deflection(5000.0, centre, greatest, expo)) == pytest.approx(1.0, abs=1e-6)


class Overridden:
    """RC_CHANNELS_OVERRIDE."""

    def __init__(self, **pulses: int) -> None:
        for k in range(1, 19):
            setattr(self, f"chan{k}_raw", pulses.get(f"chan{k}", 65535))


def test_overrides_move_sticks_but_not_the_switches_of_commands():
    sticks = Sticks()
    sticks.override(Overridden(chan1=1600, chan3=1400, chan5=2000, chan6=2000, chan8=1700, chan9=1800))
    pulses = sticks.pulses()
    assert pulses[:4] == (1600, CENTRE, 1400, CENTRE)
    assert pulses[4] == LOW and pulses[5] == sticks.mode.pulse
    assert pulses[7:9] == (1700, 1800)
    sticks.override(Overridden(chan1=0, chan3=0, chan2=100))
    assert sticks.pulses()[:3] == (CENTRE, CENTRE, LOW)


def test_rates_become_sticks_of_the_program_s_curve():
    sticks = Sticks()
    sticks.turn((1.0, 0.0, 0.0), 0.5)  # not known yet
    assert sticks.pulses()[:4] == (CENTRE, CENTRE, LOW, CENTRE)
    sticks.rates = msp.Rates(msp.ACTUAL, (57, 57, 57), (57, 57, 57), (0, 0, 0))
    sticks.turn((0.1, -0.2, 0.3), 0.5)
    assert sticks.pulses()[:4] == (CENTRE + 5, CENTRE + 10, 1525, CENTRE + 15)


def test_modes_have_switch_positions_of_their_own():
    assert len({mode.pulse for mode in MODES}) == len({mode.number for mode in MODES}) == 3


def test_lines_of_a_diff_are_those_that_mean_something():
    text = "# version\n\nbatch start\nset a = 1  # note\nsave\nfeature -AIRMODE\nexit\n"
    assert lines(text) == ["batch start", "set a = 1", "feature -AIRMODE"]
    assert settings({"motor_idle": 600, "x": 2.0, "y": "ON"}) == ["set motor_idle = 600", "set x = 2", "set y = ON"]
