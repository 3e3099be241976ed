# SPDX-License-Identifier: BSD-3-Clause
"""Compares the digests of two trees, flight by flight."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .tape import packed, unpacked

Digests = Mapping[str, Any]
NOTHING = packed(b"")
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
    """Two fingerprints; ``names``: leaves of the first, or parents of leaves, and what the second calls them."""
    found = Comparison()
    a, b = first["flights"], second["flights"]
    found.only_first = [name for name in a if name not in b]
    found.only_second = [name for name in b if name not in a]
    for name in a:
        if name not in b:
            continue
        paths = [[renamed(p, names or {}) for p in _paths(first, a[name])], _paths(second, b[name])]
        found.leaves_only_first |= set(paths[0]) - set(paths[1])
        found.leaves_only_second |= set(paths[1]) - set(paths[0])
        differences = list(_differences(a[name], b[name], paths))
        if differences:
            found.differing[name] = differences
        else:
            found.same.append(name)
    return found


def _paths(whole: Digests, flight: Digests) -> list[str]:
    key = flight.get("record", {}).get("paths")
    return list(whole["leaves"][key]) if key is not None else []


def _differences(a: Digests, b: Digests, paths: list[list[str]]) -> Iterable[str]:
    if "error" in a or "error" in b:
        yield f"error: {a.get('error', 'none')} | {b.get('error', 'none')}"
        return
    for key in ("telemetry", "given"):
        if key in a and key in b and a[key]["sha256"] != b[key]["sha256"]:
            yield _first_in_series(a[key], b[key], "message" if key == "telemetry" else "value", key == "telemetry")
    if "record" in a and "record" in b:
        yield from _in_leaves(a["record"], b["record"], paths)
    for key in ("end_us", "steps", "files"):
        if a.get(key) != b.get(key):
            yield f"{key}: {a.get(key)} | {b.get(key)}"


def _first_in_series(a: Digests, b: Digests, what: str, in_seconds: bool) -> str:
    firsts: dict[int, list[str]] = {}
    for name in sorted({*a["names"], *b["names"]}):
        rows = [np.frombuffer(unpacked(side["names"].get(name, NOTHING)), np.uint8) for side in (a, b)]
        size = max(map(len, rows))
        padded = [np.pad(row, (0, size - len(row))) for row in rows]
        unequal = np.flatnonzero(padded[0] != padded[1])
        if len(unequal):
            firsts.setdefault(int(unequal[0]), []).append(name)
    if not firsts:
        return f"{what}s: order or time within a second"
    step = min(firsts)
    others = sum(map(len, firsts.values())) - len(firsts[step])
    when = f"{step} to {step + 1} s" if in_seconds else f"step {step}"
    return f"{what}s from {when} on: {', '.join(firsts[step])}" + (f"; later {others} more" if others else "")


def _in_leaves(a: Digests, b: Digests, paths: list[list[str]]) -> Iterable[str]:
    sides = []
    for side, names in zip((a, b), paths):
        chains = np.frombuffer(unpacked(side["chain"]), "<u4").tolist()
        rows = np.frombuffer(unpacked(side["changes"]), np.uint8).reshape(len(names), len(side["times_us"]))
        sides.append(dict(zip(names, zip(chains, rows))))
    times = a["times_us"]
    if times != b["times_us"]:
        yield f"checkpoints: {len(times)} | {len(b['times_us'])}, the last at {times[-1]} | {b['times_us'][-1]} us"
    firsts: dict[int, list[str]] = {}
    for name, (chain, changes) in sides[0].items():
        if name not in sides[1] or sides[1][name][0] == chain:
            continue
        other = sides[1][name][1]
        size = min(len(changes), len(other))
        unequal = np.flatnonzero(changes[:size] != other[:size])
        if len(unequal):
            firsts.setdefault(int(unequal[0]), []).append(name)
        elif len(changes) == len(other):
            firsts.setdefault(len(times), []).append(name)
    if firsts:
        first = min(firsts)
        when = f"at {times[first] * 1e-6:g} s" if first < len(times) else "at an unknown time"
        more = sum(map(len, firsts.values())) - len(firsts[first][:NAMED])
        yield f"leaves {when}: {', '.join(firsts[first][:NAMED])}" + (f"; {more} more" if more else "")
