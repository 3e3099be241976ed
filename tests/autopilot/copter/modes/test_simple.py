# SPDX-License-Identifier: BSD-3-Clause
"""SIMPLE and SUPER_SIMPLE: where the sticks point."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.copter.modes import mode_list, simple
from sitl.autopilot.copter.modes.acro import ACRO
from sitl.autopilot.copter.modes.circle import CIRCLE
from sitl.autopilot.copter.modes.flip import FLIP
from sitl.autopilot.copter.modes.state import PilotState, SimpleState
from sitl.autopilot.copter.parameters import TABLE
from sitl.core.vectors import Vec3

EAST = math.radians(90.0)


@pytest.mark.parametrize(
    ("number", "roll", "pitch"),
    [(simple.OFF, 0.0, -1.0), (simple.SIMPLE, -1.0, 0.0), (simple.SUPER_SIMPLE, 0.0, 1.0)],
)
def test_sticks_count_from_another_heading(number: int, roll: float, pitch: float) -> None:
    """The nose points east, the stick forwards; it was armed heading north, and home is east of it."""
    state, pilot = SimpleState(), PilotState()
    simple.begin(state, 0.0)
    simple.look_from_home(state, Vec3(0.0, -11.0, -5.0), Vec3(0.0, 0.0, 0.0))
    state.number = number
    pilot.pitch = -1.0
    simple.turn_sticks(pilot, state, EAST)
    assert (pilot.roll, pilot.pitch) == pytest.approx((roll, pitch), abs=1e-12)


def test_near_home_the_heading_from_home_stays() -> None:
    state = SimpleState()
    simple.begin(state, EAST)
    simple.look_from_home(state, Vec3(9.9, 0.0, -50.0), Vec3(0.0, 0.0, 0.0))
    assert state.heading_from_home == EAST
    simple.look_from_home(state, Vec3(10.1, 0.0, -50.0), Vec3(0.0, 0.0, 0.0))
    assert state.heading_from_home == 0.0


@pytest.mark.parametrize(("position", "number"), [(0, simple.SIMPLE), (1, simple.SUPER_SIMPLE), (2, 2), (3, 0)])
def test_bits_of_the_mode_switch(position: int, number: int) -> None:
    params = TABLE.record()
    params["SIMPLE"], params["SUPER_SIMPLE"] = 0b000101, 0b000110
    assert simple.of_position(position, params) == number


def test_acro_circle_and_flip_fly_by_the_nose() -> None:
    assert [number for number in mode_list.ALL if mode_list.ignores_simple(number)] == [ACRO, CIRCLE, FLIP]
