# SPDX-License-Identifier: BSD-3-Clause
"""Vectors, quaternions and Euler angles as values.

A value is made, passed and returned; it is never changed in place. In plain Python each is a tuple; inside the compiled
core it is a few numbers in registers (``numba_vectors``), with the same operations in the same order, so that both give
the same bits. Fields of records that are declared as one of these types read and write as values (``records``).

Conventions: NED world frame, FRD body frame, Hamilton quaternions that turn body into NED, angles in radians.
"""

from __future__ import annotations

from operator import itemgetter
from typing import Any, ClassVar, Self


class Value(tuple[float, ...]):
    """Base of the fixed-size values: addition and subtraction by component, multiplication and division by a number."""

    __slots__ = ()
    NAMES: ClassVar[tuple[str, ...]]
    """Names of the components, in the order of memory."""

    def __add__(self, other: Self) -> Self:  # type: ignore[override]
        return tuple.__new__(type(self), [a + b for a, b in zip(self, other, strict=True)])

    def __sub__(self, other: Self) -> Self:
        return tuple.__new__(type(self), [a - b for a, b in zip(self, other, strict=True)])

    def __neg__(self) -> Self:
        return tuple.__new__(type(self), [-a for a in self])

    def __mul__(self, k: float) -> Self:  # type: ignore[override]
        return tuple.__new__(type(self), [a * k for a in self])

    def __rmul__(self, k: float) -> Self:  # type: ignore[override]
        return tuple.__new__(type(self), [k * a for a in self])

    def __truediv__(self, k: float) -> Self:
        return tuple.__new__(type(self), [a / k for a in self])

    def replace(self, **components: float) -> Self:
        """A copy in which the components named are changed (in plain Python, not in laws)."""
        return type(self)(**{name: components.pop(name, value) for name, value in zip(self.NAMES, self)}, **components)

    def __repr__(self) -> str:
        parts = ", ".join(f"{name}={value!r}" for name, value in zip(self.NAMES, self, strict=True))
        return f"{type(self).__name__}({parts})"

    def __getnewargs__(self) -> Any:
        return tuple(self)


def _component(k: int) -> Any:
    return property(itemgetter(k))  # no Python frame for a read


class Vec2(Value):
    """A vector in the plane: north and east, or forward and right."""

    __slots__ = ()
    NAMES = ("x", "y")
    x: float = _component(0)
    y: float = _component(1)

    def __new__(cls, x: float, y: float) -> Self:
        return tuple.__new__(cls, (float(x), float(y)))


class Vec3(Value):
    """A vector in space: north, east, down, or forward, right, down."""

    __slots__ = ()
    NAMES = ("x", "y", "z")
    x: float = _component(0)
    y: float = _component(1)
    z: float = _component(2)

    def __new__(cls, x: float, y: float, z: float) -> Self:
        return tuple.__new__(cls, (float(x), float(y), float(z)))


class Euler(Value):
    """Roll, pitch and yaw [rad]: the rotation yaw about z, then pitch about y, then roll about x."""

    __slots__ = ()
    NAMES = ("roll", "pitch", "yaw")
    roll: float = _component(0)
    pitch: float = _component(1)
    yaw: float = _component(2)

    def __new__(cls, roll: float, pitch: float, yaw: float) -> Self:
        return tuple.__new__(cls, (float(roll), float(pitch), float(yaw)))


class Quat(Value):
    """A Hamilton quaternion (w, x, y, z); body to NED unless a line says otherwise."""

    __slots__ = ()
    NAMES = ("w", "x", "y", "z")
    w: float = _component(0)
    x: float = _component(1)
    y: float = _component(2)
    z: float = _component(3)

    def __new__(cls, w: float, x: float, y: float, z: float) -> Self:
        return tuple.__new__(cls, (float(w), float(x), float(y), float(z)))


VALUES: tuple[type[Value], ...] = (Vec2, Vec3, Euler, Quat)
