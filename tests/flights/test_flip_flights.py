# SPDX-License-Identifier: BSD-3-Clause
"""FLIP flown with a ground station's sticks."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.simulation import Core
from tests.flights.aviator import ALT_HOLD, FLIP, LOITER, Aviator

PITCH, ROLL = 8, 7


def flipped(core: Core, **sticks: int) -> tuple[Aviator, np.ndarray]:
    """A copter that flips from ALT_HOLD, and its track until FLIP was over."""
    p = Aviator(core, "ardupilot_quad").hover(40.0)
    p.sticks(0.5)
    assert p.set_mode(ALT_HOLD)
    p.sticks(2.0)
    p.sticks(0.2, **sticks)
    start = p.now
    assert p.set_mode(FLIP)
    assert p.fly(4.0, lambda: p.mode == ALT_HOLD)
    return p, p.since(start)


@pytest.mark.parametrize(
    ("sticks", "column", "sign"),
    [({}, ROLL, 1.0), ({"roll": 1300}, ROLL, -1.0), ({"pitch": 1300}, PITCH, -1.0), ({"pitch": 1700}, PITCH, 1.0)],
)
def test_it_turns_over_once_and_gives_back(core: Core, sticks: dict[str, int], column: int, sign: float) -> None:
    p, track = flipped(core, **sticks)
    assert 0.9 < track[-1, 0] - track[0, 0] < 1.7, "a real ArduPilot: 1.2 s"
    if column == ROLL:
        turned = np.degrees(np.unwrap(np.radians(track[:, ROLL])))
        assert turned[-1] - turned[0] == pytest.approx(360.0 * sign, abs=30.0)
    else:
        assert np.abs(track[:, ROLL]).max() > 170.0, "upside down"
        first = track[np.abs(track[:, PITCH]) > 30.0][0, PITCH]
        assert first * sign > 0.0
    p.sticks(4.0)
    assert np.abs(p.euler[:2]).max() < 3.0 and p.height > 34.0, "a real ArduPilot loses 4 m"


def test_it_begins_in_some_modes_in_flight_only(core: Core) -> None:
    p = Aviator(core).hover(15.0)
    p.sticks(0.5)
    assert p.set_mode(LOITER)
    assert not p.set_mode(FLIP) and p.mode == LOITER
    assert p.said("Mode change to FLIP failed: init failed")


def test_a_stick_pushed_far_ends_it(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").hover(40.0)
    p.sticks(0.5)
    assert p.set_mode(ALT_HOLD)
    p.sticks(2.0)
    assert p.set_mode(FLIP)
    p.hold(pitch=2000)
    assert p.fly(0.3, lambda: p.mode == ALT_HOLD)
    p.sticks(4.0)
    assert np.abs(p.euler[:2]).max() < 3.0
