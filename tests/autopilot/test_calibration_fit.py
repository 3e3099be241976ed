# SPDX-License-Identifier: BSD-3-Clause
"""Calibrations are found from samples, and take back what sensors do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl.autopilot.calibration_fit import fit_accelerometer, fit_compass, sphere
from sitl.autopilot.params.simulation import Axes
from sitl.autopilot.sensor_calibration import corrected_field
from sitl.core.constants import GRAVITY
from sitl.core.vectors import Vec3

OFFSET, DIAGONAL, OTHERS = (100.0, 200.0, -300.0), (1.0, 1.1, 1.2), (0.004, -0.02, 0.03)
STRENGTH = 570.0


def directions(count: int) -> np.ndarray:
    """Unit vectors, all over the sphere (a spiral)."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = math.pi * (3.0 - math.sqrt(5.0)) * np.arange(count)
    flat = np.sqrt(1.0 - z * z)
    return np.column_stack((flat * np.cos(turn), flat * np.sin(turn), z))


def raw_fields(count: int) -> np.ndarray:
    xy, xz, yz = OTHERS
    matrix = np.array(((DIAGONAL[0], xy, xz), (xy, DIAGONAL[1], yz), (xz, yz, DIAGONAL[2])))
    return np.linalg.solve(matrix, STRENGTH * directions(count).T).T - OFFSET


def test_iron_around_a_compass_is_found() -> None:
    fit = fit_compass(raw_fields(200), STRENGTH)
    assert fit.offset == pytest.approx(OFFSET, abs=1e-6)
    assert fit.diagonal == pytest.approx(DIAGONAL, abs=1e-9)
    assert fit.others == pytest.approx(OTHERS, abs=1e-9)
    assert fit.fitness < 1e-6


def test_noise_shows_in_the_fitness() -> None:
    noise = np.random.default_rng(1).normal(scale=5.0, size=(300, 3))
    fit = fit_compass(raw_fields(300) + noise, STRENGTH)
    assert 4.0 < fit.fitness < 6.0
    assert fit.offset == pytest.approx(OFFSET, abs=3.0)


def test_without_a_place_the_field_is_as_strong_as_the_samples_are() -> None:
    samples = raw_fields(200)
    fit = fit_compass(samples, None)
    assert fit.radius == pytest.approx(sphere(samples)[1])
    assert np.array(fit.diagonal) / DIAGONAL == pytest.approx([fit.radius / STRENGTH] * 3, rel=1e-6)


def test_the_law_undoes_what_iron_does() -> None:
    axes = [Axes(), Axes()]
    for group, values in zip(axes, (DIAGONAL, OTHERS), strict=True):
        group.X, group.Y, group.Z = values
    for raw, direction in zip(raw_fields(20), directions(20), strict=True):
        field = corrected_field(Vec3(*(1e-3 * raw)), Vec3(*OFFSET), *axes)
        assert tuple(field) == pytest.approx(tuple(1e-3 * STRENGTH * direction), abs=1e-9)


def test_accelerometers_are_fitted_from_six_positions() -> None:
    up = GRAVITY * np.array([(0, 0, -1), (0, 1, 0), (0, -1, 0), (1, 0, 0), (-1, 0, 0), (0, 0, 1)], dtype=float)
    scale, offset = np.array((0.98, 1.12, 1.05)), np.array((0.7, -0.3, 1.8))
    fit = fit_accelerometer(up / scale + offset)
    assert fit.offset == pytest.approx(offset, abs=1e-9) and fit.scale == pytest.approx(scale, abs=1e-9)
    assert fit.fitness < 1e-9
    same = fit_accelerometer(np.tile(up[0], (6, 1)))
    assert all(map(math.isfinite, (*same.offset, *same.scale)))
