# SPDX-License-Identifier: BSD-3-Clause
"""Copters keep away from walls that their lidar sees, and from fences."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from sitl import Simulation
from sitl.client import Client
from sitl.worlds import Box, Start, World, contact

MARGIN = 2.0
WALL = World("wall", (Box((14.0, 0.0, 2.0), (0.2, 60.0, 4.0)),), (Start("here", (0.0, 0.0, 0.0), 0.0),))
"""Its near side is 13.9 m north of the start."""
NEAR_SIDE = 13.9
INSTANT = {"PRX1_TYPE": 10, "PRX_FILT": 0}


def clearance(simulation: Simulation) -> float:
    """Of the vehicle's outline to the nearest solid [m]."""
    assert simulation.world is not None
    a, (n, e, d) = simulation.v.physics.airframe, simulation.v.physics.body.pos
    return contact.clearance(simulation.world.geometry, n, e, d - a.contact_top, d, a.contact_radius).distance


def in_the_air(altitude: float, world: World | str | None = None, **params: float) -> Client:
    values = {**INSTANT, **params} if world is not None else params
    pilot = Client(Simulation("erle_copter", world=world, seed=3, estimator="truth", params=values))
    pilot.wait_ready()
    pilot.take_off(altitude)
    pilot.rc(throttle=1500)
    return pilot


def north(pilot: Client) -> float:
    return float(pilot.simulation.v.physics.body.pos.x)


def steps(pilot: Client, seconds: float) -> Iterator[float]:
    """Where it is, ten times a second [m north]."""
    for _ in range(round(10 * seconds)):
        pilot.delay(0.1)
        yield north(pilot)


@pytest.mark.parametrize("behave", [0, 1], ids=["slide", "stop"])
def test_the_stick_does_not_push_a_loitering_copter_into_a_wall(behave: int) -> None:
    pilot = in_the_air(1.5, WALL, AVOID_BEHAVE=behave)
    pilot.set_mode("LOITER")
    pilot.rc(pitch=1350)
    places = list(steps(pilot, 30.0))
    assert pilot.simulation.v.physics.obstacles.hit_count == 0
    assert max(places) < NEAR_SIDE - MARGIN + 0.35 + 0.2  # the sectors' middle is nearer than their edges
    assert min(places[-50:]) > NEAR_SIDE - MARGIN - 1.2
    assert abs(pilot.velocity[0]) < 0.3


def test_without_avoidance_the_same_stick_does() -> None:
    pilot = in_the_air(1.5, WALL, AVOID_ENABLE=1)
    pilot.set_mode("LOITER")
    pilot.rc(pitch=1350)
    pilot.delay(15.0)
    assert pilot.simulation.v.physics.obstacles.hit_count > 0


def test_a_velocity_slides_along_a_wall_or_stops_before_it() -> None:
    ends = {}
    for behave in (0, 1):
        pilot = in_the_air(1.5, WALL, AVOID_BEHAVE=behave)
        pilot.set_velocity(2.0, 0.5, 0.0, yaw=0.0)  # sectors are walls across the nose
        pilot.delay(25.0)
        assert pilot.simulation.v.physics.obstacles.hit_count == 0
        ends[behave] = pilot.position
    assert ends[0][1] > ends[1][1] + 3.0  # it went on east
    assert max(ends[0][0], ends[1][0]) < NEAR_SIDE - 1.4


def test_a_switch_ends_it_and_begins_it_again() -> None:
    pilot = in_the_air(1.5, WALL, RC9_OPTION=40)
    pilot.rc({9: 1000})
    pilot.delay(1.0)
    pilot.set_velocity(1.0, 0.0, 0.0)
    pilot.wait(lambda t: north(pilot) > NEAR_SIDE - 1.0, timeout=25.0, what="into the margin")
    pilot.rc({9: 2000})
    pilot.set_velocity(0.0, 0.0, 0.0)
    pilot.delay(6.0)  # it backs out
    assert north(pilot) < NEAR_SIDE - 1.5
    assert any("AvoidProximity HIGH" in text.text for text in pilot.texts)


def test_alt_hold_leans_away_from_a_wall() -> None:
    pilot = in_the_air(1.5, WALL)
    pilot.set_velocity(1.0, 0.0, 0.0)
    pilot.wait(lambda t: north(pilot) > NEAR_SIDE - 3.5, timeout=25.0, what="near the wall")
    pilot.set_mode("ALT_HOLD")
    leans = []
    for _ in range(10):
        pilot.delay(0.1)
        leans.append(pilot.attitude[1])
    assert math.degrees(max(leans)) == pytest.approx(10.0 * (1.0 - 3.0 / 5.0), abs=3.0)  # nose up
    pilot.delay(4.0)
    assert north(pilot) < NEAR_SIDE - 3.0


def test_a_copter_in_the_office_stops_before_every_wall() -> None:
    pilot = in_the_air(1.15, "office_erlecopter", AVOID_MARGIN=0.6)
    pilot.set_mode("LOITER")
    rooms = []
    for pitch, roll in ((1400, 1500), (1500, 1600), (1500, 1400), (1420, 1540)):  # its lidar does not see behind it
        pilot.rc(pitch=pitch, roll=roll)
        pilot.delay(12.0)
        rooms.append(clearance(pilot.simulation))
    assert pilot.simulation.v.physics.obstacles.hit_count == 0
    assert min(rooms) > 0.0


@pytest.mark.parametrize("behave", [0, 1], ids=["slide", "stop"])
def test_a_circle_around_home_is_not_left(behave: int) -> None:
    params = {"FENCE_TYPE": 2, "FENCE_RADIUS": 15, "FENCE_MARGIN": 3, "AVOID_ENABLE": 1, "AVOID_BEHAVE": behave}
    pilot = in_the_air(10.0, FENCE_ENABLE=1, **params)
    pilot.set_mode("LOITER")
    pilot.rc(pitch=1400, roll=1430)
    with pilot.always(lambda: math.hypot(*pilot.position[:2]) < 13.0, "stays a metre around the margin"):
        pilot.delay(40.0)
    assert math.hypot(*pilot.position[:2]) > 11.0
    assert pilot.mode == "LOITER"


def test_a_ceiling_is_not_climbed_through_and_a_lower_one_is_gone_below() -> None:
    pilot = in_the_air(10.0, FENCE_TYPE=1, FENCE_ALT_MAX=30, FENCE_ACTION=0, FENCE_ENABLE=1)
    pilot.set_mode("LOITER")
    pilot.rc(throttle=1900)
    with pilot.always(lambda: pilot.altitude < 28.6, "stays below the margin"):
        pilot.delay(30.0)
    assert pilot.altitude > 27.0
    pilot.params["FENCE_ALT_MAX"] = 20
    with pilot.always(lambda: pilot.climb_rate > -0.75 * 1.1, "sinks no faster than AVOID_BACKZ_SPD"):
        pilot.wait_altitude(17.0, 18.5, timeout=30.0)
    pilot.delay(5.0)
    assert pilot.altitude == pytest.approx(18.0, abs=0.5)
