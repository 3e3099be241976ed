# SPDX-License-Identifier: BSD-3-Clause
"""Sums of products of arrays in a fixed order: the same bits on any processor.

NumPy gives products of matrices and vectors (``@``, ``dot``, ``norm`` of one vector) and the solution of equations to a
BLAS, which adds up in an order of its own on each kind of processor. Its sums do not: their order depends on the
array's shape alone, and so these functions multiply first and sum then.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def separation(a: Iterable[float], b: Iterable[float]) -> float:
    """Distance between two points of as many coordinates, in their unit.

    Raises:
        ValueError: one has more coordinates.
    """
    total = 0.0
    for p, q in zip(a, b, strict=True):
        total += (p - q) * (p - q)
    return math.sqrt(total)


def products(a: npt.ArrayLike, b: npt.ArrayLike) -> Any:
    """Scalar products of vectors along the last axis, shape of the others."""
    return np.add.reduce(np.multiply(a, b), axis=-1)


def lengths(vectors: npt.ArrayLike) -> Any:
    """Lengths of vectors along the last axis, shape of the others, in their unit."""
    return np.sqrt(np.add.reduce(np.square(vectors), axis=-1))


def matrix_product(a: Floats, b: Floats) -> Floats:
    """Product of a matrix, shape (m, k), and another, shape (k, n)."""
    out: Floats = np.add.reduce(a[:, :, None] * b[None, :, :], axis=1)
    return out


def least_squares(rows: Floats, values: Floats) -> Floats:
    """What multiplies the columns of ``rows``, shape (m, n), so that they come nearest to ``values``, shape (m,).

    By Householder reflections (Golub and Van Loan, "Matrix Computations", 5.3), columns with the longest rest first.
    What no row tells apart stays 0.
    """
    a, y = np.array(rows, np.float64, order="C"), np.array(values, np.float64)
    count = min(a.shape)
    order = list(range(a.shape[1]))
    limit = 0.0
    rank = 0
    for k in range(count):
        rest = np.add.reduce(a[k:, k:] * a[k:, k:], axis=0)
        pick = k + int(np.argmax(rest))
        a[:, [k, pick]] = a[:, [pick, k]]
        order[k], order[pick] = order[pick], order[k]
        length = math.sqrt(float(rest[pick - k]))
        limit = max(limit, length * max(a.shape) * float(np.finfo(np.float64).eps))
        if length <= limit:
            break
        mirror = a[k:, k].copy()
        mirror[0] += math.copysign(length, mirror[0])
        scale = 2.0 / float(np.add.reduce(mirror * mirror))
        a[k:, k:] -= mirror[:, None] * (scale * np.add.reduce(mirror[:, None] * a[k:, k:], axis=0))
        y[k:] -= mirror * (scale * float(np.add.reduce(mirror * y[k:])))
        rank = k + 1
    found = np.zeros(a.shape[1])
    for k in reversed(range(rank)):
        known = float(np.add.reduce(a[k, k + 1 : rank] * found[k + 1 : rank]))
        found[k] = (y[k] - known) / a[k, k]
    out = np.zeros(a.shape[1])
    out[order] = found
    return out
