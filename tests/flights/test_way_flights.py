# SPDX-License-Identifier: BSD-3-Clause
"""Copters go around areas of a fence and around what is seen (OA_TYPE), in missions and on the way home."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl import Simulation
from sitl.autopilot.avoidance.shortest_path import Map
from sitl.client import Client
from sitl.worlds import Box, Start, World

BLOCK = ((40.0, -8.0), (40.0, 12.0), (60.0, 12.0), (60.0, -8.0))
"""Corners of an area to stay out of, across the way north [m]."""
POST = World("post", (Box((25.0, 0.0, 10.0), (1.0, 1.0, 20.0)),), (Start("here", (0.0, 0.0, 0.0), 0.0),))
ALTITUDE = 10.0


def in_the_air(world: World | None = None, **params: float) -> Client:
    frame = "erle_copter" if world is not None else "ardupilot_quad"
    values = {"AVOID_ENABLE": 0, "FENCE_ACTION": 0, "FENCE_TYPE": 4, **params}
    pilot = Client(Simulation(frame, world=world, seed=2, estimator="truth", params=values))
    return pilot


def block(pilot: Client) -> None:
    pilot.wait_ready()
    pilot.upload_fence([
        pilot.item("NAV_FENCE_POLYGON_VERTEX_EXCLUSION", *corner, param1=len(BLOCK)) for corner in BLOCK
    ])  # fmt: skip
    pilot.params["FENCE_ENABLE"] = 1


def fly_mission(pilot: Client, *places: tuple[float, float]) -> None:
    pilot.wait_ready()
    pilot.take_off(ALTITUDE)
    pilot.rc(throttle=1500)
    ways = [pilot.item("NAV_WAYPOINT", *place, ALTITUDE) for place in places]
    pilot.upload([pilot.item("NAV_WAYPOINT"), *ways, pilot.item("NAV_RETURN_TO_LAUNCH")])
    pilot.set_mode("AUTO")


def path_to(
    pilot: Client, north: float, east: float, seconds: float
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Where it was on the way to a place, five times a second [m]."""
    places = []
    for _ in range(round(5 * seconds)):
        pilot.delay(0.2)
        n, e, _ = pilot.position
        places.append((n, e))
        if math.hypot(n - north, e - east) < 2.5:
            return np.array(places)
    raise AssertionError(f"not at {north}, {east} after {seconds} s, but at {pilot.position}")


def room(pilot: Client, places: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    """The least distance to the areas [m]; below 0: within one."""
    return float(Map(pilot.simulation.v.autopilot.fence, 5.0).clearance(places).min())


@pytest.mark.parametrize(("kind", "least", "seconds"), [(1, 4.0, 25.4), (2, 4.5, 21.0)], ids=["BendyRuler", "Dijkstra"])
def test_a_mission_and_its_return_go_around_a_block(kind: int, least: float, seconds: float) -> None:
    """A real ArduPilot comes as near as 1.6 m and 3.5 m, and takes 30 s and 33 s (docs/avoidance.md)."""
    pilot = in_the_air(OA_TYPE=kind)
    block(pilot)
    fly_mission(pilot, (100.0, 0.0))
    out = path_to(pilot, 100.0, 0.0, 60.0)
    assert room(pilot, out) > least
    assert len(out) / 5.0 == pytest.approx(seconds, abs=2.0)
    assert room(pilot, path_to(pilot, 0.0, 0.0, 90.0)) > least
    assert pilot.altitude == pytest.approx(15.0, abs=2.0)


def test_without_a_type_the_mission_goes_through() -> None:
    pilot = in_the_air(OA_TYPE=0)
    block(pilot)
    fly_mission(pilot, (100.0, 0.0))
    assert room(pilot, path_to(pilot, 100.0, 0.0, 60.0)) < 0.0


@pytest.mark.parametrize("kind", [0, 1, 3])
def test_a_post_that_the_lidar_sees_is_flown_around(kind: int) -> None:
    seen = {"PRX1_TYPE": 10, "OA_MARGIN_MAX": 2.0, "OA_BR_LOOKAHEAD": 8.0, "WPNAV_SPEED": 150}
    pilot = in_the_air(POST, OA_TYPE=kind, **seen)
    fly_mission(pilot, (40.0, 0.0))
    if kind == 0:
        pilot.delay(30.0)
        assert pilot.simulation.v.physics.obstacles.hit_count > 0
        return
    out = path_to(pilot, 40.0, 0.0, 120.0)
    assert np.hypot(out[:, 0] - 25.0, out[:, 1]).min() > 2.0
    assert pilot.simulation.v.physics.obstacles.hit_count == 0


def see(pilot: Client, readings: list[tuple[float, float]]) -> None:
    """OBSTACLE_DISTANCE with some bearings from the nose [deg] and distances [m]."""
    distances = [65535] * 72
    for bearing, away in readings:
        if away < 20.0:
            distances[round(bearing / 5.0) % 72] = round(100.0 * away)
    pilot.send("OBSTACLE_DISTANCE", increment=5, min_distance=20, max_distance=2000, distances=distances, frame=12)


def test_what_a_companion_computer_sees_is_flown_around() -> None:
    pilot = in_the_air(OA_TYPE=1, PRX1_TYPE=2, WPNAV_SPEED=300)
    for _ in range(250):
        see(pilot, [])
        pilot.delay(0.2)
    fly_mission(pilot, (80.0, 0.0))
    least = math.inf
    for _ in range(500):
        north, east, _ = pilot.position
        away, bearing = math.hypot(40.0 - north, east), math.degrees(math.atan2(-east, 40.0 - north)) - pilot.heading
        least = min(least, away)
        see(pilot, [(bearing, away)])
        pilot.delay(0.2)
        if math.hypot(80.0 - north, east) < 2.5:
            break
    assert math.hypot(80.0 - pilot.position[0], pilot.position[1]) < 5.0
    assert 4.0 < least < 15.0
