# SPDX-License-Identifier: BSD-3-Clause
"""Seeded damage to files, so that every reader meets what no writer writes; how readers answer it."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

T = TypeVar("T")

_EXTREMES = (
    b"\0",
    b"\xff",
    b"\x7f",
    b"\x80",
    b"\xff" * 8,
    b"\x7f" + b"\xff" * 7,
    b"\0" * 8,
    b"\xa3\x95\x80",
    b"\xfd",
    b"\xfe",
)
_VALUES: tuple[Any, ...] = (
    None, True, -1, 0, 1, 3, 255, 256, 65536, 1 << 31, 1 << 63, 1 << 64, 10**400, -(10**400), 0.5, -0.0, 1e308,
    float("nan"), float("inf"), -float("inf"), "", "x", "é" * 50, "1", [], [1], [[]], [None] * 3, {},
    {"x": 1}, [[[[1]]]],
)  # fmt: skip


def of_bytes(data: bytes, count: int, seed: int = 0) -> Iterator[bytes]:
    """``count`` damaged copies: bits and bytes changed, pieces left out, doubled, put elsewhere, cut off."""
    for k in range(count):
        random_ = random.Random(f"{seed} {k}")
        found = bytearray(data)
        for _ in range(random_.choice((1, 1, 2, 5))):
            if not found:
                break
            at = random_.randrange(len(found))
            kind = random_.randrange(8)
            if kind == 0:
                found[at] ^= 1 << random_.randrange(8)
            elif kind == 1:
                found[at] = random_.randrange(256)
            elif kind == 2:
                piece = random_.choice(_EXTREMES)
                found[at : at + len(piece)] = piece
            elif kind == 3:
                del found[at : at + random_.randrange(1, 40)]
            elif kind == 4:
                piece = found[at : at + random_.randrange(1, 200)]
                found[at:at] = piece * random_.choice((1, 1, 20))
            elif kind == 5:
                found[at:at] = random_.randbytes(random_.randrange(1, 20))
            elif kind == 6:
                del found[at:]
            else:
                other = random_.randrange(len(found))
                found[at : at + 8], found[other : other + 8] = found[other : other + 8], found[at : at + 8]
        yield bytes(found)


def of_json(value: Any, count: int, seed: int = 0) -> Iterator[Any]:
    """``count`` copies of a JSON value in which some values are others, are missing, or are there twice."""
    for k in range(count):
        random_ = random.Random(f"{seed} {k}")
        found = copy.deepcopy(value)
        for _ in range(random_.choice((1, 1, 2, 4))):
            holders = list(_holders(found))
            if not holders:
                break
            holder, key = random_.choice(holders)
            kind = random_.randrange(4)
            if kind == 0:
                del holder[key]
            elif kind == 1 and isinstance(holder, list):
                holder.insert(key, copy.deepcopy(random_.choice(holder)))
            else:
                holder[key] = copy.deepcopy(random_.choice(_VALUES))
        yield found


def read_or_refused(read: Callable[[], T], refusal: type[Exception], name: str) -> T | None:
    """What ``read`` makes of damage; None where it is refused: by this exception, whose message names the file."""
    try:
        return read()
    except refusal as error:
        assert name in str(error)
        return None


def _holders(value: Any) -> Iterator[tuple[Any, Any]]:
    """(List or table, key) of every value."""
    if isinstance(value, dict):
        for key in value:
            yield value, key
            yield from _holders(value[key])
    elif isinstance(value, list):
        for key in range(min(len(value), 200)):
            yield value, key
            yield from _holders(value[key])
