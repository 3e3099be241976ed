# SPDX-License-Identifier: BSD-3-Clause
"""The elementary functions (``elementary``) as kernels on lines of numbers; ``elementary_arrays`` calls them."""

from __future__ import annotations

from .array_kernels import Kernel, Line
from .elementary import acos, asin, atan2, cos, hypot, pow, sin
from .kernels import law


@law
def write_sin(x: Line, out: Line) -> None:
    """Of each number."""
    for k in range(len(x)):
        out[k] = sin(x[k])


@law
def write_cos(x: Line, out: Line) -> None:
    """Of each number."""
    for k in range(len(x)):
        out[k] = cos(x[k])


@law
def write_asin(x: Line, out: Line) -> None:
    """Of each number."""
    for k in range(len(x)):
        out[k] = asin(x[k])


@law
def write_acos(x: Line, out: Line) -> None:
    """Of each number."""
    for k in range(len(x)):
        out[k] = acos(x[k])


@law
def write_atan2(y: Line, x: Line, out: Line) -> None:
    """Of each pair of numbers."""
    for k in range(len(x)):
        out[k] = atan2(y[k], x[k])


@law
def write_hypot(x: Line, y: Line, out: Line) -> None:
    """Of each pair of numbers."""
    for k in range(len(x)):
        out[k] = hypot(x[k], y[k])


@law
def write_pow(x: Line, y: Line, out: Line) -> None:
    """Of each pair of numbers."""
    for k in range(len(x)):
        out[k] = pow(x[k], y[k])


sines, cosines = Kernel(write_sin), Kernel(write_cos)
arcsines, arccosines = Kernel(write_asin), Kernel(write_acos)
angles, lengths, powers = Kernel(write_atan2), Kernel(write_hypot), Kernel(write_pow)
