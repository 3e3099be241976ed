# SPDX-License-Identifier: BSD-3-Clause
"""Lidar and range-finder of a vehicle in a world: what they read, and when."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sitl import vehicles
from sitl.core.algebra import quat_from_euler
from sitl.core.border import LIDAR_SAMPLES as ROOM
from sitl.core.vectors import Euler
from sitl.simulation import Core, Simulation
from sitl.vehicles import AirframeError
from sitl.vehicles.properties.body import LIDAR_SAMPLES
from sitl.worlds import Box, Start, World

KNOWN: dict[str, Any] = json.loads(
    (Path(__file__).parents[1] / "worlds" / "data" / "gym_gazebo_worlds.json").read_text(encoding="utf-8")
)
"""World -> the scan at its start, of independent making."""
SECOND = 1_000_000


def walled(*boxes: Box, floor: float = 0.0) -> World:
    return World("walled", boxes, (Start("here", (0.0, 0.0, floor), 0.0),), floor_z=floor)


def stand(simulation: Simulation, down: float, *angles: float) -> np.ndarray:
    """Put a vehicle there (roll, pitch, yaw [rad]) and let its lidar measure."""
    b = simulation.v.physics.body
    b.pos = b.pos.replace(z=down)
    if angles:
        b.q = quat_from_euler(Euler(*angles))
    assert simulation.plant.rangers is not None
    simulation.v.sensors.lidar_count = simulation.v.sensors.rangefinder_count = 0
    simulation.plant.rangers.find_due()
    simulation.plant.rangers.measure()
    return scan(simulation)


def scan(simulation: Simulation) -> np.ndarray:
    v = simulation.v
    return np.array(v.sensors.lidar_ranges[: int(v.physics.airframe.lidar_samples)], float)


@pytest.mark.parametrize(
    ("frame", "world", "down"), [("erle_rover", "maze_erlerover", 0.0), ("erle_copter", "office_erlecopter", -1.0)]
)
def test_scan_at_the_start_is_the_known_one(cores: dict[str, Core], frame: str, world: str, down: float) -> None:
    """The copter's at 1 m: its lidar is 0.15 m above that."""
    simulation = Simulation(frame, world=world, core=cores[vehicles.load(frame).kind])
    known, readings = KNOWN[world]["scan"], stand(simulation, down)
    longest = float(simulation.v.physics.airframe.lidar_max)
    assert len(readings) == known["published_ranges"]
    shown = np.minimum(readings, longest)
    assert shown[known["sampled_indices"]] == pytest.approx(known["sampled_ranges"], abs=0.001)
    assert shown.min() == pytest.approx(known["min_range"], abs=0.001)
    if "all" in known:
        assert shown == pytest.approx(known["all"], abs=0.001)


def test_a_lean_lets_the_lidar_look_at_the_floor(cores: dict[str, Core]) -> None:
    world = walled(Box((100.0, 0.0, 1.0), (1.0, 1.0, 2.0)))
    simulation = Simulation("erle_copter", world=world, core=cores["copter"])
    assert np.isinf(stand(simulation, -1.0)).all()
    readings = stand(simulation, -1.0, 0.0, math.radians(-20.0), 0.0)  # nose down
    ahead = 0.5 * (readings[34] + readings[35])
    height = 1.0 + 0.15 * math.cos(math.radians(20.0)) - 0.15 * math.sin(math.radians(20.0))
    assert ahead == pytest.approx(height / math.sin(math.radians(20.0)), abs=0.01)
    assert np.isinf(readings[0]) and np.isinf(readings[-1]), "backward it looks up"
    readings = stand(simulation, -1.0, math.radians(20.0), 0.0, 0.0)  # to the right
    right, left = readings[11], readings[58]  # about 90 degrees
    assert right < 4.0 and np.isinf(left)


def test_left_is_left(cores: dict[str, Core]) -> None:
    world = walled(Box((0.0, 3.0, 1.0), (0.4, 0.4, 2.0)))  # to the left of x
    simulation = Simulation("erle_copter", world=world, core=cores["copter"])
    readings = stand(simulation, -1.0, 0.0, 0.0, 0.0)
    angles = np.linspace(-135.0, 135.0, 70)
    assert 85.0 < angles[readings.argmin()] < 96.0
    assert readings.min() == pytest.approx(2.8, abs=0.02)
    readings = stand(simulation, -1.0, 0.0, 0.0, math.radians(-90.0))  # the nose turned to the left
    assert abs(angles[readings.argmin()]) < 5.0


