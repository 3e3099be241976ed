# SPDX-License-Identifier: BSD-3-Clause
"""The pilot who brings a Betaflight to its height by rates and thrust: which way it leans, climbs and turns."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from sitl.core.constants import GRAVITY
from sitl.envs.mavlink.betaflight import Hold

SECONDS = 0.01


def rates(
    goal: Any = 3 * (0.0,), velocity: Any = 3 * (0.0,), angles: Any = 3 * (0.0,), heading: float = 0.0
) -> tuple[float, float, float, float]:  # fmt: skip
    """Roll, pitch and yaw rate, thrust."""
    inbox: Any = SimpleNamespace(position=(0, 0.0, 0.0, 0.0, *velocity), attitude=(0, *angles, 0.0, 0.0, 0.0))
    return Hold(goal, heading).act(inbox, SECONDS)


def test_where_it_is_to_be_it_stays() -> None:
    assert rates() == (0.0, 0.0, 0.0, 0.45)


@pytest.mark.parametrize(
    ("goal", "yaw", "roll", "pitch"),
    [
        ((1.0, 0.0, 0.0), 0.0, 0, -1),  # nose down to go ahead
        ((-1.0, 0.0, 0.0), 0.0, 0, 1),
        ((0.0, 1.0, 0.0), 0.0, 1, 0),  # right wing down to go right
        ((0.0, -1.0, 0.0), 0.0, -1, 0),
        ((1.0, 0.0, 0.0), math.pi / 2, -1, 0),  # north is on its left
        ((0.0, 1.0, 0.0), math.pi / 2, 0, -1),
        ((1.0, 0.0, 0.0), math.pi, 0, 1),
    ],
)
def test_it_leans_to_where_it_is_to_be(goal: Any, yaw: float, roll: int, pitch: int) -> None:
    """A metre away it is to be 1.2 m/s fast, for which it pushes with 2.4 m/s^2."""
    found = rates(goal=goal, angles=(0.0, 0.0, yaw), heading=yaw)
    lean = 5.0 * 2.4 / GRAVITY
    assert found[:3] == pytest.approx((roll * lean, pitch * lean, 0.0), abs=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize(("axis", "sign"), [(0, -1), (1, 1)])
def test_far_away_it_flies_one_and_a_half_metres_a_second_and_leans_no_more_than_20_degrees(
    axis: int, sign: int, way: float
) -> None:
    other = 1 - axis  # north by pitch, east by roll

    def found(speed: float) -> tuple[float, ...]:
        """Rates at a speed towards a goal that is 50 m away."""
        velocity, goal = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        velocity[axis], goal[axis] = way * speed, way * 50.0
        return rates(goal=goal, velocity=velocity)

    assert found(1.5)[:2] == (0.0, 0.0)
    assert found(0.0)[other] == pytest.approx(way * sign * 5.0 * 3.0 / GRAVITY)
    assert found(-50.0)[other] == pytest.approx(way * sign * 5.0 * 0.35)
    assert found(50.0)[other] == pytest.approx(-way * sign * 5.0 * 0.35)


def test_a_lean_that_is_reached_is_kept() -> None:
    lean = 2.4 / GRAVITY
    assert rates(goal=(1.0, 0.0, 0.0), angles=(0.0, -lean, 0.0))[:2] == pytest.approx((0.0, 0.0))
    assert rates(goal=(0.0, 1.0, 0.0), angles=(lean, 0.0, 0.0))[:2] == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize(("heading", "yaw", "turn"), [(0.2, 0.0, 0.2), (0.0, 0.2, -0.2), (3.0, -3.0, 6.0 - math.tau)])
def test_it_turns_the_short_way(heading: float, yaw: float, turn: float) -> None:
    assert rates(heading=heading, angles=(0.0, 0.0, yaw))[2] == pytest.approx(1.5 * turn)


def test_thrust_is_more_to_climb_and_where_it_leans() -> None:
    hover = rates()[3]
    up = rates(goal=(0.0, 0.0, -1.0))[3]
    assert up == pytest.approx((0.45 + 0.03 * SECONDS) * (1.0 + 2.4 / GRAVITY))
    assert rates(goal=(0.0, 0.0, 1.0))[3] == pytest.approx((0.45 - 0.03 * SECONDS) * (1.0 - 2.4 / GRAVITY))
    assert rates(velocity=(0.0, 0.0, 1.0))[3] > hover > rates(velocity=(0.0, 0.0, -1.0))[3]
    assert rates(angles=(0.3, 0.4, 0.0))[3] == pytest.approx(hover / (math.cos(0.3) * math.cos(0.4)))
    assert rates(angles=(math.pi, 0.0, 0.0))[3] == pytest.approx(2.0 * hover), "upside down it is no more than twice"
    assert rates(velocity=(0.0, 0.0, 50.0))[3] == 1.0 and rates(velocity=(0.0, 0.0, -50.0))[3] == 0.0


@pytest.mark.parametrize(("goal", "limit"), [(-100.0, 0.95), (100.0, 0.05)])
def test_thrust_in_hover_is_found_within_limits(goal: float, limit: float) -> None:
    hold = Hold((0.0, 0.0, goal), 0.0)
    inbox: Any = SimpleNamespace(position=(0, *6 * (0.0,)), attitude=(0, *6 * (0.0,)))
    for _ in range(100):
        thrust = hold.act(inbox, 1.0)[3]
    speed = math.copysign(1.5, goal)
    assert thrust == pytest.approx(min(limit * (1.0 - 2.0 * speed / GRAVITY), 1.0))
