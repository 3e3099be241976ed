# SPDX-License-Identifier: BSD-3-Clause
"""Compares the digests of two trees, flight by flight."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from .tape import Row, read

Digests = Mapping[str, Any]
NAMED = 5
"""Differences of one flight that are named."""


@dataclass
class Comparison:
    """What two sets of digests have in common, and what not."""

    same: list[str] = field(default_factory=list)
    differing: dict[str, list[str]] = field(default_factory=dict)
    """Flight -> its differences, the first one first."""
    only_first: list[str] = field(default_factory=list)
    only_second: list[str] = field(default_factory=list)
    """Flights that only one has."""
    leaves_only_first: set[str] = field(default_factory=set)
    leaves_only_second: set[str] = field(default_factory=set)
    """Leaves that only one has, in flights that both have."""


def renamed(path: str, names: Mapping[str, str]) -> str:
    """The new path of a leaf: itself or the longest of its parents that has a new name is replaced."""
    for old in sorted(names, key=len, reverse=True):
        if path == old or path.startswith(f"{old}."):
            return names[old] + path[len(old) :]
    return path


def compare(first: Digests, second: Digests, names: Mapping[str, str] | None = None) -> Comparison:
    """Two sets of digests; ``names``: leaves of the first, or parents of leaves, and what the second calls them."""
    found = Comparison()
    found.only_first = [name for name in first if name not in second]
    found.only_second = [name for name in second if name not in first]
    for flight in [name for name in first if name in second]:
        differences = list(_differences(first[flight], second[flight], names or {}, found))
        if differences:
            found.differing[flight] = differences
        else:
            found.same.append(flight)
    return found


def _differences(a: Digests, b: Digests, names: Mapping[str, str], found: Comparison) -> Iterator[str]:
    if "error" in a or "error" in b:
        yield f"error: {a.get('error', 'none')} | {b.get('error', 'none')}"
        return
    for key, what in (("telemetry", "messages"), ("given", "values")):
        if key in a and key in b and a[key]["sha256"] != b[key]["sha256"]:
            yield _first(what, a[key]["times"], read(a[key]), read(b[key])) or f"{what} in another order"
    if "record" in a and "record" in b:
        ours, theirs = {renamed(path, names): row for path, row in read(a["record"]).items()}, read(b["record"])
        found.leaves_only_first |= ours.keys() - theirs.keys()
        found.leaves_only_second |= theirs.keys() - ours.keys()
        shared = [path for path in ours if path in theirs]
        text = _first("leaves", a["record"]["times"], {p: ours[p] for p in shared}, {p: theirs[p] for p in shared})
        yield from [text] if text else []
    for key in ("end", "files"):
        if a.get(key) != b.get(key):
            yield f"{key}: {a.get(key)} | {b.get(key)}"


def _first(what: str, times: list[float], a: Mapping[str, Row], b: Mapping[str, Row]) -> str:
    """Where two tapes differ first, in words; "" where they are the same."""
    firsts: dict[int, list[str]] = {}
    for name in {**a, **b}:
        ours, theirs = a.get(name, Row(0, b"")), b.get(name, Row(0, b""))
        if ours != theirs:
            size = max(len(ours.steps), len(theirs.steps))
            pairs = zip(ours.steps.ljust(size, b"\0"), theirs.steps.ljust(size, b"\0"))
            firsts.setdefault(next((k for k, (x, y) in enumerate(pairs) if x != y), size), []).append(name)
    if not firsts:
        return ""
    step = min(firsts)
    when = f"from {times[step]:g} on" if step < len(times) else f"after {times[-1]:g}"
    named = firsts[step][:NAMED]
    more = sum(map(len, firsts.values())) - len(named)
    return f"{what} {when}: {', '.join(named)}" + (f"; {more} more" if more else "")
