# SPDX-License-Identifier: BSD-3-Clause
"""Vectors, rotations and wrapped angles: invariants on any input, and the conventions (FRD to NED, Z-Y-X)."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.core import algebra as al
from sitl.core import scalars
from sitl.core.vectors import Euler, Quat, Vec2, Vec3

angle = st.floats(-math.pi, math.pi)
component = st.floats(-100.0, 100.0)
vectors = st.builds(Vec3, component, component, component)


@given(angle, st.floats(-1.5, 1.5), angle)
def test_euler_and_back(roll: float, pitch: float, yaw: float) -> None:
    again = al.euler_of(al.quat_from_euler(Euler(roll, pitch, yaw)))
    assert abs(scalars.wrap_pi(again.roll - roll)) < 1e-6
    assert abs(again.pitch - pitch) < 1e-6
    assert abs(scalars.wrap_pi(again.yaw - yaw)) < 1e-6


@given(angle, st.floats(-1.57, 1.57), angle, vectors)
def test_rotation_keeps_length_and_inverts(roll: float, pitch: float, yaw: float, v: Vec3) -> None:
    q = al.quat_from_euler(Euler(roll, pitch, yaw))
    turned = al.rotate(q, v)
    assert al.norm(turned) == pytest.approx(al.norm(v), abs=1e-9)
    assert al.rotate_inverse(q, turned) == pytest.approx(v, abs=1e-9)


@given(st.floats(-3.1, 3.1), vectors)
def test_rotation_vector(length: float, v: Vec3) -> None:
    if al.norm(v) < 1e-3:
        return
    axis = v / al.norm(v)
    whole, half = (al.quat_from_rotation_vector(axis * (k * length)) for k in (1.0, 0.5))
    assert al.multiply(half, half) == pytest.approx(whole, abs=1e-9)
    assert al.rotate(whole, axis) == pytest.approx(axis, abs=1e-9)
    assert 2.0 * math.acos(min(abs(whole.w), 1.0)) == pytest.approx(abs(length), abs=1e-6)


@given(vectors, vectors)
def test_products(a: Vec3, b: Vec3) -> None:
    assert al.dot(al.cross(a, b), a) == pytest.approx(0.0, abs=1e-6)
    assert al.cross(a, b) == -al.cross(b, a)
    assert al.dot(a, a) == pytest.approx(al.norm(a) ** 2)
    assert al.cross2(al.horizontal(a), al.horizontal(b)) == al.cross(a, b).z


@given(component, component, st.floats(0.0, 100.0))
def test_length_is_limited_and_direction_kept(x: float, y: float, length_max: float) -> None:
    v = Vec2(x, y)
    limited = al.limit_length(v, length_max)
    assert al.norm2(limited) <= length_max + 1e-9
    assert al.cross2(v, limited) == pytest.approx(0.0, abs=1e-6)
    if al.norm2(v) <= length_max:
        assert limited == v


@given(st.floats(-1e6, 1e6))
def test_wraps(a: float) -> None:
    assert -math.pi <= scalars.wrap_pi(a) < math.pi + 1e-9
    assert -1e-9 < scalars.wrap_2pi(a) < 2.0 * math.pi + 1e-9
    assert math.cos(scalars.wrap_pi(a)) == pytest.approx(math.cos(a), abs=1e-6)


def test_conventions() -> None:
    assert al.quat_from_rotation_vector(Vec3(0, 0, 0.5)) == pytest.approx(al.quat_from_euler(Euler(0.0, 0.0, 0.5)))
    nose_up, nose_east = al.quat_from_euler(Euler(0.0, 0.1, 0.0)), al.quat_from_euler(Euler(0.0, 0.0, math.pi / 2))
    forward = Vec3(1.0, 0.0, 0.0)
    assert al.rotate(nose_up, forward).z < 0.0, "nose up: the body's x axis points up, which is -down"
    assert al.rotate(nose_east, forward) == pytest.approx((0.0, 1.0, 0.0)), "yaw 90 deg: nose east"
    first_yaw_then_roll = al.multiply(nose_east, al.quat_from_euler(Euler(0.3, 0.0, 0.0)))
    assert al.euler_of(first_yaw_then_roll) == pytest.approx((0.3, 0.0, math.pi / 2))
    assert al.turned(Vec2(1.0, 0.0), math.pi / 2) == pytest.approx((0.0, 1.0)), "from north towards east"


def test_zero_quaternions_are_the_identity() -> None:
    assert al.normalise(Quat(0.0, 0.0, 0.0, 0.0)) == al.IDENTITY
    assert al.quat_from_rotation_vector(al.ZERO) == al.IDENTITY


def test_constrain_takes_nan_to_the_middle() -> None:
    assert scalars.constrain(math.nan, -1.0, 3.0) == 1.0
    assert [scalars.constrain(x, -1.0, 3.0) for x in (-5.0, 0.0, 5.0)] == [-1.0, 0.0, 3.0]


@given(st.tuples(*[st.floats(-3.0, 3.0)] * 3), st.tuples(*[st.floats(-9.0, 9.0)] * 3))
def test_the_matrix_of_a_rotation_turns_as_its_quaternion_does(turn: tuple[float, ...], v: tuple[float, ...]) -> None:
    q = al.quat_from_rotation_vector(Vec3(*turn))
    assert al.apply(al.rotation_matrix(q), Vec3(*v)) == pytest.approx(al.rotate(q, Vec3(*v)), abs=1e-9)


def test_one_component_is_replaced_in_a_copy() -> None:
    v = Vec3(1.0, 2.0, 3.0)
    assert v.replace(y=5.0) == (1.0, 5.0, 3.0) and v.y == 2.0
    with pytest.raises(TypeError):
        v.replace(yaw=1.0)


def test_values_are_tuples_with_arithmetic() -> None:
    v = Vec3(1.0, 2.0, 3.0)
    assert v + v == v * 2.0 == 2.0 * v == Vec3(2.0, 4.0, 6.0)
    assert v - v == al.ZERO
    assert -v / 2.0 == (-0.5, -1.0, -1.5)
    assert (v.x, v.y, v.z) == tuple(v)
    assert repr(v) == "Vec3(x=1.0, y=2.0, z=3.0)"
    with pytest.raises(AttributeError):
        v.x = 5.0
