# SPDX-License-Identifier: BSD-3-Clause
"""What AUTOTUNE makes of a twitch: each row is one of a real ArduPilot's (ATUN), with its gains before and after."""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest

from sitl.autopilot.copter.modes import autotune, autotune_rules
from sitl.autopilot.copter.modes.autotune_gains import ROLL, YAW
from sitl.autopilot.copter.modes.autotune_rules import (
    ANGLE_P_DOWN,
    ANGLE_P_UP,
    CHANGED,
    D_AT_LIMIT,
    ENOUGH,
    NO_D,
    NO_P,
    RATE_D_DOWN,
    RATE_D_UP,
    RATE_P_UP,
    TOO_LARGE,
    TWITCH_AT_LEAST,
)
from sitl.autopilot.copter.modes.state import AutotuneState
from sitl.vehicle.copter import Copter
from sitl.vehicle.kinds import KINDS


class Twitch(NamedTuple):
    """A row of ATUN."""

    axis: int
    step: int
    target: float  # [deg/s] or [deg]
    least: float
    most: float


class Gains(NamedTuple):
    """Gains of a row; ``d``: yaw's filter where that stands in for it."""

    p: float
    d: float
    angle_p: float


def made_of(twitch: Twitch, gains: Gains, turned_back: float = 0.0) -> tuple[Gains, AutotuneState, int]:
    """Gains after a twitch, what AUTOTUNE remembers, and what it came to."""
    v = Copter.of(Copter.fleet(1), 0)
    KINDS["copter"].firmware.table.set_defaults(v.autopilot.params)
    t = v.autopilot.modes.autotune
    t.axis, t.step, t.target, t.count = twitch.axis, twitch.step, math.radians(twitch.target), 2
    if twitch.step <= RATE_P_UP:
        t.rate_min, t.rate_max = math.radians(twitch.least), math.radians(twitch.most)
    else:
        t.angle_min, t.angle_max = math.radians(twitch.least), math.radians(twitch.most)
        t.rate_max, t.rate_min = 1.0, -turned_back
    g = autotune.gains.found(t, twitch.axis)
    g.rate_p, g.angle_p = gains.p, gains.angle_p
    autotune_rules.set_d(t, g, gains.d)
    came_to = autotune.change_gains(v)
    return Gains(g.rate_p, autotune_rules.get_d(t, g), g.angle_p), t, came_to


@pytest.mark.parametrize(
    ("twitch", "before", "after", "count"),
    [
        (Twitch(ROLL, RATE_D_UP, 155.86, 134.90, 145.88), (0.135, 0.0036, 4.5), (0.135, 0.0036, 4.5), 3),
        (Twitch(ROLL, RATE_D_UP, 155.86, 131.15, 131.15), (0.135, 0.0036, 4.5), (0.135, 0.00396, 4.5), 1),
        (Twitch(ROLL, RATE_D_UP, 117.80, 93.30, 93.30), (0.135, 0.005798, 4.5), (0.14175, 0.005798, 4.5), 2),
        (Twitch(ROLL, RATE_D_DOWN, 155.86, 127.13, 144.68), (0.135, 0.0036, 4.5), (0.135, 0.00342, 4.5), 1),
        (Twitch(ROLL, RATE_D_DOWN, 180.0, 164.75, 176.78), (0.135, 0.000598, 4.5), (0.135, 0.000598, 4.5), 3),
        (Twitch(ROLL, RATE_P_UP, 180.0, 166.27, 180.58), (0.14175, 0.000598, 4.5), (0.14884, 0.000598, 4.5), 1),
        (Twitch(ROLL, RATE_P_UP, 180.0, 187.16, 187.16), (0.15628, 0.000598, 4.5), (0.15628, 0.000598, 4.5), 3),
        (Twitch(ROLL, RATE_P_UP, 58.67, 45.14, 48.98), (0.412585, 0.0071208, 4.5), (0.391956, 0.0067647, 4.5), 1),
        (Twitch(ROLL, ANGLE_P_DOWN, 15.0, 14.48, 14.48), (0.15628, 0.0006, 4.5), (0.15628, 0.0006, 4.5), 3),
        (Twitch(ROLL, ANGLE_P_UP, 15.0, 14.39, 14.39), (0.15628, 0.0006, 4.5), (0.15628, 0.0006, 4.725), 1),
        (Twitch(YAW, RATE_D_UP, 47.83, 36.59, 37.78), (0.4654, 2.75, 4.5), (0.48867, 2.75, 4.5), 2),
        (Twitch(YAW, RATE_P_UP, 30.79, 27.23, 29.46), (1.01591, 5.0, 4.5), (0.965115, 4.75, 4.5), 1),
        (Twitch(YAW, ANGLE_P_DOWN, 11.64, 12.08, 12.08), (0.77145, 1.0, 3.482), (0.77145, 1.0, 3.308), 1),
        (Twitch(YAW, ANGLE_P_DOWN, 12.25, 11.34, 12.26), (0.77145, 1.0, 3.308), (0.77145, 1.0, 3.308), 3),
    ],
)
def test_a_real_ones_twitches_change_the_same(
    twitch: Twitch, before: tuple[float, ...], after: tuple[float, ...], count: int
) -> None:
    found, t, came_to = made_of(twitch, Gains(*before))
    assert found == pytest.approx(after, rel=1e-4)
    assert t.count == count
    assert came_to == CHANGED


