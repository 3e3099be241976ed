# SPDX-License-Identifier: BSD-3-Clause
"""Makes a failing list of deeds short: leaves out parts of it as long as it still fails (delta debugging).

Source: Zeller and Hildebrandt, "Simplifying and isolating failure-inducing input", IEEE TSE 28(2), 2002.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

T = TypeVar("T")


def minimise(deeds: Sequence[T], fails: Callable[[list[T]], bool], most: int = 200) -> list[T]:
    """The shortest list found in at most ``most`` tries; no single deed of it can be left out, if they suffice."""
    kept, size, tries = list(deeds), max(len(deeds) // 2, 1), 0
    while True:
        at, shorter = 0, False
        while at < len(kept) and tries < most:
            fewer = kept[:at] + kept[at + size :]
            tries += 1
            if fewer and fails(fewer):
                kept, shorter = fewer, True
            else:
                at += size
        if tries >= most or (size == 1 and not shorter):
            return kept
        size = max(size // 2, 1)
