# SPDX-License-Identifier: BSD-3-Clause
"""Steps repeat, compiled and plain give the same bits; SIM_ parameters that break things."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from sitl.core import records
from sitl.core.kernels import jit_disabled
from sitl.physics.native import truth
from sitl.simulation import Core, Simulation


@pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")
@pytest.mark.parametrize("frame", ["ardupilot_quad", "erle_copter"])
def test_compiled_and_plain_python_give_the_same_bits(rig, frame):
    plain, compiled = rig(frame), rig(frame)
    for r in (plain, compiled):
        r.fly(0.3)
        r.p.wind.speed, r.p.wind.direction, r.p.wind.turbulence, r.p.wind.time_constant = 4.0, 30.0, 1.0, 1.0
        r.p.body.rates = (1.0, -0.5, 0.7)
        r.p.derived.gps_start = 5
    controls = 0.55 + 0.1 * np.random.default_rng(1).standard_normal((160, 4))
    controls[80:] = 0.0
    for k, row in enumerate(controls):
        for r in (plain, compiled):
            r.command(*row)
            if k == 100:
                r.p.body.pos, r.p.body.vel = r.p.body.pos.replace(z=-0.02), r.p.body.vel.replace(z=1.5)
        plain.step()
        compiled.step_compiled()
        assert records.first_difference(plain.fleet[0], compiled.fleet[0]) is None
    assert plain.p.ground.state != 0
    assert plain.v.sensors.gps_count > 0


def test_same_seed_same_sensors_other_seed_others(rig):
    a, b, c = rig("erle_copter", seed=5), rig("erle_copter", seed=5), rig("erle_copter", seed=6)
    for r in (a, b, c):
        r.step(20)
    assert records.first_difference(a.fleet[0], b.fleet[0]) is None
    assert list(a.v.sensors.acc) != list(c.v.sensors.acc)


def test_init_again_forgets_everything_but_the_wind_setting(rig):
    r, fresh = rig("erle_copter", seed=2), rig("erle_copter", seed=2)
    r.p.wind.speed = 3.0
    r.fly()
    r.step(10)
    r.power_on(seed=2)
    assert r.p.wind.speed == 3.0
    r.p.wind.speed = 0.0
    r.p.wind.steady = r.p.wind.vel = (0.0, 0.0, 0.0)
    fresh.p.wind.steady = fresh.p.wind.vel = (0.0, 0.0, 0.0)
    assert records.first_difference(r.fleet[0], fresh.fleet[0]) is None


def test_truth_for_the_shell(rig):
    r = rig(heading=353.0)
    r.fly(10.0)
    r.p.body.pos = r.p.body.pos.replace(x=111.31884502145034)
    now = truth.read(r.v)
    assert now.lat == approx(-35.363262 + 0.001, abs=1e-9)
    assert now.alt == approx(594.0)
    assert math.degrees(now.euler[2]) == approx(-7.0)
    assert not now.on_ground


def test_a_receiver_that_is_switched_off_is_silent_and_comes_back(core: Core) -> None:
    simulation = Simulation(core=core)
    simulation.advance(15.0)
    sensors = simulation.v.sensors
    assert int(sensors.gps_fix) == 3
    simulation.v.autopilot.params.SIM_GPS1_ENABLE = 0
    simulation.parameter_changed("SIM_GPS1_ENABLE")
    simulation.advance(1.0)
    count = int(sensors.gps_count)
    simulation.advance(2.0)
    assert int(sensors.gps_count) == count
    assert int(sensors.gps_fix) == 0
    simulation.v.autopilot.params.SIM_GPS1_ENABLE = 1
    simulation.parameter_changed("SIM_GPS1_ENABLE")
    simulation.advance(1.0)
    assert int(sensors.gps_count) > count
    assert int(sensors.gps_fix) == 3


def test_faults_given_at_the_start_and_after_a_reboot(core: Core) -> None:
    faults = {"SIM_ENGINE_FAIL": 6, "SIM_ENGINE_MUL": 0.5, "SIM_RC_FAIL": 1, "SIM_GPS1_ENABLE": 0}
    simulation = Simulation(core=core, params=faults)
    for _ in range(2):
        simulation.advance(12.0)
        assert list(simulation.v.physics.rotors.share[:4]) == [1.0, 0.5, 0.5, 1.0]
        assert int(simulation.v.sensors.gps_count) == 0
        assert int(simulation.v.autopilot.rc.receiver_ok) == 0
        simulation.request_reboot()
