# SPDX-License-Identifier: BSD-3-Clause
"""Helpers to declare records (nested ``numpy.dtype``) and to look at them from Python."""

from __future__ import annotations

from typing import Any

import numpy as np

from .record_view import RecordView, view

__all__ = ["RecordView", "as_dict", "first_difference", "record", "view"]


def record(*fields: tuple[Any, ...]) -> np.dtype[Any]:
    """An aligned record type from ``(name, type)`` or ``(name, type, shape)`` fields.

    Fields are 8-byte numbers ("f8", "i8") unless a protocol fixes another width: mixed widths cost
    conversions in the core and surprises in plain Python (float32 arithmetic, integer overflow).

    Raises:
        ValueError: a name that numpy's records have as an attribute of their own ("flags", "size", "data"):
            reading it in plain Python would give numpy's, not the field.
    """
    taken = [f[0] for f in fields if hasattr(np.void, f[0])]
    if taken:
        raise ValueError(f"record fields {taken} are attributes of numpy's own records; choose other names")
    return np.dtype([tuple(f) for f in fields], align=True)


def as_dict(value: Any) -> Any:
    """A record as nested dictionaries and lists, for printing and comparing."""
    if isinstance(value, np.void | RecordView) and value.dtype.names:
        return {name: as_dict(value[name]) for name in value.dtype.names}
    if isinstance(value, np.ndarray):
        return [as_dict(v) for v in value]
    return value.item() if isinstance(value, np.generic) else value


def first_difference(a: Any, b: Any, path: str = "") -> str | None:
    """Name of the first field in which two records differ bit for bit, or None when they are equal."""
    if isinstance(a, np.void) and a.dtype.names:
        for name in a.dtype.names:
            found = first_difference(a[name], b[name], f"{path}.{name}" if path else name)
            if found:
                return found
        return None
    if isinstance(a, np.ndarray) and a.dtype.names:
        for k in range(a.shape[0]):
            found = first_difference(a[k], b[k], f"{path}[{k}]")
            if found:
                return found
        return None
    same = np.asarray(a).tobytes() == np.asarray(b).tobytes()
    return None if same else f"{path}: {a!r} != {b!r}"
