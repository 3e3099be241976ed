# SPDX-License-Identifier: BSD-3-Clause
"""What the pilot is told of fences."""

from __future__ import annotations

from ..events import FENCE_BREACHED, FENCE_CLEAR, FENCE_NEAR, FENCE_RECOVERY, FENCE_SWITCHED
from ..mission.notes import INFO, NOTICE, Text
from .checks import AUTO_OFF, AUTO_ON, BY_FLOOR
from .state import AREAS, CIRCLE, MAX_ALT, MIN_ALT

NAMES = {MAX_ALT: "Max Alt", CIRCLE: "Circle", AREAS: "Polygon", MIN_ALT: "Min Alt"}
_SWITCHED = {AUTO_OFF: "auto-disabled", AUTO_ON: "auto-enabled", BY_FLOOR: "enabled (auto enable)"}


def names(fences: int) -> str:
    """ "Circle and Polygon fences" of the bits of fences."""
    listed = [name for bit, name in NAMES.items() if fences & bit]
    joined = " and ".join([", ".join(listed[:-1]), listed[-1]] if len(listed) > 1 else listed)
    return f"{joined} fences" if len(listed) > 1 else f"{joined} fence"


def note(code: int, a: float, b: float) -> Text | None:
    """What an event of the fence says; None: it is no such event."""
    if code == FENCE_BREACHED and b != 0.0:
        return Text(NOTICE, f"{names(int(a))} breached")
    if code == FENCE_CLEAR and b != 0.0:
        return Text(NOTICE, "Fence breach cleared")
    if code == FENCE_SWITCHED and b in _SWITCHED:
        return Text(NOTICE, f"{names(int(a))} {_SWITCHED[int(b)]}")
    if code == FENCE_NEAR:
        how = "cleared margin breach" if b < 0.0 else f"in {b:.1f}m"
        return Text(NOTICE, f"{names(int(a))} {how}")
    return Text(INFO, "Manual recovery started") if code == FENCE_RECOVERY else None
