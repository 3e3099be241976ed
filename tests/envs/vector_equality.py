# SPDX-License-Identifier: BSD-3-Clause
"""What vector environments give, compared to the last bit."""

from __future__ import annotations

import numpy as np


def same(a, b):
    """Whether two observations, infos or snapshots are equal, types of arrays and all."""
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(same(a[name], b[name]) for name in a)
    if isinstance(a, np.ndarray) and a.dtype == object:
        return b.dtype == object and len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and np.array_equal(a, b)
    if isinstance(a, tuple | list):
        return type(a) is type(b) and len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    return a == b
