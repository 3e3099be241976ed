# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles and the solids of a world, in physics alone: nothing is entered, nothing is lost but the speed into it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pytest import approx

from sitl.core import records
from sitl.core.kernels import jit_disabled
from sitl.physics.native import obstacles
from sitl.physics.native.records import OBSTACLES_MAX
from sitl.worlds import Box, Cylinder, contact
from sitl.worlds.geometry import compile_geometry

ROVER = {"contact_discs": 1, "contact_along": (0.0, 0.0, 0.0), "contact_radius": 0.5, "contact_top": 1.0}


def surround(rig: Any, *solids: Box | Cylinder, reach: float = 30.0) -> None:
    """What the shell does: list the solids near the vehicle in its record."""
    geometry, o = compile_geometry(solids, 0.0), rig.p.obstacles
    pos = rig.p.body.pos
    rows = contact.rows(OBSTACLES_MAX)
    o.present = 1
    o.count, o.complete = contact.near(geometry, float(pos[0]), float(pos[1]), reach, rows)
    o.rows[:] = rows
    o.north, o.east, o.wanted, o.clear = float(pos[0]), float(pos[1]), 0, 0.0


def wall(ahead: float, yaw: float = 0.0, height: float = 3.0) -> Box:
    return Box((ahead, 0.0, 0.5 * height), (0.2, 40.0, height), yaw)


def coast(rig: Any, ticks: int) -> None:
    """Collisions of a body that flies straight on, without forces."""
    b = rig.p.body
    for k in range(ticks):
        b.pos += 0.0025 * b.vel
        obstacles.collide(rig.p.obstacles, rig.p.body, rig.p.airframe, 2500 * (k + 1))


def test_a_body_stops_at_a_wall_and_keeps_its_speed_along_it(rig):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(1.0)
    surround(r, wall(3.0))
    r.p.body.vel = (4.0, 1.0, 0.0)
    coast(r, 400)
    o = r.p.obstacles
    assert r.p.body.pos[0] == approx(2.4, abs=1e-12) and r.p.body.pos[1] == approx(1.0)
    assert list(r.p.body.vel) == [0.0, 1.0, 0.0]
    assert (o.touching, o.hit_count, o.hit_speed) == (1, 1, 4.0)
    assert o.hit_time_us == approx(0.6e6, abs=2500)
    assert list(o.impulse) == [-4.0, 0.0, 0.0]
    r.p.body.vel = r.p.body.vel.replace(x=-1.0)
    coast(r, 4)
    assert o.touching == 0 and o.hit_count == 1


@pytest.mark.parametrize("speed", [1.0, 7.0, 30.0, 100.0])
def test_no_speed_takes_it_through_or_lets_it_touch_from_afar(rig, speed):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(1.0)
    surround(r, wall(9.0, height=30.0))
    r.p.body.vel = (speed, 0.0, 0.0)
    b, before = r.p.body, 0.0
    for k in range(int(9.0 / speed / 0.0025) + 100):
        before = b.pos.x
        coast(r, 1)
        if r.p.obstacles.touching:
            assert before + 0.0025 * speed >= 8.4, k
            break
    assert b.pos.x == approx(8.4, abs=1e-9)


def test_distances_are_worked_out_only_where_they_can_matter(rig, monkeypatch):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(1.0)
    surround(r, wall(50.0), reach=100.0)
    counted = []
    nearest = obstacles.nearest
    monkeypatch.setattr(obstacles, "nearest", lambda *args: counted.append(args[-1]) or nearest(*args))
    r.p.body.vel = (2.0, 0.0, 0.0)
    coast(r, 4000)
    assert 1 <= len(counted) <= 3, "20 m of 49.4 m"


def test_in_a_corner_it_ends_in_the_corner(rig):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(1.0)
    surround(r, wall(3.0), Box((0.0, -2.0, 1.0), (40.0, 0.2, 2.0)))  # to the right: east 2
    r.p.body.vel = (3.0, 2.0, 0.0)
    coast(r, 500)
    assert list(r.p.body.pos[:2]) == [approx(2.4, abs=1e-9), approx(1.4, abs=1e-9)]
    assert np.abs(r.p.body.vel).max() < 1e-9


