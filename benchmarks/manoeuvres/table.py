# SPDX-License-Identifier: BSD-3-Clause
"""Metrics of two vehicles side by side, and whether they agree."""

from __future__ import annotations

import json
import math
import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any

from sitl.errors import SitlError

from .flyer import Metrics

PERCENT = 5.0
CLOSE = {"m": 0.5, "s": 0.1, "deg": 1.0}
"""Differences that are small whatever the metric is, by unit; of times only where they are below ``SHORT_S``."""
SHORT_S = 2.0
RULE = (
    f"A metric agrees when the two differ by at most {PERCENT:g} %, or {CLOSE['m']:g} m, or {CLOSE['deg']:g} deg, "
    f"or, of times below {SHORT_S:g} s, {CLOSE['s']:g} s; a metric that neither vehicle reaches agrees, too."
)


class KeptMetricsError(SitlError, ValueError):
    """Metrics of ArduPilot that are not kept."""


@dataclass(frozen=True)
class Row:
    """One metric of both."""

    flight: str
    name: str
    unit: str
    ours: float
    theirs: float

    @property
    def percent(self) -> float:
        """Difference in percent of theirs."""
        return 100.0 * (self.ours - self.theirs) / abs(self.theirs) if self.theirs else math.nan

    @property
    def agrees(self) -> bool:
        """By ``RULE``."""
        if math.isnan(self.ours) or math.isnan(self.theirs):
            return math.isnan(self.ours) and math.isnan(self.theirs)
        close = CLOSE.get(self.unit, 0.0)
        if self.unit == "s" and self.theirs >= SHORT_S:
            close = 0.0
        return abs(self.percent) <= PERCENT or abs(self.ours - self.theirs) <= close


def within(row: Row) -> bool:
    """By the percentage and the distance alone."""
    never = math.isnan(row.ours) and math.isnan(row.theirs)
    return never or abs(row.percent) <= PERCENT or (row.unit == "m" and abs(row.ours - row.theirs) <= CLOSE["m"])


def rows(ours: Mapping[str, Metrics], theirs: Mapping[str, Metrics]) -> list[Row]:
    """All metrics that both have, flight by flight."""
    return [
        Row(flight, name, unit, value, theirs[flight][name][0])
        for flight, metrics in ours.items()
        if flight in theirs
        for name, (value, unit) in metrics.items()
        if name in theirs[flight]
    ]


def medians(flown: Sequence[Mapping[str, Metrics]]) -> dict[str, Metrics]:
    """Each metric's median over flights of the same scripts; one that is not reached counts as greater than any."""
    found: dict[str, Metrics] = {}
    for flight, metrics in flown[0].items():
        found[flight] = {}
        for name, (_, unit) in metrics.items():
            values = [others[flight][name][0] for others in flown]
            value = statistics.median_low(math.inf if math.isnan(x) else x for x in values)
            found[flight][name] = (math.nan if math.isinf(value) else value, unit)
    return found


def _shown(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def markdown(found: list[Row]) -> str:
    """The table."""
    lines = ["| | metric | unit | ours | ArduPilot | difference |", "|---|---|---|---:|---:|---:|"]
    for row in found:
        percent = "" if math.isnan(row.percent) else f"{row.percent:+.1f} %"
        mark = "" if row.agrees else "**differs**"
        lines.append(f"| {mark} | {row.name} | {row.unit} | {_shown(row.ours)} | {_shown(row.theirs)} | {percent} |")
    return "\n".join(lines)


def summary(found: list[Row]) -> str:
    """How many agree."""
    agree = sum(row.agrees for row in found)
    return f"{agree} of {len(found)} metrics agree ({100.0 * agree / max(len(found), 1):.1f} %)"


def file_name(kind: str) -> str:
    """Of the kept metrics of ArduPilot."""
    return f"manoeuvres_{kind}.json"


def kept(kind: str) -> dict[str, Any]:
    """ArduPilot's metrics as they were measured last: "version", "date", "metrics".

    Raises:
        KeptMetricsError: there are none.
    """
    file = resources.files("benchmarks") / "reference" / file_name(kind)
    if not file.is_file():
        raise KeptMetricsError(f"no metrics of a {kind} are kept: fly them with --ardupilot PATH --keep")
    found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    found["metrics"] = {
        flight: {name: (math.nan if value is None else value, unit) for name, (value, unit) in metrics.items()}
        for flight, metrics in found["metrics"].items()
    }
    return found


def as_json(version: str, date: str, metrics: Mapping[str, Metrics]) -> str:
    """The file of kept metrics."""
    plain = {
        flight: {name: [None if math.isnan(value) else round(value, 4), unit] for name, (value, unit) in fs.items()}
        for flight, fs in metrics.items()
    }
    return json.dumps({"version": version, "date": date, "metrics": plain}, indent=1) + "\n"
