# SPDX-License-Identifier: BSD-3-Clause
"""The bits of a float as an integer, and back: of each, Numba makes one instruction (``numba_float_bits.py``)."""

from __future__ import annotations

import struct

_FLOAT, _INTEGER = struct.Struct("<d"), struct.Struct("<q")


def float_bits(value: float) -> int:
    """The 64 bits of a double (IEEE 754 binary64) as a signed integer: sign, 11 of the exponent, 52 of the fraction."""
    bits: int = _INTEGER.unpack(_FLOAT.pack(value))[0]
    return bits


def bits_float(bits: int) -> float:
    """The double with these 64 bits; the other way round as ``float_bits``."""
    value: float = _FLOAT.unpack(_INTEGER.pack(bits))[0]
    return value
