# SPDX-License-Identifier: BSD-3-Clause
"""Our physics behind the Python interface of Paparazzi's NPS, with NPS's arithmetic in the test."""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
import pytest

from sitl.core.algebra import Euler, Quat, Vec3, quat_from_euler, rotate_inverse
from sitl.errors import OptionError
from sitl.foreign.paparazzi import BulletFDM

HOVER = 4 * [0.42]
DT = 0.0025


def risen(made):
    """A model after half a second of climb."""
    for _ in range(200):
        made.step(4 * [0.9])
    assert made._body.pos.z < -0.5
    return made


class Nps:
    """What Paparazzi's nps_fdm_pybullet.c makes of an answer; quaternions as w, x, y, z."""

    def __init__(self, answer):
        self.pos, self.vel, accel = (ned(answer[name]) for name in ("pos", "vel", "accel"))
        x, y, z, w = answer["quat"]
        half = math.sqrt(0.5)
        self.q = np.array(product((w, y, x, -z), (half, 0.0, 0.0, half)))
        self.accelerometer = self.to_body(accel - np.array([0.0, 0.0, 10.0]))
        self.gyro = self.to_body(ned(answer["ang_v"]))

    def to_body(self, v):
        return np.array(tuple(rotate_inverse(Quat(*self.q.tolist()), Vec3(*v.tolist()))))


def ned(enu):
    return np.array([enu[1], enu[0], -enu[2]])


def product(a, b):
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw,
    )  # fmt: skip


def test_nps_gets_the_true_motion():
    model = risen(BulletFDM(DT, GUI=True, urdf="erle_copter"))
    body = model._body
    body.q = quat_from_euler(Euler(0.3, -0.2, 1.0))
    body.vel, body.rates = Vec3(1.0, 2.0, -3.0), Vec3(0.4, -0.5, 0.6)
    for _ in range(4):
        got = Nps(model.step(HOVER))
    assert body.q.w < 0.95 and body.vel.x > 0.8 and body.rates.z > 0.4
    assert got.pos == pytest.approx(tuple(body.pos)) and got.vel == pytest.approx(tuple(body.vel))
    assert abs(got.q @ np.array(tuple(body.q))) == pytest.approx(1.0)
    assert got.gyro == pytest.approx(tuple(body.rates))
    assert got.accelerometer == pytest.approx(tuple(body.specific_force), abs=0.02)  # a mean over turning axes


def test_at_rest_an_accelerometer_measures_the_weight():
    got = Nps(BulletFDM(4 * DT).step(4 * [0.0]))
    assert got.accelerometer == pytest.approx([0.0, 0.0, -9.80665], abs=1e-6)


def test_a_step_is_a_whole_number_of_ticks():
    model = BulletFDM(2 * DT)
    model.step(4 * [0.9])
    assert model._plant.vehicle.v.time_us == 5000
    for _ in range(99):
        answer = model.step(4 * [0.9])
    assert answer["pos"][2] > 0.1 and answer["vel"][2] > 0.5  # up it goes
    with pytest.raises(OptionError, match=r"0.00195312 s is no whole number of 0.0025 s: set SYS_TIME_FREQUENCY"):
        BulletFDM(1 / 512)


def test_the_first_rotor_is_front_right():
    model = risen(BulletFDM(DT))
    for _ in range(20):
        answer = model.step([0.5, 0.4, 0.4, 0.5])  # front right, rear left, front left, rear right
    assert Nps(answer).gyro[0] < -0.1  # more thrust on the right: it rolls to the left


def test_a_class_of_ones_own_chooses_the_scenario():
    class Windy(BulletFDM):
        options: ClassVar = {"params": {"SIM_WIND_SPD": 6, "SIM_WIND_DIR": 270}}

    model = risen(Windy(DT))
    for _ in range(200):
        answer = model.step(HOVER)
    assert answer["vel"][0] > 0.2  # to the east
    with pytest.raises(OptionError, match="airframe erle_rover is a rover: this interface has copters"):
        BulletFDM(DT, urdf="erle_rover")
