# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers of NumPy's generators that are the same on any machine.

What NumPy draws by a ziggurat (Marsaglia and Tsang, Journal of Statistical Software 5(8), 2000) is exact, but for the
tail: it takes that from the C library's logarithm, whose last bits differ. The few numbers of a tail are drawn anew by
ours.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.core.elementary import log

NORMAL_TAIL, EXPONENTIAL_TAIL = 3.6541528853610088, 7.69711747013104972
"""Where the tails begin; of an exponential deviate this is one of 2,200, of a normal one of 3,900."""


def standard_normal(
    rng: np.random.Generator, shape: int | tuple[int, ...], dtype: type[np.float32] | type[np.float64] = np.float64
) -> npt.NDArray[Any]:
    """Normal deviates of mean 0 and standard deviation 1."""
    drawn = np.asarray(rng.standard_normal(shape, dtype))
    flat = drawn.reshape(-1)
    for k in np.flatnonzero(np.abs(flat) > dtype(NORMAL_TAIL)).tolist():
        beyond, limit = 1.0, 0.0
        while limit <= beyond * beyond:
            beyond, limit = -log(1.0 - rng.random()) / NORMAL_TAIL, -2.0 * log(1.0 - rng.random())
        flat[k] = math.copysign(NORMAL_TAIL + beyond, flat[k])
    return drawn


def dirichlet(rng: np.random.Generator, count: int, parts: int) -> npt.NDArray[np.float64]:
    """Shares that add up to 1, all equally likely, shape (count, parts): NumPy's ``dirichlet`` of ones."""
    drawn = rng.standard_exponential((count, parts))
    for k in np.flatnonzero(drawn > EXPONENTIAL_TAIL).tolist():
        drawn.reshape(-1)[k] = EXPONENTIAL_TAIL - log(1.0 - rng.random())
    out: npt.NDArray[np.float64] = drawn * (1.0 / drawn.sum(axis=1))[:, None]
    return out


_WORDS = np.array([0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB], np.uint64)
_SHIFTS = np.array([30, 27, 31, 11], np.uint64)


def uniform(seeds: npt.NDArray[np.int64], numbers: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """Uniform deviates within [0, 1), one for each pair of a seed and a number: without state, for many robots at once.

    Source: the finalizer of SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA
    2014), of the seed and then of the number.
    """
    out = _mixed(_mixed(seeds.astype(np.uint64)) + numbers.astype(np.uint64))
    found: npt.NDArray[np.float64] = (out >> _SHIFTS[3]).astype(np.float64) * 2.0**-53
    return found


def _mixed(words: npt.NDArray[np.uint64]) -> npt.NDArray[np.uint64]:
    words = words + _WORDS[0]
    words = (words ^ words >> _SHIFTS[0]) * _WORDS[1]
    words = (words ^ words >> _SHIFTS[1]) * _WORDS[2]
    out: npt.NDArray[np.uint64] = words ^ words >> _SHIFTS[2]
    return out
