# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers whose whole state is in the record: xoshiro128++, and normal deviates from it.

Source: Blackman and Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 47(4), 2021. The 32-bit member
of the family is used because its arithmetic fits into int64, so that Numba and plain Python give the same bits.
"""

from __future__ import annotations

import math

from .elementary import log
from .kernels import law
from .records import Ints, Record, array
from .vectors import Vec3


class Rng(Record):
    """The state of a generator."""

    s: Ints = array(4, stored="i8")  # 32-bit words, not all zero
    spare: float  # a normal deviate kept for the next call
    has_spare: bool


_MASK = 0xFFFFFFFF


@law
def _rotl(x: int, k: int) -> int:
    return ((x << k) & _MASK) | (x >> (32 - k))


@law
def next_u32(rng: Rng) -> int:
    """Next word, 0 .. 2^32 - 1."""
    s0, s1, s2, s3 = int(rng.s[0]), int(rng.s[1]), int(rng.s[2]), int(rng.s[3])
    result = (_rotl((s0 + s3) & _MASK, 7) + s0) & _MASK
    t = (s1 << 9) & _MASK
    s2 ^= s0
    s3 ^= s1
    s1 ^= s2
    s0 ^= s3
    s2 ^= t
    rng.s[0], rng.s[1], rng.s[2], rng.s[3] = s0, s1, s2, _rotl(s3, 11)
    return result


@law
def uniform(rng: Rng) -> float:
    """Uniform deviate in [0, 1) with 32 bits; a plain number."""
    return next_u32(rng) * (1.0 / 4294967296.0)


@law
def normal(rng: Rng) -> float:
    """Normal deviate, mean 0, standard deviation 1 (Marsaglia's polar method)."""
    if rng.has_spare:
        rng.has_spare = False
        return rng.spare
    while True:
        u = 2.0 * uniform(rng) - 1.0
        w = 2.0 * uniform(rng) - 1.0
        r2 = u * u + w * w
        if 0.0 < r2 < 1.0:
            break
    scale = math.sqrt(-2.0 * log(r2) / r2)
    rng.spare = w * scale
    rng.has_spare = True
    return u * scale


@law
def normal_vector(rng: Rng) -> Vec3:
    """Three normal deviates, mean 0, standard deviation 1; plain numbers."""
    x = normal(rng)
    y = normal(rng)
    return Vec3(x, y, normal(rng))


def seed(rng: Rng, value: int) -> None:
    """Fill the state from any integer seed through splitmix64."""
    z = value & 0xFFFFFFFFFFFFFFFF
    for k in range(4):
        z = (z + 0x9E3779B97F4A7C15) & 0xFFFFFFFFFFFFFFFF
        x = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & 0xFFFFFFFFFFFFFFFF
        x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & 0xFFFFFFFFFFFFFFFF
        rng.s[k] = (x ^ (x >> 31)) & _MASK
    if not any(int(w) for w in rng.s):
        rng.s[0] = 1
    rng.spare = 0.0
    rng.has_spare = False
