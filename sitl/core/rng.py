# SPDX-License-Identifier: BSD-3-Clause
"""Random numbers whose whole state is in the record: xoshiro128++, and normal deviates from it.

Source: Blackman and Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 47(4), 2021. The 32-bit member
of the family is used because its arithmetic fits into int64, so that Numba and plain Python give the same bits.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from .elementary import log
from .kernels import inlined, law
from .records import Ints, Record, array
from .vectors import Vec3


class Rng(Record):
    """The state of a generator."""

    s: Ints = array(4, stored="i8")  # 32-bit words, not all zero
    spare: float  # a normal deviate kept for the next call
    has_spare: bool


_MASK = 0xFFFFFFFF


class Words(NamedTuple):
    """The generator's words, read once for several draws."""

    a: int
    b: int
    c: int
    d: int


class Point(NamedTuple):
    """A point that is uniform in the unit circle, but not its centre."""

    x: float
    y: float
    r2: float
    """Its distance from the centre, squared."""


@inlined
def _words(rng: Rng) -> Words:
    return Words(int(rng.s[0]), int(rng.s[1]), int(rng.s[2]), int(rng.s[3]))


@inlined
def _keep(rng: Rng, s: Words) -> None:
    rng.s[0], rng.s[1], rng.s[2], rng.s[3] = s.a, s.b, s.c, s.d


@inlined
def _rotl(x: int, k: int) -> int:
    return ((x << k) & _MASK) | (x >> (32 - k))


@inlined
def _drawn(s: Words) -> int:
    return (_rotl((s.a + s.d) & _MASK, 7) + s.a) & _MASK


@inlined
def _after(s: Words) -> Words:
    c, d = s.c ^ s.a, s.d ^ s.b
    return Words(s.a ^ d, s.b ^ c, c ^ ((s.b << 9) & _MASK), _rotl(d, 11))


@inlined
def _uniform(word: int) -> float:
    return word * (1.0 / 4294967296.0)


@law
def next_u32(rng: Rng) -> int:
    """Next word, 0 .. 2^32 - 1."""
    words = _words(rng)
    _keep(rng, _after(words))
    return _drawn(words)


@law
def uniform(rng: Rng) -> float:
    """Uniform deviate in [0, 1) with 32 bits; a plain number."""
    return _uniform(next_u32(rng))


@law
def _point(words: Words) -> tuple[Point, Words]:
    while True:
        x = 2.0 * _uniform(_drawn(words)) - 1.0
        words = _after(words)
        y = 2.0 * _uniform(_drawn(words)) - 1.0
        words = _after(words)
        r2 = x * x + y * y
        if 0.0 < r2 < 1.0:
            return Point(x, y, r2), words


@inlined
def _scale(point: Point) -> float:
    """Times this, the coordinates of a point are two normal deviates (Marsaglia's polar method)."""
    return math.sqrt(-2.0 * log(point.r2) / point.r2)


@law
def normal(rng: Rng) -> float:
    """Normal deviate, mean 0, standard deviation 1."""
    if rng.has_spare:
        rng.has_spare = False
        return rng.spare
    point, words = _point(_words(rng))
    _keep(rng, words)
    scale = _scale(point)
    rng.spare = point.y * scale
    rng.has_spare = True
    return point.x * scale


@law
def normal_vector(rng: Rng) -> Vec3:
    """Three normal deviates, mean 0, standard deviation 1; plain numbers."""
    x = normal(rng)
    y = normal(rng)
    return Vec3(x, y, normal(rng))


@law
def normal_vectors(rng: Rng) -> tuple[Vec3, Vec3]:
    """What ``normal_vector`` gives in two calls, in two thirds of the time: logarithms and roots do not wait for
    draws.
    """
    p, words = _point(_words(rng))
    q, words = _point(words)
    r, words = _point(words)
    _keep(rng, words)
    first, second, third = _scale(p), _scale(q), _scale(r)
    a, b, c = p.x * first, p.y * first, q.x * second
    d, e, f = q.y * second, r.x * third, r.y * third
    spare, rng.spare = rng.spare, f
    if rng.has_spare:
        return Vec3(spare, a, b), Vec3(c, d, e)
    return Vec3(a, b, c), Vec3(d, e, f)


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
