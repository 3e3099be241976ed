# SPDX-License-Identifier: BSD-3-Clause
"""``--json``: what a command prints, for programs."""

from __future__ import annotations

import argparse
import json
import math
from typing import Any


def add_json_option(parser: argparse.ArgumentParser, what: str) -> None:
    """Add ``--json``; ``what`` is printed: "a list of ..."."""
    parser.add_argument("--json", action="store_true", help=f"for programs: {what}")


def print_json(value: Any) -> None:
    """Print rows of plain values. JSON has no number that is not finite: null is printed."""
    print(json.dumps(_finite(value), indent=2))


def _finite(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return value
