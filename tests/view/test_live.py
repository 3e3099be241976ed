# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a running simulation say what its record says, and change nothing in it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl import Simulation
from sitl.client import Client
from sitl.core.algebra import rotate
from sitl.core.vectors import Vec3
from sitl.simulation import Core
from sitl.view.live import LiveSource
from sitl.view.signals import SignalError
from sitl.worlds import raycast


@pytest.fixture(scope="module")
def flown(core: Core) -> tuple[Client, LiveSource]:
    vehicle = Client(Simulation("erle_copter", core=core, seed=3))
    source = LiveSource(vehicle.simulation)
    vehicle.wait_ready()
    vehicle.take_off(8.0)
    return vehicle, source


def test_a_frame_is_the_vehicle_at_that_moment(flown: tuple[Client, LiveSource]) -> None:
    vehicle, source = flown
    captured = source.capture()
    v = vehicle.simulation.v
    pos, time_us = v.physics.body.pos, vehicle.simulation.time_us
    vehicle.set_velocity(3.0, 0.0)
    vehicle.delay(2.0)
    frame = source.frame(captured)
    assert frame.time_us == time_us and tuple(frame.pos) == tuple(pos), "what was captured, not what is now"
    now = source.frame(source.capture())
    assert tuple(now.pos) == tuple(v.physics.body.pos) and now.pos != frame.pos
    assert now.mode == "GUIDED" and now.armed and now.fix >= 3 and now.satellites > 6
    assert now.voltage == pytest.approx(vehicle.simulation.v.autopilot.battery.voltage)
    assert [np.sign(speed) for speed in now.rotors] == [1, 1, -1, -1] and min(map(abs, now.rotors)) > 100.0


def test_the_estimate_is_in_the_scene_beside_the_truth(flown: tuple[Client, LiveSource]) -> None:
    _, source = flown
    frame = source.frame(source.capture())
    assert frame.estimate_pos is not None and frame.home is not None
    assert 0.0 < math.dist(frame.estimate_pos, frame.pos) < 4.0, "a receiver's error apart"
    assert math.dist(frame.home, (0.0, 0.0, 0.0)) < 4.0


def test_texts_come_once(core: Core) -> None:
    simulation = Simulation("erle_copter", core=core)
    source = LiveSource(simulation)
    simulation.advance(6.0)
    first = source.frame(source.capture())
    assert "EKF3 IMU0 initialised" in [each.text for each in first.texts]
    assert source.frame(source.capture()).texts == ()
    source.close()
    simulation.advance(20.0)
    assert source.frame(source.capture()).texts == (), "a closed source hears nothing"


def test_what_the_lidar_met_lies_on_solids(core: Core) -> None:
    simulation = Simulation("erle_copter", core=core, world="maze")
    source = LiveSource(simulation)
    simulation.advance(0.2)
    frame = source.frame(source.capture())
    assert frame.scan is not None and len(frame.scan) > 20
    origin = frame.pos + rotate(frame.q, simulation.v.physics.airframe.lidar_at)
    assert simulation.world is not None
    for hit in frame.scan[::5]:
        place = frame.pos + rotate(frame.q, Vec3(*hit))
        ray = np.array(place - origin).reshape(3, 1)
        length = float(np.linalg.norm(ray))
        ranges = np.empty(1)
        raycast.scan(simulation.world.geometry, np.array(origin), ray / length, ranges)
        assert ranges[0] == pytest.approx(length, abs=0.02)
    assert source.frame(source.capture()).scan is frame.scan, "the same until the next scan"


def test_mission_and_fence_are_in_the_plan(core: Core) -> None:
    vehicle = Client(Simulation("erle_copter", core=core))
    source = LiveSource(vehicle.simulation)
    vehicle.wait_ready()
    vehicle.params.update(FENCE_TYPE=2, FENCE_RADIUS=60, FENCE_ENABLE=1)
    vehicle.delay(1.0)
    plan = source.frame(source.capture()).plan
    radii = np.linalg.norm(plan.fences[0], axis=1)
    assert len(plan.fences) == 1 and np.all(np.abs(radii - 60.0) < 4.0)
    assert source.frame(source.capture()).plan is plan, "the same until it changes"


def test_signals_by_name(flown: tuple[Client, LiveSource]) -> None:
    vehicle, source = flown
    names = source.signal_names()
    assert len(names) == len(set(names))
    source.choose_signals(("ATTITUDE.roll", "physics.body.pos[2]", "VFR_HUD.alt"))
    frame = source.frame(source.capture())
    roll = vehicle.simulation.v.autopilot.estimate.euler.roll
    assert frame.signals["ATTITUDE.roll"] == pytest.approx(roll, abs=1e-6)
    assert frame.signals["physics.body.pos[2]"] == frame.pos.z
    assert frame.signals["VFR_HUD.alt"] > 500.0
    with pytest.raises(SignalError, match=r"no signal 'ATTITUDE\.rol'; did you mean 'ATTITUDE\.roll'"):
        source.choose_signals(("ATTITUDE.rol",))
    assert "ATTITUDE.roll" in source.frame(source.capture()).signals, "those before stay"
    source.choose_signals(())
