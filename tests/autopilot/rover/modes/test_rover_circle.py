# SPDX-License-Identifier: BSD-3-Clause
"""CIRCLE of the rover: it begins at rest at its edge, and is no faster than its turn allows."""

from __future__ import annotations

import pytest

from sitl.autopilot.rover.modes import circle
from sitl.autopilot.rover.modes.circle import CIRCLE_ADAPTED
from sitl.core.vectors import Vec2
from tests.autopilot.rover.modes.driven_rover import Rover


def test_a_second_circle_begins_at_rest_whatever_the_first_one_did() -> None:
    rover = Rover()
    state = rover.ap.modes.circle
    state.target_speed, state.total, state.at_edge, state.waiting = 3.0, 7.0, True, True
    wanted = circle.Circuit(centre=Vec2(0.0, 0.0), radius=20.0, direction=1.0, angle=0.5)
    circle.set_up(state, wanted, rover.ap.events, int(rover.v.time_us), rover.ap.params)
    assert (state.target_speed, state.total, bool(state.at_edge), bool(state.waiting)) == (0.0, 0.0, False, False)
    assert tuple(state.target) == tuple(circle.edge(state))


@pytest.mark.parametrize(("wanted", "adapted"), ((5.9, False), (6.0, False), (6.1, True)))
def test_a_speed_beyond_what_the_turn_allows_is_lowered_and_told(wanted: float, adapted: bool) -> None:
    rover = Rover()
    state = rover.ap.modes.circle
    state.radius = 9.0
    rover.events()
    circle.set_speed(state, rover.ap.events, int(rover.v.time_us), wanted, 4.0)  # sqrt(9 m 4 m/s^2) = 6 m/s
    assert state.speed == pytest.approx(min(wanted, 6.0))
    assert [code for code, _, _ in rover.events()].count(int(CIRCLE_ADAPTED)) == int(adapted)
