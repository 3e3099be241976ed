# SPDX-License-Identifier: BSD-3-Clause
"""Power-on: everything but the parameters starts from nothing."""

from __future__ import annotations

from typing import Any


def clear(v: Any) -> None:
    """Zero the whole vehicle record except the parameters (they live in the autopilot's storage)."""
    v.zero(*(name for name in v.fields if name != "autopilot"))
    v.autopilot.zero(*(name for name in v.autopilot.fields if name != "params"))
