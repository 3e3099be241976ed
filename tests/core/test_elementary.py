# SPDX-License-Identifier: BSD-3-Clause
"""Elementary functions: exact to a little more than rounding, with the special values of C's Annex F, and compiled
with the bits of plain Python, without any call."""

from __future__ import annotations

import math
import random
import re
import struct

import mpmath
import numpy as np
import pytest

from benchmarks import elementary_accuracy as accuracy
from benchmarks import elementary_coefficients
from sitl.core import elementary
from sitl.core.compile import make_jitable
from sitl.core.elementary.logarithm_table import INVERSE, LOG, LOG_REST
from sitl.core.float_bits import bits_float, float_bits
from sitl.core.kernels import jit_disabled
from sitl.core.numba_tuning import COMMON

INF, NAN = math.inf, math.nan
LARGEST, LEAST = 1.7976931348623157e308, 5e-324
HALF_PI, PI = 1.5707963267948966, 3.141592653589793
NAMES = [name for name in elementary.__all__ if name != "sincos"]
BOUND = {"hypot": 0.75, "exp": 0.75, "pow": 0.75}  # below 2.3e-308, where results are rounded twice
compiles = pytest.mark.skipif(jit_disabled(), reason="nothing is compiled under NUMBA_DISABLE_JIT=1")


@pytest.mark.parametrize("name", NAMES)
def test_errors_are_little_more_than_rounding(name: str) -> None:
    for points in [*accuracy.draws(name, 1500, 7), accuracy.HARD[name]]:
        size, at = accuracy.worst(name, points)
        assert size <= BOUND.get(name, 0.62), at


@pytest.mark.parametrize("name", NAMES)
def test_accuracy_has_spans_of_every_function(name: str) -> None:
    assert accuracy.SPANS[name] and accuracy.HARD[name]


ODD = ("sin", "tan", "asin", "atan", "expm1", "tanh", "log1p", "cbrt")
"""Functions that keep zero and its sign, and what is next to it."""


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("x", [0.0, -0.0, LEAST, -LEAST, 1e-310])
def test_zeros_and_subnormal_numbers_keep_sign_and_value(name: str, x: float) -> None:
    expected = x if name != "cbrt" or x == 0.0 else math.copysign(abs(x) ** (1.0 / 3.0), x)
    value = getattr(elementary, name)(x)
    assert value == pytest.approx(expected, rel=1e-12, abs=0.0) and math.copysign(1.0, value) == math.copysign(1.0, x)


@pytest.mark.parametrize(("name", "arguments", "value"), [
    ("sin", (INF,), NAN), ("cos", (-INF,), NAN), ("tan", (INF,), NAN), ("cos", (0.0,), 1.0), ("cos", (LEAST,), 1.0),
    ("asin", (1.0,), HALF_PI), ("asin", (-1.0,), -HALF_PI), ("asin", (1.0000000000000002,), NAN),
    ("asin", (INF,), NAN), ("acos", (1.0,), 0.0), ("acos", (-1.0,), PI), ("acos", (-1.0000000000000002,), NAN),
    ("acos", (0.0,), HALF_PI), ("atan", (INF,), HALF_PI), ("atan", (-INF,), -HALF_PI), ("atan", (LARGEST,), HALF_PI),
    ("exp", (0.0,), 1.0), ("exp", (INF,), INF), ("exp", (-INF,), 0.0), ("exp", (709.79,), INF),
    ("exp", (-745.14,), 0.0), ("expm1", (INF,), INF), ("expm1", (-INF,), -1.0), ("tanh", (INF,), 1.0),
    ("tanh", (-INF,), -1.0), ("log", (1.0,), 0.0), ("log", (0.0,), -INF), ("log", (-0.0,), -INF),
    ("log", (-1.0,), NAN), ("log", (INF,), INF), ("log", (-INF,), NAN), ("log1p", (-1.0,), -INF),
    ("log1p", (-1.5,), NAN), ("log1p", (INF,), INF), ("cbrt", (INF,), INF), ("cbrt", (-INF,), -INF),
    ("cbrt", (-27.0,), -3.0), ("hypot", (INF, NAN), INF), ("hypot", (NAN, -INF), INF), ("hypot", (-0.0, 0.0), 0.0),
    ("hypot", (-3.0, 4.0), 5.0), ("hypot", (LARGEST, LARGEST), INF), ("hypot", (LEAST, -0.0), LEAST),
    ("hypot", (0.75 * LARGEST, 1.0), 0.75 * LARGEST), ("atan2", (0.0, -0.0), PI), ("atan2", (-0.0, -0.0), -PI),
    ("atan2", (0.0, 0.0), 0.0), ("atan2", (-0.0, 0.0), -0.0), ("atan2", (-0.0, 1.0), -0.0),
    ("atan2", (0.0, -1.0), PI), ("atan2", (-0.0, -1.0), -PI), ("atan2", (1.0, 0.0), HALF_PI),
    ("atan2", (-1.0, -0.0), -HALF_PI), ("atan2", (1.0, INF), 0.0), ("atan2", (-1.0, INF), -0.0),
    ("atan2", (1.0, -INF), PI), ("atan2", (INF, 1.0), HALF_PI), ("atan2", (INF, INF), PI / 4.0),
    ("atan2", (-INF, INF), -PI / 4.0), ("atan2", (INF, -INF), 2.356194490192345), ("atan2", (LEAST, LARGEST), 0.0),
    ("atan2", (LARGEST, -LEAST), HALF_PI), ("pow", (NAN, 0.0), 1.0), ("pow", (1.0, NAN), 1.0),
    ("pow", (0.0, -3.0), INF), ("pow", (-0.0, -3.0), -INF), ("pow", (-0.0, -2.0), INF), ("pow", (-0.0, 3.0), -0.0),
    ("pow", (-0.0, 0.5), 0.0), ("pow", (-1.0, INF), 1.0), ("pow", (-1.0, -INF), 1.0), ("pow", (0.5, -INF), INF),
    ("pow", (2.0, -INF), 0.0), ("pow", (-INF, -3.0), -0.0), ("pow", (-INF, 3.0), -INF), ("pow", (-INF, 2.0), INF),
    ("pow", (INF, -1.0), 0.0), ("pow", (-8.0, 1.5), NAN), ("pow", (-2.0, 3.0), -8.0), ("pow", (-2.0, -1075.0), -0.0),
    ("pow", (2.0, 1023.0), 2.0**1023), ("pow", (2.0, 1e300), INF), ("pow", (-1.0, 9007199254740993.0), 1.0),
    ("pow", (-1.0, 9007199254740991.0), -1.0), ("pow", (3.0, 1.0), 3.0),
])  # fmt: skip
def test_special_values(name: str, arguments: tuple[float, ...], value: float) -> None:
    found = getattr(elementary, name)(*arguments)
    if value != value:
        assert found != found
    else:
        assert found == value and math.copysign(1.0, found) == math.copysign(1.0, value)


