# SPDX-License-Identifier: BSD-3-Clause
"""Compares a flight with its golden: metrics with limits, and the first divergence in words."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sitl.logs.track_observer import BITS_US
from sitl.physics.engines import NATIVE
from sitl.recording import identity

from . import words
from .alignment import Pair, pair
from .events import SHIFTED, Event, compare_events
from .flight import Differences, Flight, Series, measure
from .tolerance import EVENTS, Tolerance, load

_DECIDED = ("vehicle", "seed", "estimator", "physics", "home", "start")
_EVENT_TITLES = {"items": "mission items", "modes": "modes", "texts": "texts"}


OLD = (
    "the golden flight is of a version whose last bits depended on the machine: it is compared within the limits of "
    "'same'; record it anew to have it compared exactly"
)


@dataclass(frozen=True)
class Metric:
    """One metric with its limit."""

    name: str
    """Name as in tolerance files: "cross_track.max"."""
    title: str
    value: float
    unit: str
    limit: float
    """Infinite: not judged."""
    at: float | None = None
    """Time of the largest value since the common start [s]."""
    words: str = ""
    """Where and how, or what."""

    @property
    def ok(self) -> bool:
        """Whether it is within its limit."""
        return self.value <= self.limit + 1e-9

    @property
    def is_judged(self) -> bool:
        """Whether it has a limit."""
        return math.isfinite(self.limit)


@dataclass(frozen=True)
class Divergence:
    """The first point where the new flight leaves golden."""

    t: float
    """Time since the common start [s]."""
    words: str


@dataclass(frozen=True)
class Comparison:
    """Two flights compared."""

    golden: Flight
    new: Flight
    pair: Pair
    tolerance: Tolerance
    differences: Differences
    events: list[Event]
    metrics: list[Metric]
    first: Divergence | None
    """The first difference beyond its limit."""
    first_trace: Divergence | None
    """The first difference beyond rounding."""
    notes: list[str]
    is_old: bool = False
    """Golden keeps no digests of its bits: a version before they were the same everywhere made it. It is compared by
    "same" where no tolerance is asked for."""

    @property
    def ok(self) -> bool:
        """Whether everything is within its limits."""
        return all(metric.ok for metric in self.metrics)

    @property
    def failed(self) -> list[Metric]:
        """Metrics beyond their limits."""
        return [metric for metric in self.metrics if not metric.ok]

    @property
    def headline(self) -> str:
        """The verdict in one line."""
        if self.ok:
            exactly = "bit" if self.tolerance.bits else "digit of its track"
            return "flies like the golden flight" + ("" if self.first_trace else f", to the last {exactly}")
        what = self.first.words if self.first else self.failed[0].words
        return f"does not fly like the golden flight: {what}"

    @property
    def other_version(self) -> str:
        """That another version of the simulator made golden, and which parts are another; "": the same made both."""
        if self.golden.header is None or self.new.header is None:
            return ""
        found = identity.code_differences(self.golden.header["version"], self.new.header["version"])
        return f"another version of the simulator recorded the golden flight ({'; '.join(found)})" if found else ""

    @property
    def advice(self) -> str:
        """What to know of golden before the verdict is believed, in one line; "": nothing."""
        if not self.ok and self.other_version:
            return (
                f"{self.other_version}: versions may fly differently, CHANGELOG.md says when they do; if the new "
                "flight is as it should be, record the golden flight anew"
            )
        return OLD if self.is_old else ""


def compare(golden: Flight, new: Flight, tolerance: str | Path | Mapping[str, Any] | None = None) -> Comparison:
    """Compare a new flight with golden.

    Args:
        golden, new: flights.
        tolerance: "exact", "same", "alike", a distance with its unit ("0.5 m"), a TOML file or a mapping of its shape
            (``tolerance.load``); None: ``default_tolerance``.

    Raises:
        ToleranceError, AlignmentError: there is nothing to compare them by.
    """
    limits = load(tolerance if tolerance is not None else default_tolerance(golden, new), golden.track.kind)
    is_old = tolerance is None and limits.name == "same" and _is_exact(new) and not golden.bits
    both = pair(golden.track, new.track, limits.align, golden.coarse or new.coarse)
    differences = measure(both)
    events = compare_events(both, limits)
    metrics = [metric for series in differences.series for metric in _of_series(both, series, differences, limits)]
    metrics += _totals(both, limits)
    metrics += [metric for kind in EVENTS for metric in _of_events(both, kind, events, limits)]
    if limits.bits:
        metrics += _of_bits(golden, new)
    first = _first(both, differences, events, limits, metrics)
    return Comparison(
        golden, new, both, limits, differences, events, metrics, first, _trace(both, differences, events),
        [*both.notes, *_notes(golden, new)], is_old,
    )  # fmt: skip


def default_tolerance(golden: Flight, new: Flight) -> str:
    """The preset for two flights: "exact" for two of the same seed, vehicle and world on native physics, "same" on
    another engine, whose arithmetic depends on the processor, else "alike"."""
    if golden.header is None or new.header is None:
        return "alike"
    old, now = golden.header, new.header
    same = all(old[name] == now[name] for name in _DECIDED) and old["world"] == now["world"]
    same = same and old["airframe"]["name"] == now["airframe"]["name"]
    names = {name for name in {*old["params"], *now["params"]} if name.startswith("SIM_")}
    same = same and all(old["params"].get(name) == now["params"].get(name) for name in names)
    if not same:
        return "alike"
    return "exact" if golden.bits and _is_exact(new) else "same"


def _is_exact(flight: Flight) -> bool:
    """Whether a flight repeats to the last bit on every machine, and its bits are known."""
    return flight.header is not None and flight.header["physics"] == NATIVE and bool(flight.bits)


def _of_bits(golden: Flight, new: Flight) -> list[Metric]:
    """How many digests of the flights differ: each is of all samples up to its time."""
    if not (golden.bits and new.bits):
        return []
    size = max(len(golden.bits), len(new.bits))
    pairs = zip(golden.bits + (b"",) * size, new.bits + (b"",) * size)
    differing = [k for k, (a, b) in enumerate(pairs) if a != b]
    text, at = "", None
    if differing:
        at, until = (k * BITS_US * 1e-6 for k in (differing[0], differing[0] + 1))
        text = f"the last bits differ from some time between {at:.0f} and {until:.0f} s after power-on"
    return [Metric("bits", "digests of all bits", float(len(differing)), "", 0.0, at, text)]


def _of_series(both: Pair, series: Series, differences: Differences, limits: Tolerance) -> list[Metric]:
    k = series.worst()
    value, at = series.max, float(series.t[k]) if len(series.t) else 0.0
    text = f"{words.when(both, at)}: {words.deviation(series, k)}" if value > 0.0 else ""
    if series.name == "cross_track" and differences.missed.max(initial=0.0) > value + 0.01:
        g = int(np.argmax(differences.missed))
        value, at = float(differences.missed[g]), float(both.golden.t[g])
        north, east = (float(both.golden[name][g]) for name in ("north", "east"))
        text = f"the point {north:.1f} m north, {east:.1f} m east of home (golden at {at:.1f} s) is missed by this much"
    found = [
        Metric(f"{series.name}.max", series.title, value, series.unit, limits.limit(f"{series.name}.max"), at, text)
    ]
    if series.name != "delay":
        name = f"{series.name}.rms"
        found.append(Metric(name, f"{series.title}, RMS", series.rms, series.unit, limits.limit(name)))
    return found


def _totals(both: Pair, limits: Tolerance) -> list[Metric]:
    golden, new = both.golden, both.new
    longer = float(new.t[-1] - golden.t[-1])
    text = f"{new.t[-1]:.1f} s, golden {golden.t[-1]:.1f} s"
    found = [Metric("duration.max", "duration", abs(longer), "s", limits.limit("duration.max"), words=text)]
    old, now = float(golden["energy"][-1]), float(new["energy"][-1])
    if old > 0.0 and now > 0.0:
        change = 100.0 * abs(now - old) / old if abs(now - old) > 0.0101 else 0.0
        text = f"{now:.2f} Wh, golden {old:.2f} Wh"
        found.append(Metric("energy.max", "energy", change, "%", limits.limit("energy.max"), words=text))
    return found


def _of_events(both: Pair, kind: str, events: list[Event], limits: Tolerance) -> list[Metric]:
    limit, title = limits.limit(f"{kind}.time"), _EVENT_TITLES[kind]
    mine = [event for event in events if event.kind == kind]
    wrong = [event for event in mine if event.difference(math.inf)]
    text = "; ".join(words.event_text(event, event.difference(math.inf)) for event in wrong[:5])
    text += f"; and {len(wrong) - 5} more" if len(wrong) > 5 else ""
    at = wrong[0].time if wrong else None
    order = 0.0 if math.isfinite(limit) else math.inf
    found = [Metric(f"{kind}.order", f"{title}: missing or added", float(len(wrong)), "", order, at, text)]
    worst = max(mine, key=lambda event: abs(event.shift), default=None)
    late, when, text = 0.0, None, ""
    if worst is not None and worst.shift:
        late, when, text = abs(worst.shift), worst.time, words.event_text(worst, SHIFTED)
    found.append(Metric(f"{kind}.time", f"{title}: time", late, "s", limit, when, text))
    return found


def _first(
    both: Pair, differences: Differences, events: list[Event], limits: Tolerance, metrics: list[Metric]
) -> Divergence | None:
    """The first difference beyond its limit."""
    found: list[Divergence] = []
    for series in differences.series:
        limit = limits.limit(f"{series.name}.max")
        k = series.first_over(limit)
        if k is None:
            continue
        text = f"{words.when(both, float(series.t[k]))}: {words.deviation(series, k)}"
        worst = series.worst()
        if series.max > 1.2 * float(series.size[k]):
            at = words.when(both, float(series.t[worst]))
            text += f"; at most {words.number(series.max, series.unit)}, {at}"
        found.append(Divergence(float(series.t[k]), text))
    for event in events:
        limit = limits.limit(f"{event.kind}.time")
        difference = event.difference(limit)
        if difference and math.isfinite(limit):
            at = words.when(both, event.time - 1e-3)
            found.append(Divergence(event.time, f"{at}: {words.event_text(event, difference)}"))
    if not found:
        worst_metric = next((metric for metric in metrics if not metric.ok), None)
        if worst_metric is None:
            return None
        if worst_metric.name == "bits":
            return Divergence(worst_metric.at or 0.0, f"{worst_metric.words}; the track that is kept is the same")
        value, limit_text = (words.number(x, worst_metric.unit) for x in (worst_metric.value, worst_metric.limit))
        text = f"{worst_metric.title} {value}, {limit_text} allowed"
        return Divergence(worst_metric.at or 0.0, f"{text} ({worst_metric.words})" if worst_metric.words else text)
    first = min(found, key=lambda divergence: divergence.t)
    position = differences["position"]
    if "of the golden" not in first.words and position.first_over(limits.limit("position.max")) is not None:
        worst = position.worst()
        far = f"farthest {words.deviation(position, worst)}, {words.when(both, float(position.t[worst]))}"
        first = Divergence(first.t, f"{first.words}; {far}")
    return first


def _trace(both: Pair, differences: Differences, events: list[Event]) -> Divergence | None:
    """The first difference beyond rounding."""
    found = []
    for series in differences.series:
        k = series.first_over(series.quantum)
        if k is not None:
            t = float(series.t[k])
            found.append(Divergence(t, f"{words.when(both, t)}: {words.deviation(series, k)}"))
    for event in events:
        difference = event.difference(0.0011)
        if difference:
            at = words.when(both, event.time - 1e-3)
            found.append(Divergence(event.time, f"{at}: {words.event_text(event, difference)}"))
    return min(found, key=lambda divergence: divergence.t, default=None)


def _notes(golden: Flight, new: Flight) -> list[str]:
    """Known reasons for differences."""
    notes = [f"golden: {note}" for note in golden.notes] + [f"new: {note}" for note in new.notes]
    if golden.header is not None and new.header is not None:
        notes += [f"differs: {text}" for text in identity.differences(golden.header, new.header)]
    if golden.digests is not None and new.digests is not None:
        same = golden.digests["state"] == new.digests["state"]
        notes.append("the vehicle ends in " + ("the same state, bit for bit" if same else "another state, bit for bit"))
    return notes
