# SPDX-License-Identifier: BSD-3-Clause
"""Courses are those of the simulator's physics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl import vehicles
from sitl.identify.rover.courses import STEP_S, drive


def test_speed_and_curvature_settle_where_the_properties_say() -> None:
    airframe = vehicles.load("erle_rover")
    throttle, steering = np.full((2, 600), 0.8), np.full((2, 600), 0.4)
    courses = drive(airframe.record(), steering, throttle, np.zeros(2), np.zeros(2))
    assert courses.speed[:, -1] == pytest.approx(1.5875, rel=1e-4), "full throttle is 0.8"
    bend = math.tan(0.5 * airframe.value("steering_angle")) / airframe.value("wheelbase")
    assert courses.yaw_rate[0, -1] / courses.speed[0, -1] == pytest.approx(bend, rel=1e-6)
    k = round(0.1 / STEP_S)
    assert courses.speed[0, k] == pytest.approx(2.5 * 0.1, rel=0.15), "by the motors' limit"


def test_a_course_goes_on_from_what_was_measured() -> None:
    airframe = vehicles.load("skid_rover")
    nothing = np.zeros((1, 5))
    courses = drive(airframe.record(), nothing, nothing, np.array([1.0]), np.array([0.5]))
    assert 0.7 < courses.speed[0, 0] < 1.0 and 0.3 < courses.yaw_rate[0, 0] < 0.5
