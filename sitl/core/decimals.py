# SPDX-License-Identifier: BSD-3-Clause
"""Numbers as decimal text, written into memory by laws."""

from __future__ import annotations

from .kernels import law
from .memory import Bytes

_ZERO, DOT, _MINUS, _EXPONENT = ord("0"), ord("."), ord("-"), ord("e")
SMALLEST = 1e-13
"""Whatever is nearer to zero is written as 0."""
LARGEST = 999_999_999.0
"""Whatever is beyond is written as this."""
MOST = 18
"""Bytes that ``write_number`` needs at most."""


@law
def write_digits(text: Bytes, at: int, number: int, count: int) -> int:
    """Write a whole number with leading zeros, ``count`` digits; gives where it ends."""
    for k in range(at + count - 1, at - 1, -1):
        rest = number // 10
        text[k] = _ZERO + number - 10 * rest
        number = rest
    return at + count


@law
def write_whole(text: Bytes, at: int, number: int) -> int:
    """Write a whole number that is not negative; gives where it ends."""
    count, limit = 1, 10
    while number >= limit:
        count, limit = count + 1, limit * 10
    return write_digits(text, at, number, count)


@law
def write_number(text: Bytes, at: int, value: float) -> int:
    """Write a number with nine significant digits, without zeros at its end, as ``%.9g`` does; gives where it ends.

    A number whose tenth digit is a 5 and nothing after it may be rounded another way. What is not a number is 0.
    """
    size = abs(value)
    if not size >= SMALLEST:
        text[at] = _ZERO
        return at + 1
    if value < 0.0:
        text[at] = _MINUS
        at += 1
    size = min(size, LARGEST)
    exponent, scale = 0, 1e8
    while size * scale >= 1e9:  # at least 1e8 and below 1e9: nine digits
        exponent, scale = exponent + 1, scale / 10.0
    while size * scale < 1e8:
        exponent, scale = exponent - 1, scale * 10.0
    digits = int(size * scale + 0.5)
    if digits >= 1_000_000_000:
        digits, exponent = digits // 10, exponent + 1
    count = 9
    while digits % 10 == 0:
        digits, count = digits // 10, count - 1
    if exponent < -4:
        return _write_scientific(text, at, digits, count, exponent)
    if exponent < 0:
        text[at], text[at + 1] = _ZERO, DOT
        for k in range(at + 2, at + 1 - exponent):
            text[k] = _ZERO
        return write_digits(text, at + 1 - exponent, digits, count)
    whole = exponent + 1
    if count <= whole:
        write_digits(text, at, digits, count)
        for k in range(at + count, at + whole):
            text[k] = _ZERO
        return at + whole
    write_digits(text, at + 1, digits, count)
    for k in range(at, at + whole):
        text[k] = text[k + 1]
    text[at + whole] = DOT
    return at + count + 1


@law
def _write_scientific(text: Bytes, at: int, digits: int, count: int, exponent: int) -> int:
    """As 1.25e-7."""
    end = write_digits(text, at + 1, digits, count)
    text[at] = text[at + 1]
    if count > 1:
        text[at + 1] = DOT
        at = end
    else:
        at += 1
    text[at], text[at + 1] = _EXPONENT, _MINUS
    return write_whole(text, at + 2, -exponent)
