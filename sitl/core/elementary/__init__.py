# SPDX-License-Identifier: BSD-3-Clause
"""Elementary functions with the same bits on every machine: laws in +, -, *, / and square roots alone.

Those are rounded to one value only by IEEE 754; a C library's functions are not, and differ by library, version and
processor. Nothing is fused: a processor's multiply-add would be another value. Arguments beyond a function's domain
give NaN and infinities as C's Annex F has them, not Python's exceptions.
"""

from .circular import cos, sin, sincos, tan
from .exponential import exp, expm1, tanh
from .inverse_circular import acos, asin, atan, atan2
from .logarithm import log, log1p
from .power import pow
from .roots import cbrt, hypot

__all__ = [
    "acos",
    "asin",
    "atan",
    "atan2",
    "cbrt",
    "cos",
    "exp",
    "expm1",
    "hypot",
    "log",
    "log1p",
    "pow",
    "sin",
    "sincos",
    "tan",
    "tanh",
]