def test_a_floor_at_another_height_is_the_ground(cores: dict[str, Core]) -> None:
    walls = [Box((4.0, 0.0, z), (0.2, 20.0, 1.0)) for z in (0.5, 5.5)]
    scans, downs = [], []
    for box, floor in zip(walls, (0.0, 5.0)):
        simulation = Simulation("erle_copter", world=walled(box, floor=floor), core=cores["copter"])
        scans.append(stand(simulation, -0.5, 0.0, 0.0, 0.3))
        downs.append(float(simulation.v.sensors.rangefinder_range[0]))
        assert simulation.v.physics.obstacles.rows[0, 7:9].tolist() == [-1.0, 0.0]
    assert (scans[0] == scans[1]).all() and np.isfinite(scans[0]).any()
    assert downs == [pytest.approx(0.5), pytest.approx(0.5)]


def test_looking_down_meets_what_is_below(cores: dict[str, Core]) -> None:
    world = walled(Box((5.0, 0.0, 0.4), (2.0, 2.0, 0.8)))
    simulation = Simulation("erle_copter", world=world, core=cores["copter"])
    b, s = simulation.v.physics.body, simulation.v.sensors
    stand(simulation, -3.0)
    assert float(s.rangefinder_range[0]) == pytest.approx(3.0)
    b.pos = b.pos.replace(x=5.0)
    stand(simulation, -3.0)
    assert float(s.rangefinder_range[0]) == pytest.approx(2.2)
    stand(simulation, -3.0, 0.0, math.radians(100.0), 0.0)
    assert math.isinf(float(s.rangefinder_range[0])), "it looks at the sky"


def test_limits_of_the_range(cores: dict[str, Core]) -> None:
    near = vehicles.load("erle_copter").changed(lidar_min=2.0, lidar_max=4.0, lidar_at=(0.0, 0.0, 0.0))
    world = walled(Box((1.6, 0.0, 1.0), (0.2, 0.6, 2.0)), Box((-5.0, 3.0, 1.0), (20.0, 0.2, 2.0)))
    simulation = Simulation(near, world=world, core=cores["copter"])
    readings = stand(simulation, -1.0, 0.0, 0.0, 0.0)
    assert readings.min() == 2.0, "1.5 m is below the least"
    assert np.isinf(readings[:20]).all()
    assert np.isfinite(readings[50:60]).any() and readings[np.isfinite(readings)].max() < 4.0


def test_scans_are_taken_at_their_times_whatever_the_step(cores: dict[str, Core]) -> None:
    for rate, seconds, wanted in ((10.0, 0.0375, 0.1), (7.0, 0.05, 1.0 / 7.0), (400.0, 0.1, 0.0025)):
        airframe = vehicles.load("erle_rover").changed(lidar_rate=rate)
        simulation = Simulation(airframe, world="maze_erlerover", core=cores["rover"])
        s, times = simulation.v.sensors, []
        assert (s.lidar_count, s.lidar_time_us) == (1, 0), "the first at power-on"
        while simulation.time_us < SECOND:
            simulation.advance(seconds if rate < 100 else 0.0025)
            assert simulation.time_us - s.lidar_time_us < 1e6 / rate + 2500
            times.append(int(s.lidar_time_us))
        assert s.lidar_count == math.floor(simulation.time_us * 1e-6 * rate + 1e-9) + 1
        for time in sorted(set(times)):
            k = round(time * 1e-6 / wanted)
            assert -1.0 < time - k * wanted * 1e6 < 2501.0


def test_noise_is_of_its_size_and_repeats(cores: dict[str, Core]) -> None:
    noisy = vehicles.load("erle_rover").changed(lidar_noise=0.05)
    exact = scan(Simulation("erle_rover", world="maze_erlerover", core=cores["rover"]))
    first = Simulation(noisy, world="maze_erlerover", core=cores["rover"], seed=3)
    again = Simulation(noisy, world="maze_erlerover", core=cores["rover"], seed=3)
    other = Simulation(noisy, world="maze_erlerover", core=cores["rover"], seed=4)
    seen = np.isfinite(exact)
    errors = (scan(first) - exact)[seen]
    assert 0.04 < errors.std() < 0.06 and abs(errors.mean()) < 0.015
    for simulation in (first, again, other):
        simulation.advance(0.5)
    assert (scan(first) == scan(again)).all()
    assert (scan(first) != scan(other)).any()


def test_a_vehicle_without_them_measures_nothing(cores: dict[str, Core]) -> None:
    simulation = Simulation("ardupilot_quad", world="office_erlecopter", core=cores["copter"])
    simulation.advance(0.3)
    assert (simulation.v.sensors.lidar_count, simulation.v.sensors.rangefinder_count) == (0, 0)
    plain = Simulation("erle_copter", core=cores["copter"])
    plain.advance(0.3)
    assert plain.v.sensors.lidar_count == 0 and plain.plant.rangers is None


def test_more_readings_than_rays_are_refused() -> None:
    with pytest.raises(AirframeError, match=r"lidar_samples = 300; at most lidar_rays, which is 140"):
        vehicles.load("erle_copter").changed(lidar_samples=300)


def test_there_is_room_for_what_properties_allow() -> None:
    assert ROOM == LIDAR_SAMPLES
