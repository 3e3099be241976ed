# SPDX-License-Identifier: BSD-3-Clause
"""The elementary functions (``elementary``) of arrays: the same bits as the laws give, on any processor.

NumPy's own differ in the last bits from one processor to the next, and from one C library to the next. Shapes are
broadcast as NumPy does it; results are float64, or float32 where all arguments are arrays of float32 (computed as
float64 and rounded). A few numbers are computed by the laws as they are; more by machine code (``elementary_kernels``).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import elementary, elementary_kernels
from .array_kernels import Kernel
from .kernels import jit_disabled

FEW = 8
"""Up to so many numbers are computed one by one in Python, unless the machine code is there already."""


def sin(x: npt.ArrayLike) -> Any:
    """Sine of angles [rad]."""
    return _each(elementary_kernels.sines, elementary.sin, x)


def cos(x: npt.ArrayLike) -> Any:
    """Cosine of angles [rad]."""
    return _each(elementary_kernels.cosines, elementary.cos, x)


def asin(x: npt.ArrayLike) -> Any:
    """Arcsine [rad]."""
    return _each(elementary_kernels.arcsines, elementary.asin, x)


def acos(x: npt.ArrayLike) -> Any:
    """Arccosine [rad]."""
    return _each(elementary_kernels.arccosines, elementary.acos, x)


def atan2(y: npt.ArrayLike, x: npt.ArrayLike) -> Any:
    """Angle [rad] of the points (x, y)."""
    return _pairs(elementary_kernels.angles, elementary.atan2, y, x)


def hypot(x: npt.ArrayLike, y: npt.ArrayLike) -> Any:
    """Length of (x, y), in their unit."""
    return _pairs(elementary_kernels.lengths, elementary.hypot, x, y)


def pow(x: npt.ArrayLike, y: npt.ArrayLike) -> Any:
    """``x`` to the power of ``y``."""
    return _pairs(elementary_kernels.powers, elementary.pow, x, y)


def _each(kernel: Kernel[..., None], law: Callable[[float], float], x: npt.ArrayLike) -> Any:
    given = np.asarray(x)
    values = np.ascontiguousarray(given, np.float64)
    out = np.empty(values.shape)
    if is_by_law(kernel, out.size):
        out.ravel()[:] = list(map(law, values.ravel().tolist()))
    else:
        kernel.unchecked()(values.ravel(), out.ravel())
    return _like(out, given.shape, given.dtype)


def _pairs(kernel: Kernel[..., None], law: Callable[[float, float], float], a: npt.ArrayLike, b: npt.ArrayLike) -> Any:
    first, second = np.asarray(a), np.asarray(b)
    dtype = first.dtype if first.dtype == second.dtype else np.result_type(first, second)
    if first.shape != second.shape:
        first, second = np.broadcast_arrays(first, second)
    x, y = np.ascontiguousarray(first, np.float64), np.ascontiguousarray(second, np.float64)
    out = np.empty(x.shape)
    if is_by_law(kernel, out.size):
        out.ravel()[:] = list(map(law, x.ravel().tolist(), y.ravel().tolist()))
    else:
        kernel.unchecked()(x.ravel(), y.ravel(), out.ravel())
    return _like(out, first.shape, dtype)


def is_by_law(kernel: Kernel[..., None], count: int) -> bool:
    """Whether so many numbers are computed by the law as it is: few, while the machine code is not loaded yet."""
    return (count <= FEW and not kernel.is_loaded) or jit_disabled()


def _like(out: npt.NDArray[np.float64], shape: tuple[int, ...], dtype: np.dtype[Any]) -> Any:
    """Results with the precision of what was given; a number for a number."""
    if dtype == np.float32:
        return out.astype(np.float32) if shape else np.float32(out[0])
    return out if shape else out[0]
