# SPDX-License-Identifier: BSD-3-Clause
"""The rover's fence: what follows a breach (FENCE_ACTION)."""

from __future__ import annotations

from ...core.kernels import law
from ..arming_checks import ArmingMethod
from ..fence.checks import GIVE_UP, check, farthest, report
from ..modes import ModeReason, ModeResult
from .arming import set_disarmed
from .heights import HEIGHTS
from .modes import set_mode
from .modes.hold import HOLD
from .modes.loiter import LOITER
from .modes.rtl import RTL
from .modes.smart_rtl import SMART_RTL
from .state import Vehicle

# FENCE_ACTION; unknown numbers do nothing
_NOTHING, _RTL, _HOLD, _SMART_RTL, _SMART_RTL_OR_HOLD, _TERMINATE, _LOITER = range(7)


@law
def watch(v: Vehicle) -> None:
    """Ten times a second: whether a fence is breached."""
    ap = v.autopilot
    fence, p, before = ap.fence, ap.params.FENCE, ap.fence.breached
    new = check(v, HEIGHTS, False)
    if not ap.arming.armed:
        return
    report(fence, before, new, False, ap.events, v.time_us)
    if new != 0 and p.ACTION != _NOTHING:
        act(v, int(p.ACTION) if farthest(fence, new) <= GIVE_UP else _HOLD)


@law
def act(v: Vehicle, action: int) -> None:
    """Do what FENCE_ACTION says; what cannot be entered becomes the next best, HOLD at last."""
    if action == _TERMINATE:
        set_disarmed(v.autopilot.arming, v.autopilot.events, v.time_us, ArmingMethod.FENCE)
    if not _NOTHING < action <= _LOITER or action == _TERMINATE:
        return
    if action == _LOITER and set_mode.request(v, LOITER, ModeReason.FENCE_BREACHED) == ModeResult.ACCEPTED:
        return
    if action in (_SMART_RTL, _SMART_RTL_OR_HOLD):
        if set_mode.request(v, SMART_RTL, ModeReason.FENCE_BREACHED) == ModeResult.ACCEPTED:
            return
    if action in (_RTL, _SMART_RTL):
        if set_mode.request(v, RTL, ModeReason.FENCE_BREACHED) == ModeResult.ACCEPTED:
            return
    set_mode.request(v, HOLD, ModeReason.FENCE_BREACHED)
