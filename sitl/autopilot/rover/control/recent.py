# SPDX-License-Identifier: BSD-3-Clause
"""Whether a controller ran lately: one that did not starts afresh from what the vehicle does now."""

from __future__ import annotations

from ....core.kernels import law


@law
def now_tick(ap):
    """Stamp of this period; modes run before ``control.update`` counts it."""
    return int(ap.control.tick) + 1


@law
def recent(ap, stamp, periods):
    """Whether ``stamp`` is at most ``periods`` old (0 stands for never)."""
    return stamp != 0 and now_tick(ap) - stamp <= periods
