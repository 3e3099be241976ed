# SPDX-License-Identifier: BSD-3-Clause
"""FLOWHOLD, flown; values of a real ArduPilot with its own simulator, at 10 m, are named."""

from __future__ import annotations

import math

import pytest

from sitl.simulation import Core
from tests.flights.aviator import ALT_HOLD, Aviator

FLOWHOLD = 22
FLOW: dict[str, float] = {"FLOW_TYPE": 10, "SIM_FLOW_ENABLE": 1}
FORWARD = 1300


def hold(core: Core, frame: str = "erle_copter", **params: float) -> Aviator:
    """A copter that has flown by GPS to 10 m, and then holds by flow alone."""
    p = Aviator(core, frame, **{**FLOW, **params}).hover()
    assert p.set_mode(ALT_HOLD)
    p.sticks(0.5)
    assert p.set_mode(FLOWHOLD)
    return p


def test_it_is_refused_without_a_sensor(core: Core) -> None:
    p = Aviator(core, FLOW_TYPE=10)
    p.ready()
    assert not p.set_mode(FLOWHOLD) and p.said("Mode change to FLOWHOLD failed: init failed")


def test_it_holds_in_still_air(core: Core) -> None:
    """The real one moves 0.4 m in 20 s."""
    p = hold(core)
    before = p.pos
    p.sticks(20.0)
    assert math.dist(p.pos[:2], before[:2]) < 1.0
    assert abs(p.height - 10.0) < 0.5


def test_it_needs_no_gps(core: Core) -> None:
    p = hold(core)
    p.set_parameter("SIM_GPS1_ENABLE", 0)
    before = p.pos
    p.sticks(30.0)
    assert p.mode == FLOWHOLD, "no failsafe ends it"
    assert math.dist(p.pos[:2], before[:2]) < 1.5


@pytest.mark.parametrize("gain", [0.3, 0.0])
def test_it_learns_the_lean_against_wind(core: Core, gain: float) -> None:
    """Without FHLD_XY_I the wind of 5 m/s pushes it away for good."""
    p = hold(core, FHLD_XY_I=gain, SIM_WIND_SPD=5, SIM_WIND_DIR=90)
    p.sticks(20.0)
    before = p.pos
    p.sticks(20.0)
    moved = math.dist(p.pos[:2], before[:2])
    assert moved < 1.5 if gain > 0.0 else moved > 3.0


def test_sticks_lean_it_and_it_brakes(core: Core) -> None:
    """The real one goes 10 m in 5 s, then at 2.9 m/s, and stops within 3.1 m."""
    p = hold(core, "ardupilot_quad")
    p.sticks(5.0)
    before = p.pos
    p.sticks(5.0, pitch=FORWARD)
    speed, let_go = math.hypot(*p.vel[:2]), p.pos
    assert 6.0 < math.dist(p.pos[:2], before[:2]) < 13.0 and 1.3 < speed < 3.5
    p.sticks(8.0)
    assert math.dist(p.pos[:2], let_go[:2]) < 3.2 and math.hypot(*p.vel[:2]) < 0.5


def test_flow_of_poor_quality_is_not_believed(core: Core) -> None:
    """The sensor tells 51: with FHLD_QUAL_MIN above it the wind takes the vehicle along."""
    p = hold(core, FHLD_QUAL_MIN=60, SIM_WIND_SPD=5, SIM_WIND_DIR=90)
    before = p.pos
    p.sticks(15.0)
    assert math.dist(p.pos[:2], before[:2]) > 5.0
