# SPDX-License-Identifier: BSD-3-Clause
"""What two IMUs and three compasses show when something is wrong with them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pytest import approx

from sitl.autopilot.params.simulation import DELIVERED
from sitl.core.border import ACC_SILENT, GYRO_SILENT, IMUS_DIFFER
from sitl.core.vectors import Vec3
from sitl.physics.native.sensors import imu, imu_faults, magnetometer
from sitl.simulation import Simulation
from sitl.vehicle.sim_parameters import apply


@pytest.fixture
def vehicle():
    """At power-on; ``set(SIM_ACC1_BIAS_X=1)`` and ``sample()``."""

    class Vehicle:
        v = Simulation("ardupilot_quad").v

        def set(self, **values: float) -> None:
            for name, value in values.items():
                setattr(self.v.autopilot.params, name, value)
            apply(self.v)

        def sample(self) -> None:
            imu.sample(self.v.physics, self.v.sensors, self.v.rng)

    return Vehicle()


def test_imus_differ_by_their_faults_alone(vehicle) -> None:
    s = vehicle.v.sensors
    vehicle.set(SIM_ACC2_BIAS_X=1.0, SIM_GYR2_BIAS_Z=-0.5, SIM_ACC1_BIAS_Y=2.0)
    vehicle.sample()
    assert s.imu_state == IMUS_DIFFER
    assert np.array(s.acc2) - np.array(s.acc) == approx([1.0, -2.0, 0.0], abs=1e-5)
    assert np.array(s.gyro2) - np.array(s.gyro) == approx([0.0, 0.0, -0.5], abs=1e-6)


def test_imus_with_the_same_fault_do_not_differ(vehicle) -> None:
    vehicle.set(SIM_ACC1_BIAS_X=1.0, SIM_ACC2_BIAS_X=1.0)
    vehicle.sample()
    assert vehicle.v.sensors.imu_state == 0
    assert vehicle.v.sensors.acc.x == approx(1.0, abs=0.2)
    vehicle.set(SIM_ACC1_BIAS_X=0.0, SIM_ACC2_BIAS_X=0.0)
    assert not vehicle.v.physics.sensors.imus_faulty


@pytest.mark.parametrize("mask", [1, 2, 3])
def test_what_is_silent_keeps_its_last_sample(vehicle, mask: int) -> None:
    s = vehicle.v.sensors
    vehicle.set(SIM_ACC_FAIL_MSK=mask, SIM_GYR_FAIL_MSK=mask)
    s.acc = s.acc2 = s.gyro = s.gyro2 = Vec3(9.0, 9.0, 9.0)
    vehicle.sample()
    assert s.imu_state == IMUS_DIFFER | mask * (ACC_SILENT | GYRO_SILENT)
    assert [v.x == 9.0 for v in (s.acc, s.gyro, s.acc2, s.gyro2)] == [bool(mask & 1)] * 2 + [bool(mask & 2)] * 2


def test_scale_and_stuck(vehicle) -> None:
    v = vehicle.v
    v.physics.body.rates_mean = Vec3(0.0, 0.0, 2.0)
    vehicle.set(SIM_GYR1_SCALE_Z=10.0, SIM_ACCEL2_FAIL=-3.0)
    vehicle.sample()
    assert v.sensors.gyro.z - v.sensors.gyro2.z == approx(0.2, abs=1e-6)
    assert tuple(v.sensors.acc2) == (-3.0, -3.0, -3.0)


def test_noise_shakes_while_motors_turn(vehicle) -> None:
    v = vehicle.v
    vehicle.set(SIM_ACC1_RND=5.0, SIM_GYR2_RND=20.0)

    def spread(name: str) -> float:
        shown = []
        for k in range(400):
            v.sensors.time_us = 2500 * k
            vehicle.sample()
            shown.append(getattr(v.sensors, name).x)
        return float(np.std(shown))

    quiet, quiet_gyro = spread("acc"), spread("gyro2")
    v.physics.battery.current = 20.0
    assert spread("acc") == approx(0.5, rel=0.2) and quiet < 0.1
    assert spread("gyro2") == approx(0.1 * math.radians(20.0), rel=0.2) and quiet_gyro < 0.01
    vehicle.set(SIM_VIB_FREQ_X=90.0, SIM_VIB_FREQ_Y=90.0, SIM_VIB_FREQ_Z=90.0)
    turn = math.pi * 90.0 / 400.0
    assert spread("acc") == approx(5.0 / math.sqrt(2.0) * math.sin(turn) / turn, rel=0.05)


def test_a_wave_is_the_mean_over_its_tick() -> None:
    fine = [math.sin(2.0 * math.pi * 60.0 * (0.0975 + 0.0025 * (k + 0.5) / 1000.0)) for k in range(1000)]
    assert imu_faults.wave(60.0, 0.1) == approx(float(np.mean(fine)), abs=1e-6)
    assert imu_faults.wave(0.0, 0.1) == 0.0


def test_compasses_fail_and_are_disturbed(vehicle) -> None:
    v, s = vehicle.v, vehicle.v.sensors
    vehicle.set(SIM_MAG1_FAIL=1, SIM_MAG3_FAIL=1)
    count, before = s.mag_count, tuple(s.mag)
    magnetometer.sample(v.physics, s, v.rng, 70_000)
    assert (s.mag_count, tuple(s.mag)) == (count, before)
    assert list(s.mag_us[:]) == [0, 70_000, 0]
    vehicle.set(SIM_MAG1_FAIL=0, SIM_MAG3_FAIL=0, SIM_MAG2_SCALING=1.5)
    magnetometer.sample(v.physics, s, v.rng, 80_000)
    corrected = np.array(s.mag2) + 1e-3 * np.array(DELIVERED)
    assert corrected == approx(1.5 * np.array(s.mag), abs=1e-5)
    vehicle.set(SIM_MAG2_SCALING=1.0, SIM_MAG_MOT_X=10.0)
    quiet = np.array(s.mag)
    v.physics.battery.current = 30.0
    magnetometer.sample(v.physics, s, v.rng, 90_000)
    assert np.array(s.mag) - quiet == approx([0.3, 0.0, 0.0], abs=0.02)
