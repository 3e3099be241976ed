# SPDX-License-Identifier: BSD-3-Clause
"""Rotations: invariants on any input, and the conventions (FRD to NED, Z-Y-X)."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core import rotations as rot

angle = st.floats(-math.pi, math.pi)
component = st.floats(-100.0, 100.0)


@given(angle, st.floats(-1.5, 1.5), angle)
def test_euler_and_back(roll: float, pitch: float, yaw: float) -> None:
    r, p, y = rot.quat_to_euler(*rot.quat_from_euler(roll, pitch, yaw))
    assert abs(rot.wrap_pi(r - roll)) < 1e-6
    assert abs(p - pitch) < 1e-6
    assert abs(rot.wrap_pi(y - yaw)) < 1e-6


@given(angle, st.floats(-1.57, 1.57), angle, component, component, component)
def test_rotation_keeps_length_and_inverts(roll, pitch, yaw, x, y, z) -> None:
    q = rot.quat_from_euler(roll, pitch, yaw)
    v = rot.quat_rotate(*q, x, y, z)
    assert math.hypot(*v) == pytest.approx(math.hypot(x, y, z), abs=1e-9)
    assert rot.quat_rotate_inverse(*q, *v) == pytest.approx((x, y, z), abs=1e-9)


@given(st.floats(-3.1, 3.1), component, component, component)
def test_rotation_vector(length: float, x: float, y: float, z: float) -> None:
    n = math.hypot(x, y, z)
    if n < 1e-3:
        return
    axis = (x / n, y / n, z / n)
    whole, half = (rot.quat_from_rotation_vector(*(k * length * c for c in axis)) for k in (1.0, 0.5))
    assert rot.quat_multiply(*half, *half) == pytest.approx(whole, abs=1e-9)
    assert rot.quat_rotate(*whole, *axis) == pytest.approx(axis, abs=1e-9)
    assert 2.0 * math.acos(min(abs(whole[0]), 1.0)) == pytest.approx(abs(length), abs=1e-6)


@given(st.floats(-1e6, 1e6))
def test_wraps(a: float) -> None:
    assert -math.pi <= rot.wrap_pi(a) < math.pi + 1e-9
    assert -1e-9 < rot.wrap_2pi(a) < 2.0 * math.pi + 1e-9
    assert math.cos(rot.wrap_pi(a)) == pytest.approx(math.cos(a), abs=1e-6)


def test_conventions() -> None:
    assert rot.quat_from_rotation_vector(0.0, 0.0, 0.5) == pytest.approx(rot.quat_from_euler(0.0, 0.0, 0.5))
    nose_up = rot.quat_from_euler(0.0, 0.1, 0.0)
    assert rot.quat_rotate(*nose_up, 1.0, 0.0, 0.0)[2] < 0.0, "nose up: the body's x axis points up, which is -down"
    right = rot.quat_from_euler(0.0, 0.0, math.pi / 2)
    assert rot.quat_rotate(*right, 1.0, 0.0, 0.0) == pytest.approx((0.0, 1.0, 0.0)), "yaw 90 deg: nose east"
    first_yaw_then_roll = rot.quat_multiply(*right, *rot.quat_from_euler(0.3, 0.0, 0.0))
    assert rot.quat_to_euler(*first_yaw_then_roll) == pytest.approx((0.3, 0.0, math.pi / 2))


def test_constrain_takes_nan_to_the_middle() -> None:
    assert rot.constrain(math.nan, -1.0, 3.0) == 1.0
    assert [rot.constrain(x, -1.0, 3.0) for x in (-5.0, 0.0, 5.0)] == [-1.0, 0.0, 3.0]
