# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import os
import subprocess
import sys

import numpy as np
import pytest

from sitl.core.sums import least_squares, lengths, matrix_product, products, separation
from sitl.core.vectors import Vec3


def test_separation() -> None:
    assert separation((1.0, 2.0), (4.0, 6.0)) == 5.0
    assert separation(Vec3(0.0, 0.0, 1.0), Vec3(2.0, 3.0, 7.0)) == 7.0
    assert math.isnan(separation((math.nan,), (0.0,)))
    with pytest.raises(ValueError):
        separation((1.0, 2.0), (1.0, 2.0, 3.0))


def test_lengths_and_products_are_along_the_last_axis() -> None:
    assert lengths([3.0, 4.0]) == 5.0
    assert lengths(np.array([[3.0, 4.0], [0.0, 2.0]])).tolist() == [5.0, 2.0]
    assert products((1.0, 2.0), (3.0, 4.0)) == 11.0
    assert products(np.eye(2), np.array([5.0, 7.0])).tolist() == [5.0, 7.0]


def test_products_of_matrices_and_least_squares_are_those_of_numpy_to_rounding() -> None:
    rng = np.random.default_rng(2)
    a, b, y = rng.normal(size=(40, 9)), rng.normal(size=(9, 5)), rng.normal(size=40)
    assert np.allclose(matrix_product(a, b), a @ b, rtol=1e-13, atol=1e-13)
    assert np.allclose(least_squares(a, y), np.linalg.lstsq(a, y, rcond=None)[0], rtol=1e-12, atol=1e-13)
    assert np.allclose(least_squares(a[:9], y[:9]), np.linalg.solve(a[:9], y[:9]), rtol=1e-9)


def test_what_no_row_tells_apart_stays_zero() -> None:
    rows = np.array([[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [3.0, 6.0, 0.0]])
    found = least_squares(rows, np.array([2.0, 4.0, 6.0]))
    assert np.allclose(found, [0.0, 1.0, 0.0])
    assert least_squares(np.zeros((2, 3)), np.ones(2)).tolist() == [0.0, 0.0, 0.0]


_SUMS = """
import hashlib
import numpy as np
from sitl.core.sums import least_squares, lengths, matrix_product, products
rng = np.random.default_rng(5)
digest = hashlib.sha256()
for rows, columns in ((1, 2), (3, 3), (40, 9), (300, 9)):
    a, y = rng.normal(size=(rows, columns)), rng.normal(size=rows)
    for found in (matrix_product(a, a.T), products(a, a), lengths(a), lengths(y), products(y, y), least_squares(a, y),
                  a.sum(axis=0), a.sum(axis=1), a.mean(), y.cumsum(), y.std()):
        digest.update(np.ascontiguousarray(found).tobytes())
print(digest.hexdigest())
"""


def test_an_older_processor_adds_up_to_the_same_bits() -> None:
    """NumPy and its BLAS choose other code; ``a @ a.T`` differs here."""
    if sys.platform != "linux" or os.uname().machine != "x86_64":
        pytest.skip("the switches are those of x86-64")
    known = ("AVX2", "FMA3", "AVX512F", "AVX512_SKX", "X86_V3", "X86_V4", "AVX512_ICL", "AVX512_SPR")
    from numpy._core._multiarray_umath import __cpu_dispatch__ as dispatched

    old = {
        "NPY_DISABLE_CPU_FEATURES": " ".join(name for name in known if name in dispatched),
        "OPENBLAS_CORETYPE": "Nehalem",
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4",
    }

    def digest(changed: dict[str, str]) -> str:
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", _SUMS],
            env={**os.environ, **changed},
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.strip()

    assert digest({}) == digest(old)
