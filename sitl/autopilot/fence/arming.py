# SPDX-License-Identifier: BSD-3-Clause
"""Why the fence does not let a vehicle be armed, as a number; 1 .. 15 are bits of breached fences."""

from __future__ import annotations

from ...core.kernels import law
from ...core.vectors import Vec3
from ..params.fence_parameters import Fence
from ..state import Estimate, HomeState
from .checks import kinds, margin_of
from .state import AREAS, CIRCLE, MAX_ALT, MIN_ALT, FenceState, names

READY = 0
NONE_CHOSEN, NEEDS_POSITION, BAD_RADIUS, BAD_ALT_MAX, BAD_ALT_MIN, BAD_ORDER, BAD_MARGIN, BIG_MARGIN = range(16, 24)
SMALL_CIRCLE, BAD_MARGIN_XY = 24, 25

_TEXTS = {
    NONE_CHOSEN: "Fences enabled, but none selected",
    NEEDS_POSITION: "Fence requires position",
    BAD_RADIUS: "Invalid Circle FENCE_RADIUS value",
    BAD_ALT_MAX: "Invalid FENCE_ALT_MAX value",
    BAD_ALT_MIN: "Invalid FENCE_ALT_MIN value",
    BAD_ORDER: "FENCE_ALT_MAX < FENCE_ALT_MIN",
    BAD_MARGIN: "Invalid FENCE_MARGIN value",
    BAD_MARGIN_XY: "Invalid FENCE_MARGIN_XY value",
    BIG_MARGIN: "FENCE_MARGIN too big",
    SMALL_CIRCLE: "Circle FENCE_MARGIN is greater than FENCE_RADIUS",
}
_LOWEST = -100.0
"""Of FENCE_ALT_MIN [m]."""


def text(refusal: int) -> str:
    """What is reported of a refusal."""
    return _TEXTS.get(refusal) or f"Vehicle breaching {names(refusal)}"


@law
def needs_position(fence: FenceState, params: Fence) -> bool:
    """Whether a fence is on that means nothing without a position."""
    return fence.on & int(params.TYPE) & (CIRCLE | AREAS) != 0


@law
def refusal(
    fence: FenceState,
    estimate: Estimate,
    home: HomeState,
    params: Fence,
    limits: Vec3,
) -> int:
    """READY, or the first reason why not; ``limits`` as of ``checks.check``."""
    chosen, alt_max, alt_min, autoenable = kinds(fence, params), limits.x, limits.y, int(limits.z)
    if params.ENABLE != 0.0 and chosen == 0:
        return NONE_CHOSEN
    if (fence.on == 0 and autoenable == 0) or chosen == 0:
        return READY
    if chosen & (CIRCLE | AREAS) != 0 and not (estimate.origin_set and home.is_set):
        return NEEDS_POSITION
    if chosen & CIRCLE != 0 and params.RADIUS < 0.0:
        return BAD_RADIUS
    if chosen & MAX_ALT != 0 and alt_max < 0.0:
        return BAD_ALT_MAX
    if chosen & MIN_ALT != 0 and alt_min < _LOWEST:
        return BAD_ALT_MIN
    if fence.breached != 0:
        return fence.breached
    if params.MARGIN < 0.0:
        return BAD_MARGIN
    if params.MARGIN_XY < 0.0:
        return BAD_MARGIN_XY
    if chosen & CIRCLE != 0 and margin_of(CIRCLE, params) > params.RADIUS:
        return SMALL_CIRCLE
    if chosen & (MAX_ALT | MIN_ALT) == MAX_ALT | MIN_ALT:
        if alt_max < alt_min:
            return BAD_ORDER
        if alt_max - alt_min <= 2.0 * params.MARGIN:
            return BIG_MARGIN
    return READY
