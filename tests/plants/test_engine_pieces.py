# SPDX-License-Identifier: BSD-3-Clause
"""A tick in pieces moves and feels as native physics does in one piece."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.core.algebra import ZERO
from sitl.core.constants import GRAVITY
from sitl.physics.native.body import Inertia, Wrench, fly
from sitl.physics.native.copter import pieces as copter
from sitl.physics.native.copter.step import step as step_copter
from sitl.physics.native.obstacles import settle
from sitl.physics.native.rover import pieces as rover
from sitl.physics.native.rover.motion import Course, roll
from sitl.physics.native.rover.step import step as step_rover
from sitl.vehicle.copter import COPTER
from sitl.vehicle.rover import ROVER
from sitl.vehicles import load

HOME = (-35.0, 149.0, 100.0, 30.0)


def silent(name: str, kind):
    """Two equal vehicles without sensor errors, as (fleet of views)."""
    fleet = kind.record.fleet(2)
    views = [kind.record.of(fleet, i) for i in range(2)]
    for v in views:
        kind.init_physics(v, load(name).changed(noise_scale=0.0), HOME, 1)
    return views


@pytest.mark.parametrize("name", ["erle_copter", "ardupilot_quad"])
def test_a_copter_in_the_air(name: str) -> None:
    views = silent(name, COPTER)
    for v in views:
        v.physics.ground.state = 0
        v.physics.body.pos = (0.0, 0.0, -50.0)
        v.physics.body.vel = (3.0, -2.0, 0.5)
        v.physics.body.rates = (0.4, -0.3, 0.2)
        v.physics.rotors.speed[:4] = 0.5 * v.physics.airframe.speed_max or 0.5
        v.actuators.controls[:4] = (0.5, 0.52, 0.48, 0.5)
    whole, parts = views
    for _ in range(200):
        step_copter(views, 0)
        copter.begin(views, 1)
        rates = np.zeros(3)
        p = parts.physics
        for _ in range(int(p.airframe.substeps)):
            copter.load(views, 1)
            p.body.rates_mean = ZERO
            inertia = Inertia(p.airframe.inertia, p.derived.inverse_inertia, p.derived.inverse_mass)
            fly(p.body, Wrench(p.motion.force, p.motion.torque), inertia, p.derived.dt)
            rates += p.body.rates_mean
        copter.sense(views, 1)
        assert list(whole.physics.body.pos) == list(parts.physics.body.pos)
        assert list(whole.physics.body.q) == list(parts.physics.body.q)
        assert parts.physics.body.rates_mean == pytest.approx(rates / int(p.airframe.substeps), abs=1e-5)
        assert parts.sensors.gyro == pytest.approx(whole.sensors.gyro, abs=1e-5)
        # The change of velocity over the tick, looked at from the attitude half-way.
        assert parts.sensors.acc == pytest.approx(whole.sensors.acc, abs=0.02)
    assert whole.time_us == parts.time_us == 200 * 2500
    assert whole.physics.battery.charge == parts.physics.battery.charge


def test_a_rover_that_drives() -> None:
    views = silent("erle_rover", ROVER)
    whole, parts = views
    for v in views:
        v.actuators.controls[0], v.actuators.controls[2] = 0.3, 0.5
    for _ in range(400):
        step_rover(views, 0)
        rover.begin(views, 1)
        before = float(parts.physics.wheels.forward)
        parts.physics.wheels.forward = whole.physics.wheels.forward
        course = Course(before, whole.physics.wheels.forward, whole.physics.body.rates.z)
        roll(parts.physics.body, course, parts.physics.airframe.rear_axle)
        rover.sense(views, 1)
        assert list(parts.physics.wheels.speed) == list(whole.physics.wheels.speed)
        assert parts.physics.wheels.angle == whole.physics.wheels.angle
        assert parts.sensors.gyro == pytest.approx(whole.sensors.gyro, abs=1e-6)
        assert parts.sensors.acc == pytest.approx(whole.sensors.acc, abs=0.01)
    assert float(parts.physics.body.vel[0]) > 0.3


def test_hard_ground_supports_from_the_first_tick_on() -> None:
    views = silent("erle_copter", COPTER)
    v = views[1]
    settle(v.physics.obstacles)
    for _ in range(20):
        copter.begin(views, 1)
        v.physics.motion.contact = (0.0, 0.0, -GRAVITY * 0.0025)  # what held it against gravity
        copter.sense(views, 1)
        assert v.sensors.acc == pytest.approx((0.0, 0.0, -GRAVITY), abs=1e-4)


def test_an_impact_is_shown_whole_but_not_at_once() -> None:
    views = silent("erle_copter", COPTER)
    v = views[1]
    v.physics.body.vel = (2.0, 0.0, 0.0)
    shown = 0.0
    for k in range(200):
        copter.begin(views, 1)
        if k == 3:
            v.physics.body.vel = (0.0, 0.0, 0.0)
            v.physics.motion.contact = (-2.0, 0.0, 0.0)
        copter.sense(views, 1)
        shown += float(v.physics.body.acc_ned[0]) * 0.0025
        assert abs(float(v.physics.body.acc_ned[0])) < 2.0 / 0.0025 / 5.0
    assert shown == pytest.approx(-2.0, abs=1e-3)
