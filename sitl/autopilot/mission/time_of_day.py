# SPDX-License-Identifier: BSD-3-Clause
"""NAV_DELAY until a time of day, UTC (parameters 2 to 4: hour, minute, second; -1 stands for any)."""

from __future__ import annotations

from .item import MissionItem

ANY = -1
HOUR, MINUTE, SECOND = 3600, 60, 1


def seconds_until(item: MissionItem, now_us: int) -> float:
    """How long it is until the time of ``item`` comes next [s]; ``now_us``: Unix time [us].

    Any hour, and any minute: only what is reported counts. 0 when nothing is reported.
    """
    fields = [(int(item.p2), HOUR, 24 * HOUR), (int(item.p3), MINUTE, HOUR), (int(item.p4), SECOND, MINUTE)]
    while fields and fields[0][0] == ANY:
        fields.pop(0)
    if not fields:
        return 0.0
    round_us = fields[0][2] * 1_000_000
    left_us = -(now_us % round_us)
    for count, unit, _ in fields:
        left_us += count * unit * 1_000_000
    return (left_us + round_us if left_us < 0 else left_us) * 1e-6
