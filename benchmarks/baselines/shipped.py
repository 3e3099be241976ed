# SPDX-License-Identifier: BSD-3-Clause
"""The policies that come with the package, and their figures for the pages: docs/envs/baselines.json."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sitl.agents import baselines
from sitl.agents.report.statistics import Z, wilson
from sitl.agents.runs.files import write_bytes

DOCS = Path(__file__).parents[2] / "docs"
FILE = DOCS / "envs" / "baselines.json"
Row = dict[str, Any]


def kept() -> dict[str, Row]:
    """The figures as they are written, by the names of policies."""
    found: dict[str, Row] = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    return found


def key_of(name: str) -> str:
    """Key of the training that the policy of this name is from; "": of none that is known."""
    return str(kept().get(name, {}).get("key", ""))


def write(rows: Mapping[str, Row]) -> None:
    """Keep the figures of policies that there are."""
    there = {name: rows[name] for name in baselines.names() if name in rows}
    text = ",\n".join(f"{json.dumps(name)}: {json.dumps(row)}" for name, row in there.items())
    write_bytes(FILE, ("{\n" + text + "\n}\n").encode())


def mean(rewards: Any) -> tuple[float, float]:
    """Mean of some episodes, and half of its 95 % interval by the normal distribution."""
    values = np.asarray(rewards, np.float64)
    return round(float(values.mean()), 1), round(Z * float(values.std(ddof=1)) / math.sqrt(len(values)), 1)


def share(count: int, of: int) -> str:
    """A share and its interval (``wilson``) [%]."""
    low, high = (100.0 * end for end in wilson(count, of))
    return f"{100 * count / of:.1f} % ({low:.1f} .. {high:.1f})"


def median(scores: Mapping[int, tuple[float, float]]) -> int:
    """The seed whose training is in the middle, of an even number the lower one; of equal scores the first.

    Args:
        scores: seed -> success rate, mean reward.
    """
    order = sorted(scores, key=lambda seed: (*scores[seed], -seed))
    return order[(len(order) - 1) // 2]
