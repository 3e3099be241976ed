# SPDX-License-Identifier: BSD-3-Clause
"""Flights by optical flow, without GPS; values of a real ArduPilot with its own simulator are named."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.autopilot.estimation.status import CONST_POS_MODE, POS_HORIZ_ABS, POS_HORIZ_REL, POS_VERT_AGL, VELOCITY_HORIZ
from sitl.simulation import Core
from tests.flights.aviator import ALT_HOLD, GUIDED, LAND, LOITER, POSITION, RTL, STABILIZE, Aviator, target
from tests.pilots.witness import KEEP, LOW, MIDDLE

FLOW: dict[str, float] = {
    "EK3_SRC1_POSXY": 0, "EK3_SRC1_VELXY": 5, "EK3_SRC1_VELZ": 0, "FLOW_TYPE": 10, "SIM_FLOW_ENABLE": 1,
    "RNGFND1_TYPE": 100, "RNGFND1_MIN": 0, "RNGFND1_MAX": 40, "GPS1_TYPE": 0,
}  # fmt: skip
SET_SOURCES, DENIED = 42007, 2


def give_origin(p: Aviator) -> None:
    """SET_GPS_GLOBAL_ORIGIN: where it stands."""
    place = p.simulation.v.physics.origin
    p.send("SET_GPS_GLOBAL_ORIGIN", target_system=1, latitude=place.lat, longitude=place.lon, altitude=584_000)
    p.fly(1.0)


def flags(p: Aviator) -> int:
    """EKF_STATUS_FLAGS"""
    return int(p.ap.estimate.status_flags)


def hover(core: Core, **params: float) -> Aviator:
    """A copter that hovers at 10 m by optical flow."""
    p = Aviator(core, **{**FLOW, **params})
    p.fly(30.0)
    give_origin(p)
    assert p.set_mode(GUIDED)
    p.arm()
    p.take_off(10.0)
    return p


def test_a_position_relative_to_the_start(core: Core) -> None:
    """Flags and texts as the real one has them: 367 some five seconds after boot; modes arm when there is an origin."""
    p = Aviator(core, **FLOW)
    p.fly(10.0)
    assert flags(p) == 367
    assert p.said("EKF3 IMU0 fusing optical flow") and p.said("EKF3 IMU0 started relative aiding")
    p.fly(20.0)
    assert p.set_mode(LOITER)
    assert p.ask(ARM, 1) == 4 and p.said("Arm: AHRS: waiting for home")
    give_origin(p)
    assert p.said("EKF3 IMU0 origin set") and flags(p) == 367
    assert p.ask(ARM, 1) == 0


def test_a_receiver_that_should_be_there_is_missed(core: Core) -> None:
    p = Aviator(core, **{**FLOW, "GPS1_TYPE": 1, "SIM_GPS1_ENABLE": 0})
    p.fly(30.0)
    assert p.set_mode(LOITER)
    assert p.ask(ARM, 1) == 4 and p.said("Arm: GPS 1: Bad fix")
    p.set_parameter("ARMING_CHECK", 786390)  # all but GPS
    assert p.ask(ARM, 1) == 0, "without an origin, too"


def test_without_a_range_finder_there_is_no_position(core: Core) -> None:
    p = Aviator(core, **{**FLOW, "RNGFND1_TYPE": 0})
    p.fly(30.0)
    give_origin(p)
    assert flags(p) & CONST_POS_MODE and not flags(p) & (POS_HORIZ_REL | POS_VERT_AGL)
    assert p.set_mode(LOITER)
    assert p.ask(ARM, 1) == 4 and p.said("Arm: Need Position Estimate")


def test_it_holds_its_place_for_a_minute(core: Core) -> None:
    """The real one drifts 1.4 m in that minute at 10 m."""
    p = hover(core)
    before = p.pos
    p.fly(60.0)
    drift = math.dist(p.pos[:2], before[:2])
    assert 0.02 < drift < 1.5, "a drift there is: nothing shows the place"
    assert np.abs(np.array(p.ap.estimate.pos)[:2]).max() < 0.6, "the autopilot believes that it stays (real: 0.4 m)"


def test_a_square_and_the_way_home(core: Core) -> None:
    """The real one ends 1.5 m off after a square of 10 m, and lands 2 m from home."""
    p = hover(core)
    for north, east in ((10, 0), (10, 10), (0, 10), (0, 0)):
        target(p, POSITION, 1, x=north, y=east, z=-10)
        p.fly(12.0)
        assert math.dist(p.pos[:2], (north, east)) < 1.5
    assert p.set_mode(RTL)
    assert p.fly(60.0, lambda: not p.ap.arming.armed)
    assert math.hypot(*p.pos[:2]) < 2.0


@pytest.mark.parametrize("scaler", [-200.0, 200.0])
def test_a_wrong_scale_is_a_wrong_way(core: Core, scaler: float) -> None:
    """FLOW_FXSCALER is about the roll axis: sideways flights are too long or too short by that share."""
    p = hover(core, FLOW_FXSCALER=scaler, FLOW_FYSCALER=scaler)
    target(p, POSITION, 1, x=0, y=20, z=-10)
    p.fly(20.0)
    assert p.pos[1] == pytest.approx(20.0 / (1.0 + 0.001 * scaler), rel=0.08)


def test_flow_is_lost_in_flight(core: Core) -> None:
    """As the real one: relative position gone after 1 s, LAND after 2 s, no aiding after 5 s, down at 0.5 m/s."""
    p = hover(core)
    assert p.set_mode(LOITER)
    p.sticks(2.0)
    p.set_parameter("SIM_FLOW_ENABLE", 0)
    began = p.now
    assert p.fly(3.0, lambda: not flags(p) & POS_HORIZ_REL)
    assert p.now - began == pytest.approx(1.0, abs=0.2) and flags(p) & VELOCITY_HORIZ
    assert p.fly(3.0, lambda: p.mode == LAND)
    assert p.now - began == pytest.approx(2.0, abs=0.3)
    assert p.fly(5.0, lambda: bool(flags(p) & CONST_POS_MODE))
    assert p.now - began == pytest.approx(5.0, abs=0.2) and p.said("EKF3 IMU0 stopped aiding")
    assert p.fly(60.0, lambda: not p.ap.arming.armed)


def test_flow_fails_on_demand(core: Core) -> None:
    p = hover(core)
    assert p.set_mode(LOITER)
    p.sticks(2.0)
    down = p.simulation.v.physics.downward
    for fault, wanted in (("optical_flow/garbage=2", (40, 0, 2.0)), ("optical_flow/delayed=0.05", (40, 20, 0.05))):
        p.simulation.fail(fault)
        assert (down.flow_period, down.flow_delay, down.flow_noise) == pytest.approx(wanted)
        p.simulation.repair("optical_flow")
    p.simulation.fail("optical_flow@1..4")
    assert p.fly(3.0, lambda: not flags(p) & POS_HORIZ_REL)
    p.fly(4.0)
    assert flags(p) & POS_HORIZ_REL


TWO_SETS: dict[str, float] = {
    **FLOW, "EK3_SRC1_POSXY": 3, "EK3_SRC1_VELXY": 3, "EK3_SRC1_VELZ": 3, "EK3_SRC2_POSXY": 0, "EK3_SRC2_VELXY": 5,
    "EK3_SRC2_YAW": 1, "GPS1_TYPE": 1,
}  # fmt: skip
"""GPS first, optical flow second."""


def test_a_switch_chooses_the_set_of_sources(core: Core) -> None:
    """RCn_OPTION 90: low the first set, middle the second, high the third, which has none."""
    p = Aviator(core, **TWO_SETS, RC7_OPTION=90, RC_OVERRIDE_TIME=-1).hover()
    assert p.set_mode(LOITER)
    p.sticks(3.0)
    before = p.pos
    for pulse, number, wanted in ((MIDDLE, 2, POS_HORIZ_REL), (LOW, 1, POS_HORIZ_ABS), (2000, 3, CONST_POS_MODE)):
        p.override(*[KEEP] * 6, pulse)
        p.fly(1.0 if number != 1 else 5.0)
        assert p.said(f"Using EKF Source Set {number}"), p.texts[-3:]
        seen = flags(p) & (POS_HORIZ_REL | POS_HORIZ_ABS | CONST_POS_MODE)
        assert seen & wanted and bool(seen & POS_HORIZ_ABS) == (number == 1), (number, seen)
        assert math.dist(p.pos[:2], before[:2]) < 1.0


def test_from_gps_to_flow_and_back(core: Core) -> None:
    """Another set by a command in LOITER: no jump, flight goes on without the receiver, and with it again."""
    p = Aviator(core, **TWO_SETS).hover()
    assert flags(p) & POS_HORIZ_ABS
    assert p.set_mode(LOITER)
    p.sticks(3.0)
    before = p.pos
    assert p.ask(SET_SOURCES, 2) == 0 and p.ask(SET_SOURCES, 4) == DENIED
    p.fly(1.0)
    assert p.said("EKF3 IMU0 fusing optical flow") and flags(p) & POS_HORIZ_REL and not flags(p) & POS_HORIZ_ABS
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    p.fly(20.0)
    assert p.mode == LOITER and math.dist(p.pos[:2], before[:2]) < 1.0
    p.set_parameter("SIM_GPS1_ENABLE", 1)
    p.fly(5.0)
    assert p.ask(SET_SOURCES, 1) == 0
    p.fly(5.0)
    assert flags(p) & POS_HORIZ_ABS and p.mode == LOITER
    assert math.dist(p.pos[:2], p.ap.estimate.pos[:2]) < 0.5


def test_a_set_without_sources_holds_the_place(core: Core) -> None:
    p = Aviator(core, **FLOW)
    p.fly(10.0)
    assert p.ask(SET_SOURCES, 2) == 0
    p.fly(0.1)
    assert flags(p) & CONST_POS_MODE and p.said("EKF3 IMU0 stopped aiding")


def test_flow_of_a_companion(core: Core) -> None:
    """OPTICAL_FLOW messages (FLOW_TYPE 5): rates as they are, or counts times the time between messages."""
    p = Aviator(core, **{**FLOW, "FLOW_TYPE": 5, "SIM_FLOW_ENABLE": 0})
    p.fly(10.0)
    flow: Any = p.ap.flow
    for counts, rates, shown in (((0, 0), (0.1, 0.05), (0.1, 0.05)), ((10, 20), (0.1, 0.05), (1.0, 2.0))):
        for _ in range(20):
            p.send(
                "OPTICAL_FLOW",
                flow_x=counts[0],
                flow_y=counts[1],
                flow_rate_x=rates[0],
                flow_rate_y=rates[1],
                quality=77,
            )
            p.fly(0.1)
        assert tuple(flow.rate) == pytest.approx(shown, rel=0.03) and flow.quality == 77
    assert flow.count == 40
    assert p.set_mode(ALT_HOLD) and p.set_mode(STABILIZE)
