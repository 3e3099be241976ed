# SPDX-License-Identifier: BSD-3-Clause
"""The table of a run, as Markdown and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

LONGEST = 240
"""Characters of a cause in the Markdown table."""


@dataclass(frozen=True)
class Outcome:
    """What became of a test."""

    vehicle: str
    test: str
    result: str
    """"pass", "fail", "timeout" (it was ended) or "error" (it could not be run)."""
    cause: str
    """The first error's text; "" when it passed."""
    where: str
    """The line of the tests at which it came up, "" when not known."""
    wall_s: float


def markdown(outcomes: Sequence[Outcome], binary: str, speedup: int) -> str:
    """The table, failures first."""
    passed = sum(outcome.result == "pass" for outcome in outcomes)
    lines = [
        f"{passed} of {len(outcomes)} pass (`{binary}`, speed-up {speedup}).", "",
        "| vehicle | test | result | first cause | where | wall [s] |", "|---|---|---|---|---|---:|",
    ]  # fmt: skip
    for o in sorted(outcomes, key=lambda o: (o.result == "pass", o.vehicle, o.test)):
        cause = o.cause.replace("|", "\\|")
        cause = cause if len(cause) <= LONGEST else cause[: LONGEST - 3] + "..."
        lines.append(f"| {o.vehicle} | {o.test} | {o.result} | {cause} | {o.where} | {o.wall_s:.0f} |")
    return "\n".join(lines) + "\n"


def write(outcomes: Sequence[Outcome], binary: str, speedup: int, path: Path) -> None:
    """Write ``path`` with the endings .md and .json."""
    path.with_suffix(".md").write_text(markdown(outcomes, binary, speedup), encoding="utf-8")
    data = {"binary": binary, "speedup": speedup, "tests": [asdict(outcome) for outcome in outcomes]}
    path.with_suffix(".json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
