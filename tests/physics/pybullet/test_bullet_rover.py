# SPDX-License-Identifier: BSD-3-Clause
"""Rovers in Bullet: rest, speed, turns, scrubbing, grip, walls, snapshots."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pytest import approx

from sitl.core.constants import GRAVITY

pytest.importorskip("pybullet")

from sitl import vehicles, worlds
from sitl.core.records import first_difference
from sitl.physics.engine import EngineError, EngineVehicle, Laws
from sitl.physics.native.rover.init import init
from sitl.physics.pybullet.rover_model import layout
from sitl.physics.pybullet.tyres import CREEP, scrub
from sitl.physics.pybullet.wheeled_rover import BulletRover
from sitl.vehicle.core_entry import bind_unit
from sitl.vehicle.rover import ROVER
from sitl.vehicle.rover import Rover as RoverRecord
from sitl.worlds import Box, Start, World

HOME = (-35.36, 149.16, 584.0, 0.0)
AIRFRAMES = vehicles.names("rover", on_bench=False)
CARS = AIRFRAMES[:3]
START = (Start("origin", (0.0, 0.0, 0.0), 0.0),)
WALL = World("wall", (Box((5.0, 0.0, 0.5), (0.2, 8.0, 1.0)),), START)
LINTEL = World("lintel", (Box((3.0, 0.0, 2.0), (0.2, 8.0, 1.0)),), START)
ICE = World("ice", (), START, friction=0.05)


class Rover:
    """A rover with steering or left side on the first control, throttle or right side on the second: -1 .. 1."""

    def __init__(
        self, frame: str, world: str | World | None = None, physics: str = "pybullet", **properties: Any
    ) -> None:
        airframe = vehicles.load(frame).changed(noise_scale=0.0, **properties)
        self.fleet = fleet = RoverRecord.fleet(1)
        self.v = RoverRecord.of(fleet, 0)
        init(self.v, airframe, HOME, 1)
        self.full = float(airframe.value("control_full"))
        self.engine: BulletRover | None = None
        if physics == "native":
            self.tick = bind_unit(ROVER.step, ROVER, fleet, 0)
            return
        units = (ROVER.pieces.begin, ROVER.pieces.load, ROVER.pieces.sense)
        laws = Laws(*(bind_unit(unit, ROVER, fleet, 0) for unit in units))
        found = worlds.load(world) if world is not None else None
        self.engine = BulletRover(EngineVehicle(self.v, fleet, 0, airframe, laws, found))
        self.engine.place()
        self.tick = self.engine.tick

    def drive(self, seconds: float, first: float = 0.0, second: float = 0.0) -> None:
        controls = self.v.actuators.controls
        controls[0], controls[2] = first * self.full, second * self.full
        for _ in range(round(400 * seconds)):
            self.tick()

    @property
    def body(self) -> Any:
        return self.v.physics.body

    @property
    def wheels(self) -> Any:
        return self.v.physics.wheels

    @property
    def hits(self) -> Any:
        return self.v.physics.obstacles


@pytest.mark.parametrize("frame", AIRFRAMES)
def test_stands_still(frame: str) -> None:
    r = Rover(frame)
    r.drive(1.0)
    place = r.body.pos
    worst = 0.0
    for _ in range(400):
        r.tick()
        felt = r.body.specific_force - (0.0, 0.0, -GRAVITY)
        worst = max(worst, *np.abs(felt), *np.abs(r.body.rates))
    assert worst < 1e-3
    assert np.abs(r.body.pos - place).max() < 1e-6
    assert abs(r.body.pos[2]) < 1e-4


@pytest.mark.parametrize("frame", AIRFRAMES)
@pytest.mark.parametrize("throttle", [0.4, -0.8])
def test_straight_on_as_native_physics(frame: str, throttle: float) -> None:
    """Same motors, tyres that hold: the same drive."""
    r, n = Rover(frame), Rover(frame, physics="native")
    for each in (r, n):
        each.drive(4.0, throttle if frame == "skid_rover" else 0.0, throttle)
    assert r.wheels.forward == approx(n.wheels.forward, rel=2e-3)
    assert r.body.pos[0] == approx(n.body.pos[0], rel=5e-3)
    assert abs(r.body.pos[1]) < 1e-3 * abs(r.body.pos[0])
    assert tuple(r.wheels.distance) == approx(tuple(n.wheels.distance), rel=5e-3)


@pytest.mark.parametrize("frame", CARS)
@pytest.mark.parametrize("steering", [0.3, -1.0])
def test_turns_on_its_circle(frame: str, steering: float) -> None:
    throttle = 0.08 if frame == "ardupilot_rover" else 0.5
    r, n = Rover(frame), Rover(frame, physics="native")
    for each in (r, n):
        each.drive(6.0, steering, throttle)
    assert r.wheels.forward / r.body.rates[2] == approx(n.wheels.forward / n.body.rates[2], rel=0.02)
    assert r.wheels.distance[0] - r.wheels.distance[1] == approx(n.wheels.distance[0] - n.wheels.distance[1], rel=0.05)


@pytest.mark.parametrize("turn", [0.2, 1.0])
def test_skid_steering_scrubs(turn: float) -> None:
    """On the spot the yaw rate follows a track that is track_slip times as wide: from the friction of four tyres."""
    r = Rover("skid_rover")
    r.drive(3.0, turn, -turn)
    left, right = r.wheels.speed
    a = r.v.physics.airframe
    assert left == approx(-right, rel=1e-3) and left > 0.15 * turn
    assert r.body.rates[2] == approx((left - right) / (a.track * a.track_slip), rel=0.02)
    assert np.hypot(*r.body.pos[:2]) < 0.02


def test_grip_is_that_of_tyres_and_floor() -> None:
    r = Rover("erle_rover", ICE)
    r.drive(1.0, 0.0, 1.0)
    driven = float(r.v.physics.airframe.driven_load)
    assert r.wheels.forward == approx(0.05 * GRAVITY * driven, rel=0.1)
    assert r.wheels.speed[0] > 2.0 * r.wheels.forward, "its wheels spin"


def test_body_nods_on_its_springs() -> None:
    r = Rover("erle_rover")
    r.drive(0.3, 0.0, 1.0)
    nose_up = 2.0 * r.body.q[2]
    assert 0.001 < nose_up < 0.02
    r.drive(4.0, 0.0, 1.0)
    assert abs(2.0 * r.body.q[2]) < 1e-4


def test_wall_stops_it_and_is_reported() -> None:
    r = Rover("erle_rover", WALL)
    r.drive(4.0, 0.0, 1.0)
    front = float(r.v.physics.airframe.contact_along[0] + r.v.physics.airframe.contact_radius)
    assert r.body.pos[0] == approx(4.9 - front, abs=0.01)
    assert abs(r.wheels.forward) < 0.01 and r.hits.touching == 1
    assert r.hits.hit_count == 1 and r.hits.hit_speed == approx(1.5875, rel=0.03)
    speed = r.hits.hit_speed
    r.drive(2.0, 0.0, -1.0)
    assert r.hits.touching == 0 and r.wheels.forward < -1.0
    assert (r.hits.hit_count, r.hits.hit_speed) == (1, speed)


def test_impact_shows_over_some_ticks() -> None:
    """As a bumper gives way: an accelerometer that saturates would show too little of it."""
    r = Rover("erle_rover", WALL)
    r.drive(0.0, 0.0, 1.0)
    felt = []
    for _ in range(1200):
        r.tick()
        felt.append(float(r.body.acc_ned[0]))
    assert -120.0 < min(felt) < -20.0
    still_to_come = float(r.hits.impulse[0])
    assert sum(felt) / 400.0 + still_to_come == approx(float(r.body.vel[0]), abs=1e-3)


def test_what_hangs_above_it_does_not_stop_it() -> None:
    r = Rover("erle_rover", LINTEL)
    r.drive(4.0, 0.0, 1.0)
    assert r.body.pos[0] > 4.0 and r.hits.hit_count == 0


@pytest.mark.parametrize(("frame", "seconds"), [("erle_rover", 1.0), ("erle_rover", 3.2), ("skid_rover", 2.75)])
def test_snapshot_goes_on_bit_for_bit(frame: str, seconds: float) -> None:
    """On the way and at the wall; in the same engine and in another one."""
    r = Rover(frame, WALL)
    r.drive(seconds, 0.9, 1.0)
    state, record = r.engine.snapshot(), r.fleet.copy()
    r.drive(1.0, 0.4, 0.9)
    end = r.fleet.copy()
    for again in (r, Rover(frame, WALL)):
        again.fleet[:] = record
        again.engine.restore(state)
        again.drive(1.0, 0.4, 0.9)
        assert first_difference(again.fleet[0], end[0]) is None


def test_placing_it_again_forgets_the_past() -> None:
    r = Rover("erle_rover", WALL)
    record = r.fleet.copy()
    r.drive(3.5, 0.2, 1.0)
    end = r.fleet.copy()
    r.fleet[:] = record
    r.engine.place()
    r.drive(3.5, 0.2, 1.0)
    assert first_difference(r.fleet[0], end[0]) is None


def by_dice(r: Rover, seed: int) -> bytes:
    """Some seconds of random driving; all bytes of the vehicle afterwards."""
    dice = np.random.default_rng(seed)
    for _ in range(3):
        r.drive(0.5, float(dice.uniform(-1.0, 1.0)), float(dice.choice([1.0, 0.6, -0.6])))
    return r.fleet.tobytes()


def put_back(r: Rover, record: bytes) -> None:
    r.fleet.view("u1")[:] = np.frombuffer(record, "u1")


@pytest.mark.parametrize("frame", ["erle_rover", "ardupilot_rover", "skid_rover"])
def test_what_it_ran_into_is_forgotten(frame: str) -> None:
    """By restoring and by power-on: all goes on bit for bit as in an engine that has never touched anything."""
    world = worlds.load("round")
    r, touched = Rover(frame, world), 0
    for k in range(12):
        by_dice(r, k)
        touched += int(r.hits.touching)
        state, record = r.engine.snapshot(), r.fleet.tobytes()
        end = by_dice(r, 99)
        for again in (r, Rover(frame, world)):
            put_back(again, record)
            again.engine.restore(state)
            assert by_dice(again, 99) == end, k
        ends = []
        for again in (r, Rover(frame, world)):
            put_back(again, record)
            again.engine.place()
            ends.append(by_dice(again, 99))
        assert ends[0] == ends[1], k
        put_back(r, record)
        r.engine.restore(state)
    assert touched > 1


def test_snapshot_of_something_else_is_refused() -> None:
    """And leaves the vehicle where it is."""
    r, other = Rover("erle_rover", WALL), Rover("erle_rover", WALL)
    for one in (r, other):
        one.drive(1.0, 0.3, 1.0)
    with pytest.raises(EngineError, match="snapshot"):
        r.engine.restore(bytes(300))
    with pytest.raises(EngineError, match="snapshot"):
        r.engine.restore(Rover("skid_rover").engine.snapshot())
    assert by_dice(r, 1) == by_dice(other, 1)


def test_layouts() -> None:
    """Parts of the vehicle from the airframe's properties."""
    erle = layout(Rover("erle_rover").v.physics.airframe)
    assert erle.origin == approx(0.0, abs=1e-12) and sum(erle.load(k) for k in range(4)) == approx(1.0)
    skid = layout(Rover("skid_rover").v.physics.airframe)
    assert (skid.wheelbase / skid.track) ** 2 == approx(0.5) and not skid.steers
    point = layout(Rover("ardupilot_rover").v.physics.airframe)
    assert point.origin == approx(-0.5 * point.wheelbase)


def test_scrubbing_tyre() -> None:
    assert scrub(3.0, 4.0, 10.0) == approx((-6.0, -8.0))
    assert scrub(0.1 * CREEP, 0.0, 10.0) == approx((-1.0, 0.0))
    assert math.hypot(*scrub(-1e-9, 1e-9, 10.0)) < 1e-6


def test_picture_shows_it_and_its_world() -> None:
    r = Rover("erle_rover", WALL)
    r.drive(1.0, 0.5, 0.5)
    before = r.fleet.copy()
    picture = r.engine.render(80, 60)
    assert picture.shape == (60, 80, 3) and picture.dtype == np.uint8
    red = (picture[:, :, 0] > 120) & (picture[:, :, 1] < 60)
    assert 5 < red.sum() < 2000
    assert first_difference(r.fleet[0], before[0]) is None