def test_what_is_high_enough_passes_over_and_lands_on_top(rig):
    r = rig("ardupilot_quad", contact_radius=0.5, contact_bottom=0.1)
    r.fly(3.2)
    table = Box((5.0, 0.0, 1.5), (6.0, 6.0, 3.0))
    surround(r, table)
    r.p.body.vel = (2.0, 0.0, 0.0)
    coast(r, 1000)
    assert r.p.obstacles.touching == 0 and r.p.body.pos[0] == approx(5.0)
    r.p.body.vel = (0.0, 0.0, 1.0)
    coast(r, 400)
    assert r.p.body.pos[2] == approx(-3.1) and r.p.obstacles.hit_speed == 1.0


def test_on_top_it_comes_to_rest_and_at_a_side_it_slides(rig):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(3.0)
    surround(r, Box((5.0, 0.0, 1.5), (30.0, 6.0, 3.0)))
    b = r.p.body
    b.vel, b.rates = (1.0, 0.5, 0.0), (0.2, 0.1, -0.3)
    for _ in range(800):
        b.vel += (0.0, 0.0, 9.8 * 0.0025)
        coast(r, 1)
    speed = math.hypot(1.0, 0.5)
    way = speed * speed / (2.0 * 0.8 * 9.8)
    assert math.hypot(b.pos[0], b.pos[1]) == approx(way, rel=0.02) and b.pos[2] == approx(-3.0)
    assert list(b.vel) == [0.0, 0.0, 0.0] and np.abs(b.rates).max() < 1e-9


def test_each_end_of_a_long_vehicle_touches(rig):
    r = rig("erle_rover", contact_discs=2, contact_along=(1.0, -1.0, 0.0), contact_radius=0.5, contact_top=1.0)
    for yaw, place in ((0.0, 3.4), (math.pi / 2, 4.4), (math.pi, 3.4)):  # nose to it, side to it, tail to it
        r.power_on(1, math.degrees(yaw))
        surround(r, wall(5.0))
        r.p.body.vel = (2.0, 0.0, 0.0)
        coast(r, 1500)
        assert r.p.body.pos[0] == approx(place, abs=1e-9), yaw


def test_turning_on_the_spot_counts_as_motion(rig):
    r = rig("erle_rover", contact_discs=2, contact_along=(1.0, -1.0, 0.0), contact_radius=0.5, contact_top=1.0)
    r.power_on(1, 90.0)
    surround(r, wall(1.3))  # beside it: 0.7 m free, its nose reaches 0.3 m too far when it has turned
    b = r.p.body
    for k in range(400):
        half = 0.5 * math.radians(90.0 - 90.0 * (k + 1) / 400)
        b.q = (math.cos(half), 0.0, 0.0, math.sin(half))
        b.rates_mean = b.rates_mean.replace(z=-math.radians(90.0))
        obstacles.collide(r.p.obstacles, r.p.body, r.p.airframe, 2500 * k)
    assert b.pos[0] == approx(-0.3, abs=1e-9) and r.p.obstacles.touching == 1


def test_it_asks_for_a_new_list_before_the_old_one_ends(rig):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(1.0)
    surround(r, wall(20.0), reach=5.0)
    o = r.p.obstacles
    assert o.count == 0 and o.complete == approx(19.9)
    r.p.body.vel = (10.0, 0.0, 0.0)
    for _ in range(800):
        coast(r, 1)
        if o.wanted:
            break
    assert o.wanted and 18.0 < r.p.body.pos[0] < 19.4 - 0.4
    surround(r, wall(20.0), reach=5.0)
    coast(r, 400)
    assert o.count == 1 and r.p.body.pos[0] == approx(19.4, abs=1e-9)


def test_accelerometer_shows_the_whole_impact_over_some_ticks(rig):
    r = rig("ardupilot_quad", contact_radius=0.5)
    r.fly(1.0)
    o, b = r.p.obstacles, r.p.body
    o.present, o.impulse = 1, (-2.0, 1.0, 0.0)
    b.q = (math.cos(0.5), 0.0, 0.0, math.sin(0.5))
    shown, peak = np.zeros(3), 0.0
    for _ in range(400):
        b.acc_ned = b.specific_force = (0.0, 0.0, 0.0)
        obstacles.show(o, b)
        shown += 0.0025 * np.array(b.acc_ned)
        peak = max(peak, float(np.hypot(*b.specific_force[:2])))
        c, s = math.cos(1.0), math.sin(1.0)
        n, e = b.acc_ned[:2]
        assert list(b.specific_force[:2]) == [approx(c * n + s * e), approx(c * e - s * n)]
    assert shown == approx(np.array([-2.0, 1.0, 0.0]), abs=1e-12)
    assert list(o.impulse) == [0.0, 0.0, 0.0]
    assert 80.0 < peak < 130.0, "within the range of the accelerometer"


