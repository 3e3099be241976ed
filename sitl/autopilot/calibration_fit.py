# SPDX-License-Identifier: BSD-3-Clause
"""Offsets, scales and matrices with which samples of a sensor have the length that they should have."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..core.constants import GRAVITY
from ..core.sums import least_squares, lengths, matrix_product, products

Samples = np.ndarray[Any, Any]
"""One sample a row."""
_ROUNDS = 30
_PAIRS = ((0, 1), (0, 2), (1, 2))


class CompassFit(NamedTuple):
    """Calibration of a compass."""

    offset: tuple[float, float, float]
    """Added to what it shows [mGauss]."""
    diagonal: tuple[float, float, float]
    others: tuple[float, float, float]
    """Elements xy, xz, yz."""
    fitness: float
    """Root of the mean squared error [mGauss]."""
    radius: float
    """Of the sphere nearest to the samples [mGauss]."""


class AccelerometerFit(NamedTuple):
    """Calibration of an accelerometer."""

    offset: tuple[float, float, float]
    """Taken off what it shows [m/s^2]."""
    scale: tuple[float, float, float]
    fitness: float
    """Root of the mean squared error [m/s^2]."""


def sphere(samples: Samples) -> tuple[Samples, float]:
    """Centre and radius of the sphere nearest to samples (algebraic least squares)."""
    rows = np.column_stack((2.0 * samples, np.ones(len(samples))))
    found = least_squares(rows, (samples * samples).sum(axis=1))
    centre = found[:3]
    return centre, float(np.sqrt(max(found[3] + products(centre, centre), 0.0)))


def fit_compass(samples: Samples, strength: float | None) -> CompassFit:
    """Offset and symmetric matrix that put samples [mGauss] onto a sphere.

    Args:
        samples: from all directions.
        strength: of the earth's field there [mGauss]; None: that of the sphere nearest to the samples.
    """
    centre, radius = sphere(samples)
    wanted = radius if strength is None else strength
    start = np.concatenate((-centre, np.full(3, wanted / max(radius, 1e-3)), np.zeros(3)))
    p, error = _gauss_newton(samples, start, wanted)
    return CompassFit(_three(p[:3]), _three(p[3:6]), _three(p[6:]), error, radius)


def fit_accelerometer(samples: Samples) -> AccelerometerFit:
    """Offset and scale with which six samples at rest [m/s^2], in as many attitudes, are as long as gravity."""
    start = np.concatenate((-sphere(samples)[0], np.ones(3)))
    p, error = _gauss_newton(samples, start, GRAVITY)
    return AccelerometerFit(_three(-p[:3]), _three(p[3:6]), error)


def _three(values: Samples) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z


def _gauss_newton(samples: Samples, start: Samples, length: float) -> tuple[Samples, float]:
    """Offset, diagonal and (where ``start`` has them) other elements that make samples ``length`` long; the error."""
    p = start
    for _ in range(_ROUNDS):
        moved, bent, reached = _bent(samples, p)
        along = bent / reached[:, None]
        columns = [matrix_product(along, _matrix(p)), along * moved]
        if len(p) > 6:
            columns.append(np.column_stack([along[:, i] * moved[:, j] + along[:, j] * moved[:, i] for i, j in _PAIRS]))
        step = least_squares(np.hstack(columns), length - reached)
        p = p + step
        if np.abs(step).max() < 1e-9 * length:
            break
    error = _bent(samples, p)[2] - length
    return p, float(np.sqrt((error * error).mean()))


def _matrix(p: Samples) -> Samples:
    matrix = np.diag(p[3:6])
    for (i, j), value in zip(_PAIRS, p[6:], strict=False):
        matrix[i, j] = matrix[j, i] = value
    return matrix


def _bent(samples: Samples, p: Samples) -> tuple[Samples, Samples, Samples]:
    moved = samples + p[:3]
    bent = matrix_product(moved, _matrix(p))
    return moved, bent, np.maximum(lengths(bent), 1e-6)
