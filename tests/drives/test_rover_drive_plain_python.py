# SPDX-License-Identifier: BSD-3-Clause
"""The rover's compiled core and the same functions as plain Python give the same bits, in every mode."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sitl.core import records
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.drives import rover_driver as rover
from tests.drives.rover_driver import Driver
from tests.pilots.witness import Item

TICKS = 88
"""Eleven periods of modes and control."""


def by_sticks(mode: int) -> Callable[[Driver], None]:
    def drive(d: Driver) -> None:
        assert d.set_mode(mode)
        d.sticks(2.0, steering=1600, throttle=1700)

    return drive


def then(mode: int, seconds: float) -> Callable[[Driver], None]:
    def drive(d: Driver) -> None:
        d.stream(4.0, rover.VELOCITY, vx=d.cruise)
        d.stream(4.0, rover.VELOCITY, vx=0.5 * d.cruise, vy=0.5 * d.cruise)
        assert d.set_mode(mode)
        d.fly(seconds)

    return drive


def target(mask: int, frame: int = 1, **fields: float) -> Callable[[Driver], None]:
    def drive(d: Driver) -> None:
        d.target(mask, frame, **fields)
        d.fly(1.5)

    return drive


def timed_out(d: Driver) -> None:
    d.stream(2.0, rover.VELOCITY, vx=d.cruise)
    d.fly(3.0)


def backwards(d: Driver) -> None:
    d.target(rover.POSITION, x=-10.0, y=-3.0)
    d.ask(194, 1)
    d.fly(2.0)


def mission(*items: Item, seconds: float) -> Callable[[Driver], None]:
    def drive(d: Driver) -> None:
        d.start_mission(*items)
        d.fly(seconds)
        assert d.mode == rover.AUTO

    return drive


def without_gps(d: Driver) -> None:
    d.stream(4.0, rover.VELOCITY, vx=d.cruise)
    d.set_parameter("SIM_GPS1_ENABLE", 0)
    d.stream(8.0, rover.VELOCITY, vx=d.cruise)


def motor_test(d: Driver) -> None:
    assert d.disarm_result() == 0
    d.set_mode(rover.MANUAL)
    assert d.ask(209, 3 if d.is_skid else 1, 0, 25, 3) == 0
    d.fly(0.5)


def corner(d: Driver) -> None:
    d.start_mission(
        Item(MavCmd.NAV_WAYPOINT, (6.0 * d.cruise, 0.0)), Item(MavCmd.NAV_WAYPOINT, (6.0 * d.cruise, 6.0 * d.cruise))
    )
    assert d.fly(40.0, lambda: d.said("Mission: 2"))
    d.fly(0.5)


PHASES: dict[str, Callable[[Driver], None]] = {
    "manual": by_sticks(rover.MANUAL),
    "acro": by_sticks(rover.ACRO),
    "steering": by_sticks(rover.STEERING),
    "simple": by_sticks(rover.SIMPLE),
    "hold": then(rover.HOLD, 0.3),
    "loiter": then(rover.LOITER, 1.0),
    "circle": then(rover.CIRCLE, 6.0),
    "rtl": then(rover.RTL, 2.0),
    "smart_rtl": then(rover.SMART_RTL, 2.0),
    "guided, place": target(rover.POSITION, x=5.0, y=-5.0),
    "guided, velocity": then(rover.GUIDED, 0.2),
    "guided, turn rate": target(rover.VELOCITY_YAW_RATE, rover.BODY, vx=0.3, yaw_rate=-0.2),
    "guided, timed out": timed_out,
    "guided, backwards": backwards,
    "auto, corner": corner,
    "auto, circling": mission(Item(MavCmd.NAV_LOITER_TURNS, (0.0, 0.0), 0.0, (3.0, 0.0, 5.0)), seconds=8.0),
    "auto, backwards": mission(
        Item(MavCmd.DO_SET_REVERSE, None, 0.0, (1,)), Item(MavCmd.NAV_WAYPOINT, (-20.0, 5.0)), seconds=6.0
    ),
    "auto, heading": mission(Item(MavCmd.NAV_SET_YAW_SPEED, None, 0.0, (90.0, 0.2, 0.0)), seconds=1.0),
    "auto, delay": mission(Item(MavCmd.NAV_DELAY, None, 0.0, (9.0, -1, -1, -1)), seconds=1.0),
    "without gps": without_gps,
    "motor test": motor_test,
}


MARKS = {"erle_rover_small": [pytest.mark.slow], "ardupilot_rover": [pytest.mark.slow]}


@pytest.mark.parametrize("frame", [pytest.param(name, marks=MARKS.get(name, [])) for name in rover.AIRFRAMES])
@pytest.mark.parametrize("phase", PHASES)
def test_bits_are_the_same(core: Core, frame: str, phase: str) -> None:
    d = Driver(core, frame, seed=4).armed_in()
    PHASES[phase](d)
    compiled, plain = d.simulation.fleet.copy(), d.simulation.fleet.copy()
    core(compiled, 0, TICKS)
    Core(core.kind, None)(plain, 0, TICKS)
    assert int(compiled["tick"][0]) == int(plain["tick"][0]) > int(d.simulation.fleet["tick"][0])
    assert records.first_difference(compiled[0], plain[0]) is None
