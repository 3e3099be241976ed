# SPDX-License-Identifier: BSD-3-Clause
"""Rovers go around the areas of a fence (OA_TYPE 1, 2): in missions, on the way home, and to positions in GUIDED."""

from __future__ import annotations

import numpy as np
import pytest

from sitl import Simulation
from sitl.autopilot.avoidance.shortest_path import Map
from sitl.client import Client
from sitl.worlds import Box, Start, World

MARGIN = 4.0
BLOCK = ((15.0, -12.0), (25.0, -12.0), (25.0, 20.0), (15.0, 20.0))
"""Corners of an area to stay out of, across the way north [m]."""
POST = World("post", (Box((20.0, 0.0, 1.0), (1.0, 1.0, 2.0)),), (Start("here", (0.0, 0.0, 0.0), 0.0),))
YARD = ((-20.0, -40.0), (60.0, -40.0), (60.0, 40.0), (-20.0, 40.0))
"""An area to stay in."""


def ready(**params: float) -> Client:
    values = {"OA_TYPE": 2, "OA_MARGIN_MAX": MARGIN, "FENCE_ACTION": 0, **params}
    driver = Client(Simulation("ardupilot_rover", seed=2, estimator="truth", params=values))
    driver.wait_ready()
    return driver


def upload(driver: Client, *areas: tuple[str, tuple[tuple[float, float], ...]]) -> None:
    driver.upload_fence([
        driver.item(f"NAV_FENCE_POLYGON_VERTEX_{kind}", *corner, param1=len(corners))
        for kind, corners in areas
        for corner in corners
    ])  # fmt: skip
    driver.params["FENCE_ENABLE"] = 1


def room_until(driver: Client, north: float, east: float, seconds: float) -> float:
    """The least distance to the areas on the way to a place [m]."""
    places = []
    for _ in range(round(5 * seconds)):
        driver.delay(0.2)
        n, e, _ = driver.position
        places.append((n, e))
        if np.hypot(n - north, e - east) < 2.5:
            return float(Map(driver.simulation.v.autopilot.fence, MARGIN).clearance(np.array(places)).min())
    raise AssertionError(f"not at {north}, {east} after {seconds} s, but at {driver.position}")


def test_a_mission_and_its_return_go_around_a_block() -> None:
    driver = ready()
    upload(driver, ("EXCLUSION", BLOCK), ("INCLUSION", YARD))
    home = driver.item("NAV_WAYPOINT")
    driver.upload([home, driver.item("NAV_WAYPOINT", 40.0, 0.0), driver.item("NAV_RETURN_TO_LAUNCH")])
    driver.start_mission()
    assert room_until(driver, 40.0, 0.0, 60.0) > MARGIN - 1.0
    assert room_until(driver, 0.0, 0.0, 60.0) > MARGIN - 1.0


def test_without_it_the_same_mission_goes_through() -> None:
    driver = ready(OA_TYPE=0, AVOID_ENABLE=0)
    upload(driver, ("EXCLUSION", BLOCK))
    driver.upload([driver.item("NAV_WAYPOINT"), driver.item("NAV_WAYPOINT", 40.0, 0.0)])
    driver.start_mission()
    assert room_until(driver, 40.0, 0.0, 60.0) < 0.0


def test_a_position_in_guided_is_driven_to_around_a_block_that_comes_late() -> None:
    driver = ready()
    driver.set_mode("GUIDED")
    driver.arm()
    driver.set_position(north=40.0, east=0.0)
    driver.delay(2.0)
    upload(driver, ("EXCLUSION", BLOCK))
    assert room_until(driver, 40.0, 0.0, 60.0) > MARGIN - 1.0


def test_where_there_is_no_way_it_stops_and_goes_on_when_there_is_one() -> None:
    driver = ready()
    upload(driver, ("INCLUSION", YARD))
    driver.upload([driver.item("NAV_WAYPOINT"), driver.item("NAV_WAYPOINT", 80.0, 0.0)])
    driver.start_mission()
    driver.wait_statustext("Dijkstra: could not find path")
    driver.delay(12.0)
    assert np.hypot(*driver.position[:2]) < 3.0 and driver.mode == "AUTO"
    said = [text.time for text in driver.texts if "Dijkstra" in text.text]
    assert said == sorted(said) and np.diff(said) == pytest.approx(5.0, abs=1.1)
    driver.params["FENCE_ENABLE"] = 0
    driver.wait(lambda t: driver.position[0] > 75.0, timeout=60.0, what="beyond the yard")


def test_bendy_ruler_goes_out_and_home_as_the_real_one_does() -> None:
    """A real ArduPilot is there after 34.5 s, and comes as far west as 19.4 m and 17.5 m."""
    driver = ready(OA_TYPE=1, OA_MARGIN_MAX=5, AVOID_ENABLE=0)
    upload(driver, ("EXCLUSION", ((40.0, -8.0), (40.0, 12.0), (60.0, 12.0), (60.0, -8.0))))
    driver.set_mode("GUIDED")
    driver.arm()
    driver.set_position(north=100.0, east=0.0)
    west, start = [], driver.now
    while driver.position[0] < 97.5 and driver.now < start + 60.0:
        driver.delay(0.2)
        west.append(driver.position[1])
    assert driver.now - start == pytest.approx(34.5, abs=5.0) and min(west) == pytest.approx(-19.4, abs=3.0)
    driver.set_mode("RTL")
    assert room_until(driver, 0.0, 0.0, 90.0) > 5.0


def test_bendy_ruler_follows_a_mission_around_a_block() -> None:
    driver = ready(OA_TYPE=1)
    upload(driver, ("EXCLUSION", BLOCK))
    driver.upload(
        [driver.item("NAV_WAYPOINT"), driver.item("NAV_WAYPOINT", 50.0, 0.0), driver.item("NAV_WAYPOINT", 50.0, 30.0)]
    )
    driver.start_mission()
    assert room_until(driver, 50.0, 0.0, 90.0) > MARGIN
    assert room_until(driver, 50.0, 30.0, 60.0) > MARGIN


@pytest.mark.parametrize("kind", [0, 1])
def test_a_post_that_the_lidar_sees_is_driven_around(kind: int) -> None:
    params = {"PRX1_TYPE": 10, "OA_TYPE": kind, "OA_MARGIN_MAX": 1.5, "OA_BR_LOOKAHEAD": 8, "AVOID_ENABLE": 0}
    driver = Client(Simulation("erle_rover", world=POST, seed=2, estimator="truth", params=params))
    driver.wait_ready()
    driver.set_mode("GUIDED")
    driver.arm()
    driver.set_position(north=40.0, east=0.0)
    if kind == 0:
        driver.delay(40.0)
        assert driver.simulation.v.physics.obstacles.hit_count > 0
        return
    driver.wait(lambda t: driver.position[0] > 38.0, timeout=120.0, what="behind the post")
    assert driver.simulation.v.physics.obstacles.hit_count == 0
