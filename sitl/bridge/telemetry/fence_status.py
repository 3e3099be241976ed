# SPDX-License-Identifier: BSD-3-Clause
"""FENCE_STATUS, and the fence's bits of SYS_STATUS."""

from __future__ import annotations

from ...autopilot.fence.checks import active
from ...autopilot.fence.state import MAX_ALT, MIN_ALT
from ...core.kernels import law
from ...vehicle.record import Vehicle
from ..wire.message import Message
from .units import boot_ms

NONE, BELOW, ABOVE, BOUNDARY = 0, 1, 2, 3
"""FENCE_BREACH"""
NOT_MITIGATED = 1
"""FENCE_MITIGATE"""


class FenceStatus(Message, name="FENCE_STATUS"):
    breach_time: int
    breach_count: int
    breach_status: int
    breach_type: int
    breach_mitigation: int


@law
def breach_type(breached: int) -> int:
    """FENCE_BREACH of the bits of breached fences."""
    if breached & MIN_ALT != 0:
        return BELOW
    if breached & MAX_ALT != 0:
        return ABOVE
    return BOUNDARY if breached != 0 else NONE


@law
def fence_status(m: FenceStatus, v: Vehicle) -> bool:
    """FENCE_STATUS, while a fence is on: whether it is breached, how often so far, which kind and when it last was."""
    fence = v.autopilot.fence
    m.breach_time = boot_ms(fence.breach_us)
    m.breach_count = fence.breaches & 0xFFFF
    m.breach_status = 1 if fence.breached != 0 else 0
    m.breach_type = breach_type(fence.breached)
    m.breach_mitigation = NOT_MITIGATED
    return fence.on != 0


@law
def is_at_work(v: Vehicle) -> bool:
    """Whether a fence is on and does something about a breach."""
    p = v.autopilot.params.FENCE
    return active(v.autopilot.fence, p) != 0 and p.ACTION != 0.0


MESSAGES = (fence_status,)
