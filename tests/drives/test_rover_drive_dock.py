# SPDX-License-Identifier: BSD-3-Clause
"""DOCK at a simulated beacon. Values in comments: the same drive of ArduRover 4.7."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.simulation import Core
from sitl.vehicle.landing_beacon import position_of
from tests.drives.rover_driver import GUIDED, POSITION, Driver

DOCK = 8
SEEN = {
    "PLND_ENABLED": 1,
    "PLND_TYPE": 4,
    "SIM_PLD_OPTIONS": 1,
    "SIM_PLD_ALT_LMT": 30,
    "SIM_PLD_DIST_LMT": 30,
    "SIM_PLD_ORIENT": 4,
}
"""A beacon that shines south."""


def docker(core: Core, aside: float = -2.0, **params: float) -> tuple[Driver, np.ndarray]:
    """A rover 20 m south of a beacon and ``aside`` of it to the east [m], and where that truly is, NE [m]."""
    d = Driver(core, "ardupilot_rover", DOCK_SPEED=2.0, DOCK_STOP_DIST=0.5, **SEEN, **params).armed_in(GUIDED)
    lat, lon = d.lat_lon(50.0, 0.0)
    d.set_parameter("SIM_PLD_LAT", lat * 1e-7)
    d.set_parameter("SIM_PLD_LON", lon * 1e-7)
    d.set_parameter("SIM_PLD_ENABLE", 1)
    v = d.simulation.v
    dock = np.array(position_of(v.autopilot.params.SIM.PLD, v.physics.origin))[:2]
    assert not d.set_mode(DOCK) and d.said("Dock: target not acquired")
    d.target(POSITION, x=dock[0] - 20.0, y=dock[1] + aside)
    assert d.fly(60.0, lambda: d.place[0] > dock[0] - 22.5)
    d.fly(4.0)
    return d, dock


def away(d: Driver, place: np.ndarray) -> float:
    """True distance [m]."""
    return float(np.hypot(*(d.place - place)))


@pytest.mark.parametrize("kind", [0, 1, 2])
def test_it_docks_within_its_distance(core: Core, kind: int) -> None:
    d, dock = docker(core, SIM_PLD_TYPE=kind)
    start = d.now
    assert d.set_mode(DOCK)
    assert d.fly(60.0, lambda: d.said("Dock: Docking complete"))
    took = d.now - start
    assert took == pytest.approx(33.5, abs=0.5)  # 32.4 s
    d.fly(4.0)
    assert d.stands() and 0.2 < away(d, dock) < 0.6  # 0.40 m
    assert d.mode == DOCK and abs(d.heading - 6.0) < 8.0


def test_it_enters_the_dock_from_its_direction(core: Core) -> None:
    d, dock = docker(core, -8.0, DOCK_HDG_CORR_EN=1, DOCK_DIR=0)
    assert d.set_mode(DOCK)
    assert d.fly(60.0, lambda: away(d, dock) < 8.0)
    assert abs(d.place[1] - dock[1]) < 1.2  # 0.5 m at 8 m
    assert d.fly(60.0, lambda: d.said("Dock: Docking complete"))
    d.fly(4.0)
    assert abs(d.heading) < 4.0 and abs(d.place[1] - dock[1]) < 0.15 and away(d, dock) < 0.6  # 0.26 m


def test_without_the_correction_it_comes_at_an_angle(core: Core) -> None:
    d, _ = docker(core, -8.0)
    assert d.set_mode(DOCK)
    assert d.fly(60.0, lambda: d.said("Dock: Docking complete"))
    assert d.heading > 12.0


def test_the_correction_needs_a_direction(core: Core) -> None:
    d, _ = docker(core, DOCK_HDG_CORR_EN=1)
    assert not d.set_mode(DOCK) and d.said("Dock: Set DOCK_DIR or disable heading correction")


def test_its_speed_is_that_of_legs_without_one(core: Core) -> None:
    d, dock = docker(core)
    d.set_parameter("DOCK_SPEED", 0.0)
    d.set_parameter("DOCK_STOP_DIST", 2.0)
    assert d.set_mode(DOCK)
    start = d.now
    assert d.fly(60.0, lambda: d.said("Dock: Docking complete"))
    assert np.hypot(*d.since(start)[:, 4:6].T).max() > 2.3  # WP_SPEED 5: 3.46 m/s
    d.fly(4.0)
    assert 1.3 < away(d, dock) < 2.1  # 1.63 m


def test_a_dock_out_of_sight_is_driven_to_up_to_its_last_part(core: Core) -> None:
    d, dock = docker(core)
    assert d.set_mode(DOCK)
    assert d.fly(60.0, lambda: away(d, dock) < 8.0)
    d.set_parameter("SIM_PLD_ENABLE", 0)
    assert d.fly(60.0, lambda: d.said("Dock: Docking complete"))
    assert d.said("PrecLand: Target Lost")
    d.fly(4.0)
    assert d.stands() and 2.2 < away(d, dock) < 3.0  # 2.56 m


def test_it_stops_at_its_dock_without_its_sensor(core: Core) -> None:
    d, dock = docker(core)
    assert d.set_mode(DOCK)
    d.fly(2.0)
    d.set_parameter("PLND_ENABLED", 0)
    assert d.fly(60.0, lambda: d.said("Dock: Docking complete"))
    d.fly(4.0)
    assert d.stands() and away(d, dock) < 4.0


def test_a_sensor_that_looks_back_docks_in_reverse(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", **{**SEEN, "SIM_PLD_ORIENT": 0, "PLND_ORIENT": 4}, DOCK_SPEED=2.0).armed_in(
        GUIDED
    )
    lat, lon = d.lat_lon(-20.0, 0.0)
    d.set_parameter("SIM_PLD_LAT", lat * 1e-7)
    d.set_parameter("SIM_PLD_LON", lon * 1e-7)
    d.set_parameter("SIM_PLD_ENABLE", 1)
    d.target(POSITION, x=5.0, y=0.0)
    d.fly(12.0)
    v = d.simulation.v
    dock = np.array(position_of(v.autopilot.params.SIM.PLD, v.physics.origin))[:2]
    assert d.set_mode(DOCK)
    d.fly(4.0)
    assert d.speed < -0.3
    assert d.fly(90.0, lambda: d.said("Dock: Docking complete"))
    assert away(d, dock) < 0.5