def test_an_angle_that_is_passed_a_little_is_right_when_it_turns_back() -> None:
    twitch, gains = Twitch(YAW, ANGLE_P_UP, 11.67, 10.96, 11.85), Gains(0.77145, 1.0, 3.473)
    assert made_of(twitch, gains, turned_back=0.2)[1].count == 3
    assert made_of(twitch, gains, turned_back=0.05)[1].count == 1


def test_ends_of_the_gains() -> None:
    quiet, bounce = Twitch(ROLL, RATE_D_UP, 100.0, 95.0, 95.0), Twitch(ROLL, RATE_D_DOWN, 100.0, 80.0, 95.0)
    found, t, came_to = made_of(quiet, Gains(0.2, 0.19, 4.5))
    assert (found.d, t.count, came_to) == (0.2, ENOUGH, CHANGED)
    found, t, came_to = made_of(bounce, Gains(0.2, 0.00051, 4.5))
    assert (found.d, t.count, came_to) == (pytest.approx(0.0005), ENOUGH, D_AT_LIMIT)
    weak, strong = Twitch(ROLL, RATE_D_UP, 100.0, 50.0, 50.0), Twitch(ROLL, RATE_D_UP, 100.0, 110.0, 110.0)
    assert made_of(weak, Gains(1.95, 0.01, 4.5))[2] == NO_D
    assert made_of(strong, Gains(0.01, 0.00051, 4.5))[2] == NO_D
    assert made_of(strong, Gains(0.01, 0.01, 4.5))[0].d == pytest.approx(0.0095)
    bounce = Twitch(ROLL, RATE_P_UP, 100.0, 80.0, 95.0)
    assert made_of(bounce, Gains(0.01, 0.01, 4.5))[2] == NO_P
    assert made_of(bounce, Gains(0.1, 0.00051, 4.5))[2] == NO_D
    found, t, came_to = made_of(Twitch(ROLL, ANGLE_P_UP, 10.0, 8.0, 8.0), Gains(0.2, 0.001, 39.0))
    assert (found.angle_p, t.count) == (40.0, ENOUGH)


def test_a_twitch_that_turns_too_far_is_made_smaller_until_there_is_no_room() -> None:
    t = AutotuneState()
    t.scale, t.rate_max, t.rate_min = 1.0, 1.0, 1.0
    came_to = [autotune_rules.judge_rate(t, 1.0, 0.3, 2.0, 0.26, 0.075) for _ in range(17)]
    assert came_to == 16 * [TOO_LARGE] + [TWITCH_AT_LEAST]
    assert t.scale == pytest.approx(0.9**16)
