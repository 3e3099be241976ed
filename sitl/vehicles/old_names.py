# SPDX-License-Identifier: BSD-3-Clause
"""What files of version 0.1 call figures: the properties of an airframe. Such files are read; none is written."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .airframe import AirframeError

NEW, OLD = "properties", "figures"


def key_of_properties(table: Mapping[str, Any]) -> str:
    """The key under which a table of a file has an airframe's properties: ``NEW``, or ``OLD`` if that one is there.

    Raises:
        AirframeError: both are there.
    """
    if OLD not in table:
        return NEW
    if NEW in table:
        raise AirframeError(f"there are {OLD!r} and {NEW!r}: {OLD!r} is the old name of {NEW!r}; keep one of them")
    return OLD