@pytest.mark.parametrize("yaw", [0.0, 0.5, 1.0])
def test_a_rover_that_drives_into_a_wall_stands_or_creeps_along(rig, yaw):
    r = rig("erle_rover", **ROVER)
    surround(r, wall(4.0, yaw))
    r.command(0.0, 1.0)
    r.step(1600)
    o, b = r.p.obstacles, r.p.body
    assert o.hit_count == 1 and o.hit_speed == approx(1.59 * math.cos(yaw), abs=0.02)
    assert 0.0 <= r.p.wheels.forward < 0.02 * (1.0 + math.tan(yaw) ** 2)
    outside = (b.pos[0] - 4.0) * math.cos(yaw) - b.pos[1] * math.sin(yaw)
    assert outside == approx(-0.6, abs=1e-6), "its side is at the wall"
    assert r.p.wheels.distance[0] < 4.5, "the motor stalls"
    assert r.p.battery.current > 20.0, "and draws"
    assert np.abs(r.v.sensors.acc[0]) < 5.0
    r.command(0.0, -1.0)
    r.step(800)
    assert o.touching == 0 and r.p.wheels.forward == approx(-1.59, abs=0.05), "and backs away"


def test_a_rover_keeps_its_tyres_rule_at_a_wall(rig):
    """Velocity is along the body but for the swing of the origin about the driven axle."""
    r = rig("erle_rover", **ROVER)
    surround(r, wall(4.0, 0.7))
    r.command(0.1, 1.0)
    for _ in range(1600):
        r.step()
        b = r.p.body
        w, z = float(b.q[0]), float(b.q[3])
        c, s = w * w - z * z, 2.0 * w * z
        across = c * float(b.vel[1]) - s * float(b.vel[0])
        assert across == approx(r.airframe.value("rear_axle") * float(b.rates[2]), abs=1e-9)
    assert r.p.obstacles.hit_count >= 1


def test_without_a_world_nothing_of_it_moves(rig):
    r = rig("erle_copter")
    r.fly()
    before = r.p.obstacles["rows"].copy()
    r.step(50)
    o = r.p.obstacles
    assert (o.present, o.wanted, o.touching, o.hit_count, o.turned) == (0, 0, 0, 0, 0.0)
    assert (o["rows"] == before).all()


@pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")
@pytest.mark.parametrize("frame", ["erle_copter", "erle_rover"])
def test_compiled_and_plain_python_give_the_same_bits_at_walls(rig, frame):
    plain, compiled = rig(frame, seed=3), rig(frame, seed=3)
    for r in (plain, compiled):
        if frame == "erle_copter":
            r.fly(0.6)
            r.p.body.vel, r.p.body.rates = (3.0, 0.5, -0.2), (0.3, -0.2, 0.4)
        else:
            r.p.wheels.forward, r.p.wheels.speed = 1.5, (1.5, 1.5)
        surround(r, wall(1.7 if frame == "erle_rover" else 0.8, 0.3), Cylinder((1.0, -1.2, 1.0), 0.4, 2.0))
    for k in range(300):
        for r in (plain, compiled):
            r.command(*((0.55, 0.56, 0.54, 0.55) if frame == "erle_copter" else (0.4, 0.9)))
        plain.step()
        compiled.step_compiled()
        assert records.first_difference(plain.fleet[0], compiled.fleet[0]) is None, k
    assert plain.p.obstacles.hit_count >= 1


def test_a_rover_without_slip_hits_a_wall_once(rig):
    r = rig("ardupilot_rover")
    surround(r, wall(30.0))
    r.command(0.0, 1.0)
    r.step(3000)
    o = r.p.obstacles
    assert o.hit_count == 1 and o.hit_speed > 10.0 and o.touching == 1
    assert abs(r.p.wheels.speed[0]) < 0.1 and r.p.body.pos[0] == approx(29.65, abs=1e-6)
