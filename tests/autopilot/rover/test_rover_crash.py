# SPDX-License-Identifier: BSD-3-Clause
"""Crash and tilt check."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.rover import crash
from sitl.autopilot.rover.modes import guided_setpoints
from sitl.autopilot.rover.modes.guided import GUIDED
from sitl.autopilot.rover.modes.hold import HOLD
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.autopilot.rover.modes.set_mode import request
from sitl.autopilot.state import Arming, Estimate
from sitl.core.vectors import Euler, Vec3
from tests.autopilot.rover.modes.driven_rover import Rover


class Stuck(Rover):
    """Its wheels turn and it stays where it is."""

    stuck = False

    def _move(self) -> None:
        if not self.stuck:
            super()._move()


def blocked(**params: float) -> Stuck:
    rover = Stuck(**params)
    request(rover.v, GUIDED, 2)
    rover.arm()
    rover.run(0.5)
    rover.events()
    rover.stuck = True
    return rover


def run_into_wall(rover: Stuck, seconds: float) -> None:
    for _ in range(round(seconds / 0.5)):
        guided_setpoints.set_heading_and_speed(rover.ap.modes, rover.v.time_us, 0.0, 2.0)
        rover.run(0.5)


@pytest.mark.parametrize(("check", "armed"), [(1.0, 1), (2.0, 0)])
def test_blocked_for_two_seconds(check: float, armed: int) -> None:
    rover = blocked(FS_CRASH_CHECK=check)
    run_into_wall(rover, 1.5)
    assert rover.ap.modes.number == GUIDED
    run_into_wall(rover, 1.5)
    assert rover.ap.modes.number == HOLD
    assert rover.ap.arming.armed == armed
    assert "Crash: Going to HOLD" in rover.texts()


def test_not_watched_by_default_nor_while_it_moves() -> None:
    off = blocked()
    run_into_wall(off, 4.0)
    assert off.ap.modes.number == GUIDED
    moving = blocked(FS_CRASH_CHECK=1.0)
    moving.stuck = False
    run_into_wall(moving, 4.0)
    assert moving.ap.modes.number == GUIDED


def test_leaning_too_far_counts_at_once() -> None:
    rover = blocked(FS_CRASH_CHECK=1.0, CRASH_ANGLE=30.0)
    rover.ap.estimate.euler = rover.ap.estimate.euler.replace(roll=math.radians(35.0))
    rover.run(0.12)
    assert rover.ap.modes.number == HOLD


def test_pilots_modes_are_not_watched() -> None:
    rover = blocked(FS_CRASH_CHECK=1.0, CRASH_ANGLE=30.0)
    request(rover.v, MANUAL, 2)
    rover.ap.estimate.euler = rover.ap.estimate.euler.replace(roll=math.radians(35.0))
    rover.run(3.0)
    assert rover.ap.modes.number == MANUAL


def test_a_crash_is_two_seconds_without_a_break_or_a_lean() -> None:
    arming, estimate = Arming(), Estimate()
    assert [crash.detect_crash(arming, estimate, 0.5, 0.0) for _ in range(20)] == [False] * 19 + [True]
    assert arming.crash_ticks == 0, "the next one takes two seconds, too"
    crash.detect_crash(arming, estimate, 0.5, 0.0)
    estimate.vel = Vec3(0.1, 0.0, 0.0)
    assert not crash.detect_crash(arming, estimate, 0.5, 0.0)
    assert arming.crash_ticks == 0
    estimate.euler = Euler(0.0, -0.6, 0.0)
    assert not crash.detect_crash(arming, estimate, 0.5, 0.7)
    assert crash.detect_crash(arming, estimate, 0.5, 0.5)
