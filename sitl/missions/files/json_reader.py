# SPDX-License-Identifier: BSD-3-Clause
"""Values of a JSON document with the place where each stands, for messages."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from .document import MissionFileError

_KINDS = {dict: "an object", list: "a list", str: "a text", bool: "true or false"}


class Node:
    """One value of a document, and where it is."""

    def __init__(self, value: Any, where: str) -> None:
        self.value = value
        self.where = where

    def fail(self, text: str) -> MissionFileError:
        """The error to raise about this value."""
        return MissionFileError(f"{self.where}: {text}")

    def __contains__(self, key: str) -> bool:
        return key in self._of(dict)

    def __getitem__(self, key: str) -> Node:
        """Member ``key`` of an object, which must be there."""
        members = self._of(dict)
        if key not in members:
            raise self.fail(f"no {key!r}; there are {', '.join(map(repr, members)) or 'no members'}")
        return Node(members[key], f"{self.where}.{key}" if self.where else key)

    def get(self, key: str, default: Any) -> Node:
        """Member ``key`` of an object; ``default`` when it is missing or null."""
        found = self._of(dict).get(key)
        return Node(default if found is None else found, f"{self.where}.{key}")

    def __iter__(self) -> Iterator[Node]:
        for k, value in enumerate(self._of(list)):
            yield Node(value, f"{self.where}[{k}]")

    def _of(self, kind: type) -> Any:
        if not isinstance(self.value, kind):
            raise self.fail(f"{shown(self.value)} is not {_KINDS[kind]}")
        return self.value

    @property
    def text(self) -> str:
        """A string."""
        return str(self._of(str))

    @property
    def flag(self) -> bool:
        """A boolean."""
        return bool(self._of(bool))

    def whole(self, *allowed: int) -> int:
        """A whole number, one of ``allowed`` when some are given."""
        value = self.value
        if isinstance(value, float) and math.isfinite(value) and value == int(value):
            value = int(value)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.fail(f"{shown(self.value)} is not a whole number")
        if allowed and value not in allowed:
            raise self.fail(f"{value} is not {' or '.join(map(str, allowed))}")
        return value

    def number(self, low: float = -math.inf, high: float = math.inf) -> float:
        """A finite number from ``low`` to ``high``."""
        value = self.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not _is_finite(value):
            raise self.fail(f"{shown(value)} is not a number")
        if not low <= value <= high:
            raise self.fail(f"{value} is not within {low:g} .. {high:g}")
        return float(value)

    def numbers(self, count: int) -> tuple[float, ...]:
        """A list of ``count`` numbers; null is NaN."""
        if not isinstance(self.value, list) or len(self.value) != count:
            raise self.fail(f"expected a list of {count} numbers, found {shown(self.value)}")
        return tuple(math.nan if item.value is None else item.number() for item in self)

    def location(self) -> tuple[float, float]:
        """[latitude, longitude] in degrees; a third number (altitude) is passed over."""
        if not isinstance(self.value, list) or len(self.value) not in (2, 3):
            raise self.fail(f"expected [latitude, longitude], found {shown(self.value)}")
        lat, lon, *_ = self
        return (lat.number(-90.0, 90.0), lon.number(-180.0, 180.0))


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond all floats
        return False


def shown(value: Any) -> str:
    """A value in a message, cut when it is long."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