@pytest.mark.parametrize("name", NAMES)
def test_no_number_gives_no_number(name: str) -> None:
    function = getattr(elementary, name)
    if len(accuracy.HARD[name][0]) == 1:
        assert math.isnan(function(NAN))
    else:
        assert math.isnan(function(NAN, 2.0)) and math.isnan(function(2.0, NAN))


def test_sine_and_cosine_at_once_have_the_bits_of_each() -> None:
    for points in [*accuracy.draws("sin", 2000, 3), [(0.0,), (-0.0,), (LEAST,), (1e300,)]]:
        for (x,) in points:
            assert [v.hex() for v in elementary.sincos(x)] == [elementary.sin(x).hex(), elementary.cos(x).hex()]


def test_tables_hold_what_the_script_makes() -> None:
    with mpmath.workdps(80):
        made = elementary_coefficients.logarithm_table()
    for row, numbers in zip((INVERSE, LOG, LOG_REST), made, strict=True):
        assert [row(k) for k in range(64)] == numbers


@pytest.mark.parametrize("x", [0.0, -0.0, 1.0, -2.5, LEAST, LARGEST, INF, -INF])
def test_bits_of_floats(x: float) -> None:
    assert float_bits(x) == struct.unpack("<q", struct.pack("<d", x))[0]
    assert bits_float(float_bits(x)).hex() == x.hex()


@pytest.mark.parametrize("decades", [0, 3, 20])
def test_length_is_rounded_once(decades: int) -> None:
    numbers = random.Random(decades)
    with mpmath.workprec(200):
        for _ in range(2000):
            x, y = (numbers.gauss(0.0, 1.0) * 10.0 ** numbers.uniform(-decades, decades) for _ in range(2))
            assert elementary.hypot(x, y) == float(mpmath.hypot(x, y)), (x, y)


def c_functions(code: str) -> set[str]:
    """Functions of the C library's <math.h> that machine code mentions."""
    words = set(re.findall(r"[A-Za-z_]\w*", code))
    return words & {name for name in dir(math) if not name.startswith("_")} - {"e", "pi"}


@compiles
@pytest.mark.parametrize("name", [*NAMES, "sincos"])
def test_compiled_they_have_the_same_bits_and_call_nothing(name: str) -> None:
    import numba

    make_jitable()
    function, spans = getattr(elementary, name), "sin" if name == "sincos" else name

    def one(x, y, out):
        for k in range(len(x)):
            out[k, 0] = function(x[k])

    def both(x, y, out):
        for k in range(len(x)):
            out[k, 0], out[k, 1] = function(x[k])

    def of_two(x, y, out):
        for k in range(len(x)):
            out[k, 0] = function(x[k], y[k])

    special = [0.0, -0.0, INF, -INF, NAN, LEAST, LARGEST, 1.0, -1.0, 0.5, 3.0]
    points = [at for some in accuracy.draws(spans, 600, 5) for at in some] + accuracy.HARD[spans]
    if len(points[0]) == 1:
        points += [(x,) for x in special]
        loop = numba.njit(both if name == "sincos" else one, **COMMON)
    else:
        points += [(x, y) for x in special for y in special]
        loop = numba.njit(of_two, **COMMON)
    out = np.zeros((len(points), 2))
    loop(np.array([at[0] for at in points]), np.array([at[-1] for at in points]), out)
    for at, row in zip(points, out, strict=True):
        expected = function(*at)
        for a, b in zip(expected if name == "sincos" else (expected,), row, strict=False):
            assert a.hex() == float(b).hex(), at
    code = next(iter(loop.inspect_asm().values()))
    assert not c_functions(code) and not re.search(r"\bv?fn?m(?:add|sub)\w*", code)


@compiles
def test_what_compiled_code_calls_is_seen() -> None:
    import numba

    compiled = numba.njit("f8(f8)")(lambda x: math.cosh(x) + x % 3.0)
    assert c_functions(next(iter(compiled.inspect_asm().values()))) == {"cosh", "fmod"}
