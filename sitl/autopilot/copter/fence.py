# SPDX-License-Identifier: BSD-3-Clause
"""The copter's fence: what follows a breach (FENCE_ACTION), and when fences switch themselves."""

from __future__ import annotations

from ...core.kernels import law
from ...core.vectors import Vec3
from ..arming_checks import ArmingMethod
from ..fence.checks import GIVE_UP, check, farthest, report
from ..fence.state import MAX_ALT
from ..modes import ModeReason, ModeResult
from .failsafe_actions import is_idle
from .modes import ground, set_mode
from .modes.brake import BRAKE
from .modes.land import LAND
from .modes.mode_list import is_landing
from .modes.rtl import RTL
from .modes.smart_rtl import SMART_RTL
from .state import Vehicle

TICKS = 16
"""The fence is looked at 25 times a second."""

# FENCE_ACTION; unknown numbers RTL
_NOTHING, _RTL, _LAND, _SMART_RTL, _BRAKE, _SMART_RTL_OR_LAND = range(6)


@law
def watch(v: Vehicle) -> None:
    """25 times a second: whether a fence is breached."""
    ap = v.autopilot
    fence, p, flies = ap.fence, ap.params.FENCE, not ap.arming.landed
    before = fence.breached
    standing = not (ap.arming.armed and flies) or is_landing(ap.modes.number, ap.modes)
    limits = Vec3(p.ALT_MAX, p.ALT_MIN, p.AUTOENABLE)
    new = check(v, limits, standing)
    if ap.arming.armed:
        report(fence, before, new, flies, ap.events, v.time_us)
        if new != 0 and p.ACTION != _NOTHING:
            act(v, new)


@law
def act(v: Vehicle, new: int) -> None:
    """Do what FENCE_ACTION says about the fences breached: LAND at once far beyond them, and disarm on the ground."""
    ap = v.autopilot
    action = int(ap.params.FENCE.ACTION)
    is_excused = ap.modes.failsafe.radio or ap.fence.breached & MAX_ALT != 0  # who is too high closes the throttle
    if ap.arming.landed or (is_idle(ap.modes, False) and not is_excused):
        ground.disarm(v, ArmingMethod.FENCE)
        return
    if farthest(ap.fence, new) > GIVE_UP:
        action = _LAND
    if action in (_SMART_RTL, _SMART_RTL_OR_LAND):
        if set_mode.request(v, SMART_RTL, ModeReason.FENCE_BREACHED) == ModeResult.ACCEPTED:
            return
        action = _RTL if action == _SMART_RTL else _LAND
    if action == _BRAKE:
        if set_mode.request(v, BRAKE, ModeReason.FENCE_BREACHED) == ModeResult.ACCEPTED:
            return
    elif action != _LAND:
        if set_mode.request(v, RTL, ModeReason.FENCE_BREACHED) == ModeResult.ACCEPTED:
            return
    set_mode.request(v, LAND, ModeReason.FENCE_BREACHED)
