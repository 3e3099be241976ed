# SPDX-License-Identifier: BSD-3-Clause
"""Vibration of the rotors (SIM_VIB_MOT_*) in what the IMUs show."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from pytest import approx

from sitl.core.constants import TICK_S
from sitl.core.vectors import Vec3
from sitl.physics.native.copter import vibration
from sitl.simulation import Simulation
from sitl.vehicle.copter import apply_sim_parameters
from sitl.vehicles.properties.multicopter import THRUST_MOMENTUM

TICKS = 400


def shown(name: str, speeds: tuple[float, ...] = (0.4, 0.4, 0.6, 0.6), **values: float) -> Any:
    """What an IMU shows besides in a second, with rotors at shares of 100 Hz, shape (TICKS,)."""
    v: Any = Simulation("ardupilot_quad").v
    for parameter, value in {"SIM_VIB_MOT_MAX": 100.0, **values}.items():
        setattr(v.autopilot.params, parameter, value)
    apply_sim_parameters(v)
    rotors, properties = v.physics.rotors, v.physics.airframe
    rotors.speed[:4] = (1.0 if properties.thrust_model == THRUST_MOMENTUM else properties.speed_max) * np.array(speeds)
    found = []
    for _ in range(TICKS):
        setattr(v.sensors, name, Vec3(0.0, 0.0, 0.0))
        if rotors.shakes:
            vibration.shake(rotors, v.sensors, properties)
        found.append(getattr(v.sensors, name))
    assert all(each.x == each.y == each.z for each in found)
    return np.array([each.x for each in found])


def lines(samples: Any) -> dict[int, float]:
    """Frequencies [Hz] of the sines in a second of samples, and their amplitudes."""
    amplitudes = np.abs(np.fft.rfft(samples)) * 2.0 / len(samples)
    hz = np.arange(len(amplitudes)) / (TICKS * TICK_S)
    mean = np.sinc(hz * TICK_S)  # what the mean over a tick leaves of a sine
    return {round(f): float(a / m) for f, a, m in zip(hz, amplitudes, mean, strict=True) if a > 0.01}


def test_each_rotor_adds_a_sine_of_its_speed() -> None:
    all_four = (0.3, 0.4, 0.5, 0.6)
    for name, values, amplitude in (
        ("acc", {"SIM_ACC1_RND": 0.5}, 0.5),
        ("acc", {"SIM_ACC1_RND": 0.5, "SIM_VIB_MOT_MULT": 3.0}, 1.5),
        ("gyro", {"SIM_GYR1_RND": 5.0}, math.radians(5.0)),
    ):
        assert lines(shown(name, all_four, **values)) == dict.fromkeys((30, 40, 50, 60), approx(amplitude, rel=1e-3))


def test_rotors_of_the_same_speed_add_up_as_if_unrelated() -> None:
    assert lines(shown("acc", (0.5, 0.5, 0.5, 0.5), SIM_ACC1_RND=0.5)) == {50: approx(0.5 * math.sqrt(4.0), rel=1e-3)}


def test_some_rotors_alone() -> None:
    half = approx(0.5, rel=1e-3)
    assert lines(shown("acc", SIM_ACC1_RND=0.5, SIM_VIB_MOT_MASK=5)) == {40: half, 60: half}
    assert list(lines(shown("acc", SIM_ACC1_RND=0.5, SIM_VIB_MOT_MASK=3))) == [40]


def test_multiples_of_their_speed() -> None:
    assert list(lines(shown("acc", SIM_ACC1_RND=1.0, SIM_VIB_MOT_HMNC=2))) == [80, 120]
    assert list(lines(shown("acc", SIM_ACC1_RND=1.0, SIM_VIB_MOT_HMNC=3))) == [40, 60, 80, 120]


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("acc", {}), ("acc", {"SIM_ACC2_RND": 1.0}), ("acc2", {"SIM_ACC1_RND": 1.0}), ("gyro", {"SIM_ACC1_RND": 1.0}),
        ("acc", {"SIM_ACC1_RND": 1.0, "SIM_ACC_FAIL_MSK": 1}), ("acc", {"SIM_ACC1_RND": 1.0, "SIM_ACCEL1_FAIL": 3.0}),
        ("gyro", {"SIM_GYR1_RND": 1.0, "SIM_GYR_FAIL_MSK": 1}), ("acc", {"SIM_ACC1_RND": 1.0, "SIM_VIB_MOT_MAX": 0.0}),
    ],
)  # fmt: skip
def test_what_has_no_noise_or_sends_nothing_shows_none(name: str, values: dict[str, float]) -> None:
    assert not shown(name, **values).any()


def test_the_second_imu() -> None:
    assert list(lines(shown("acc2", SIM_ACC2_RND=1.0))) == [40, 60]
    assert list(lines(shown("gyro2", SIM_GYR2_RND=1.0))) == [40, 60]


def test_vibration_takes_the_place_of_white_noise() -> None:
    v: Any = Simulation("ardupilot_quad").v
    v.autopilot.params.SIM_ACC1_RND = 1.0
    apply_sim_parameters(v)
    assert v.physics.sensors.imus[0].acc_noise == 1.0
    v.autopilot.params.SIM_VIB_MOT_MAX = 100.0
    apply_sim_parameters(v)
    assert v.physics.sensors.imus[0].acc_noise == 0.0
