# SPDX-License-Identifier: BSD-3-Clause
"""The compiled core and the same functions as plain Python give the same bits, in every mode and phase of flight."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from benchmarks.recorded.pilot import VELOCITY_ONLY
from sitl.core import records
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import (
    ACRO,
    ALT_HOLD,
    AUTO,
    BRAKE,
    CIRCLE,
    DRIFT,
    GUIDED,
    LAND,
    LOITER,
    POSHOLD,
    RTL,
    SMART_RTL,
    STABILIZE,
    THROW,
    ZIGZAG,
    Aviator,
    Item,
)

TICKS = 60


def by_sticks(mode: int) -> Callable[[Aviator], None]:
    def fly(p: Aviator) -> None:
        p.sticks(0.5)
        p.set_mode(mode)
        p.sticks(1.0, roll=1700, pitch=1400, throttle=1600, yaw=1550)

    return fly


def then(mode: int, seconds: float) -> Callable[[Aviator], None]:
    def fly(p: Aviator) -> None:
        for _ in range(20):
            p.setpoint(VELOCITY_ONLY, velocity=(4.0, 1.0, -0.5))
            p.fly(0.1)
        p.set_mode(mode)
        p.fly(seconds)

    return fly


def mission(*items: Item, seconds: float) -> Callable[[Aviator], None]:
    def fly(p: Aviator) -> None:
        assert p.upload(Item(MavCmd.NAV_TAKEOFF, z=10.0), *items) == 0
        p.set_mode(AUTO)
        p.fly(seconds)
        assert p.mode == AUTO

    return fly


def attitude(p: Aviator) -> None:
    p.send("SET_ATTITUDE_TARGET", type_mask=7, q=(0.98, 0.1, -0.15, 0.05), thrust=0.55)
    p.fly(0.3)


def zigzag(p: Aviator) -> None:
    p.sticks(0.5)
    p.set_mode(ZIGZAG)
    p.ask(218, 61, 0)
    p.sticks(3.0, roll=1800)
    p.ask(218, 61, 2)
    p.ask(218, 61, 0)
    p.fly(1.0)
    assert p.ap.modes.zigzag.stage == 2


def thrown(p: Aviator) -> None:
    p.set_mode(LAND)
    p.wait_disarmed(60.0)
    p.set_mode(THROW)
    p.arm(3.0)
    p.set_parameter("SIM_SHOVE_Z", -30.0)
    p.send("PARAM_SET", param_id=b"SIM_SHOVE_TIME", param_value=500.0, param_type=9)
    assert p.fly(4.0, lambda: p.ap.modes.throw.stage == 4)


def in_wind(p: Aviator) -> None:
    p.set_parameter("SIM_WIND_SPD", 6.0)
    p.set_parameter("SIM_WIND_TURB", 1.5)
    p.fly(2.0)


CORNER = (Item(MavCmd.NAV_WAYPOINT, (15.0, 0.0), 10.0), Item(MavCmd.NAV_WAYPOINT, (15.0, 15.0), 12.0))
PHASES: dict[str, Callable[[Aviator], None]] = {
    "stabilize": by_sticks(STABILIZE),
    "alt_hold": by_sticks(ALT_HOLD),
    "loiter": by_sticks(LOITER),
    "acro": by_sticks(ACRO),
    "poshold": by_sticks(POSHOLD),
    "drift": by_sticks(DRIFT),
    "circle": then(CIRCLE, 2.0),
    "poshold, braking": then(POSHOLD, 1.0),
    "zigzag": zigzag,
    "thrown": thrown,
    "brake": then(BRAKE, 0.5),
    "rtl, on the way": then(RTL, 3.0),
    "smart_rtl, on the way": then(SMART_RTL, 2.0),
    "land, descending": then(LAND, 2.0),
    "land, touching down": then(LAND, 22.6),
    "guided, velocity": then(GUIDED, 0.2),
    "guided, attitude": attitude,
    "guided, in wind": in_wind,
    "auto, at a corner": mission(*CORNER, seconds=5.0),
    "auto, circling": mission(Item(MavCmd.NAV_LOITER_TURNS, (0.0, 0.0), 10.0, (3.0, 0.0, 5.0)), seconds=8.0),
}


@pytest.mark.parametrize("frame", ["erle_copter", "ardupilot_quad"])
@pytest.mark.parametrize("phase", PHASES)
def test_bits_are_the_same(core: Core, frame: str, phase: str) -> None:
    p = Aviator(core, frame, seed=4).hover()
    PHASES[phase](p)
    compiled, plain = p.simulation.fleet.copy(), p.simulation.fleet.copy()
    core(compiled, 0, TICKS)
    Core(core.kind, None)(plain, 0, TICKS)
    assert int(compiled["tick"][0]) == int(plain["tick"][0]) > int(p.simulation.fleet["tick"][0])
    assert records.first_difference(compiled[0], plain[0]) is None
