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
        cells = (o.vehicle, o.test, o.result, _cell(o.cause), _cell(o.where), f"{o.wall_s:.0f}")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    text = text.replace("|", "\\|")
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def write(outcomes: Sequence[Outcome], binary: str, speedup: int, path: Path) -> None:
    """Write ``path`` with the endings .md and .json."""
    path.with_suffix(".md").write_text(markdown(outcomes, binary, speedup), encoding="utf-8")
    data = {"binary": binary, "speedup": speedup, "tests": [asdict(outcome) for outcome in outcomes]}
    path.with_suffix(".json").write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
