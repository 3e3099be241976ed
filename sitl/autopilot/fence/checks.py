# SPDX-License-Identifier: BSD-3-Clause
"""What the fences watch: which of them are on, and which the vehicle has breached. What follows is each firmware's own.

Behaviour: https://ardupilot.org/copter/docs/common-ac2_simple_geofence.html,
https://ardupilot.org/copter/docs/common-polygon_fence.html
"""

from __future__ import annotations

from typing import Any

from ...core.algebra import horizontal, norm2
from ...core.kernels import law
from ...core.mavlink import MavSeverity
from ...core.vectors import Vec2, Vec3
from ..events import Event, Events, Row, emit, err, ev
from ..log_events import LogErrorSubsystem, LogEvent
from ..modes import ModeReason
from ..notes import Text
from ..params.fence_parameters import Fence
from ..state import Estimate, HomeState, Vehicle
from .shapes import clearance, is_inclusion, use_origin
from .state import (
    AREAS,
    CIRCLE,
    FENCES,
    FLOOR_AUTO,
    FLOOR_OFF,
    FLOOR_ON,
    MAX_ALT,
    MIN_ALT,
    FenceState,
    names,
)

ALL = MAX_ALT | CIRCLE | AREAS | MIN_ALT
NONE = -1e9
"""How far beyond a fence a vehicle is where there is none."""

# FENCE_AUTOENABLE
ON_TAKEOFF, FLOOR_ON_TAKEOFF, WHEN_ARMED = 1, 2, 3
# FENCE_OPTIONS
NO_OTHER_MODE, ONE_IS_ENOUGH, REPORTS_MARGIN = 1, 2, 4

AGAIN = 20.0
"""A breached fence counts as breached anew each time the vehicle gets so much further [m]."""
RECOVERY_US = 10_000_000
"""So long the pilot may bring the vehicle back, after a change of mode."""
GIVE_UP = 100.0
"""Further beyond a fence than this [m] the vehicle does not come back."""

AUTO_OFF, AUTO_ON, BY_FLOOR, OFF, ON = range(5)
"""How fences were switched, as FENCE_SWITCHED says: by themselves; the least height, as the vehicle is above it; by the
user."""
_SWITCHED = {AUTO_OFF: "auto-disabled", AUTO_ON: "auto-enabled", BY_FLOOR: "enabled (auto enable)"}
_SWITCHED_ON = {
    MAX_ALT: LogEvent.FENCE_ALT_MAX_ENABLE,
    CIRCLE: LogEvent.FENCE_CIRCLE_ENABLE,
    MIN_ALT: LogEvent.FENCE_ALT_MIN_ENABLE,
    AREAS: LogEvent.FENCE_POLYGON_ENABLE,
}
"""Number of EV when a fence is switched on; off: the next."""


def _switch_texts(v: Any, fences: float, how: float) -> list[Text]:
    return [Text(MavSeverity.NOTICE, f"{names(int(fences))} {_SWITCHED[int(how)]}")] if how in _SWITCHED else []


def _logged_switch(v: Any, fences: float, how: float) -> list[Row]:
    off = int(how not in (AUTO_ON, BY_FLOOR, ON))
    return [
        ev(LogEvent.FENCE_ENABLE + off),
        *(ev(number + off) for bit, number in _SWITCHED_ON.items() if int(fences) & bit),
    ]


def _near_texts(v: Any, fences: float, clearance: float) -> list[Text]:
    how = "cleared margin breach" if clearance < 0.0 else f"in {clearance:.1f}m"
    return [Text(MavSeverity.NOTICE, f"{names(int(fences))} {how}")]


# a: bits of fences; b of the first two: 1 the pilot is notified
FENCE_BREACHED = Event(
    44,
    says=lambda v, a, b: [Text(MavSeverity.NOTICE, f"{names(int(a))} breached")] if b != 0.0 else [],
    log=lambda v, a, b: [err(LogErrorSubsystem.FAILSAFE_FENCE, int(a))],
)
FENCE_CLEAR = Event(
    45,
    says=lambda v, a, b: [Text(MavSeverity.NOTICE, "Fence breach cleared")] if b != 0.0 else [],
    log=err(LogErrorSubsystem.FAILSAFE_FENCE, 0),
)  # none is breached any more
FENCE_SWITCHED = Event(46, says=_switch_texts, log=_logged_switch)  # b: how
FENCE_NEAR = Event(47, says=_near_texts)  # b: how far they are [m]; below zero: further than the margin again
FENCE_RECOVERY = Event(
    48, MavSeverity.INFO, "Manual recovery started"
)  # the pilot brings the vehicle back behind the fence


@law
def kinds(fence: FenceState, params: Fence) -> int:
    """Bits of the fences that there are: FENCE_TYPE, areas only when some are loaded."""
    chosen = int(params.TYPE)
    return chosen if fence.shapes > 0 else chosen & ~AREAS


@law
def active(fence: FenceState, params: Fence) -> int:
    """Bits of the fences that are on and chosen by FENCE_TYPE."""
    return fence.on & int(params.TYPE)


@law
def beyond_areas(fence: FenceState, point: Vec2, one_is_enough: bool) -> float:
    """How far a point [m, NE from the origin] is beyond the areas [m]; negative: how far from their edges.

    ``one_is_enough``: it has to be in one of the areas to stay in, else in all.
    """
    over, outside = NONE, 1e9
    inclusions = 0
    for s in range(fence.shapes):
        away = -clearance(fence, s, point)
        if one_is_enough and is_inclusion(fence, s):
            inclusions += 1
            outside = min(outside, away)
        else:
            over = max(over, away)
    return max(over, outside) if inclusions > 0 else over


@law
def measure(
    fence: FenceState, estimate: Estimate, home: HomeState, params: Fence, alt_max: float, alt_min: float
) -> None:
    """How far beyond each fence the vehicle is (``over``); without a position what is breached stays so."""
    height = home.pos.z - estimate.pos.z
    fence.over[0], fence.over[3] = height - alt_max, alt_min - height
    if not (estimate.position_ok and home.is_set):
        for k in (1, 2):
            if fence.breached >> k & 1 == 0:
                fence.over[k] = NONE
        return
    fence.over[1] = norm2(horizontal(estimate.pos) - horizontal(home.pos)) - params.RADIUS
    fence.over[2] = NONE
    if fence.is_placed and active(fence, params) & AREAS != 0:
        enough = int(params.OPTIONS) & ONE_IS_ENOUGH != 0
        fence.over[2] = beyond_areas(fence, horizontal(estimate.pos), enough)


@law
def judge(fence: FenceState, k: int, margin: float, time_us: int) -> bool:
    """Whether fence ``k``, which is on, is breached now and was not before, or is breached anew."""
    bit, over = 1 << k, fence.over[k]
    if over >= -margin:
        fence.near |= bit
    else:
        fence.near &= ~bit
    if over < 0.0 or (k == 2 and over == 0.0):
        fence.breached &= ~bit
        return False
    was_breached = fence.breached & bit != 0
    if was_breached and (k == 2 or over < fence.limit[k]):
        return False
    if fence.breached == 0:
        fence.breach_us = time_us
    fence.breaches += 1
    fence.breached |= bit
    fence.limit[k] = over + AGAIN
    return True


@law
def switch(fence: FenceState, how: int, chosen: int, events: Events, time_us: int) -> None:
    """Switch fences on or off, and report those that were not so before."""
    before, on = fence.on, how in (AUTO_ON, BY_FLOOR, ON)
    fence.on = before | chosen if on else before & ~chosen
    if not on:
        fence.breached &= ~chosen
        fence.near &= ~chosen
    if fence.on != before:
        emit(events, time_us, FENCE_SWITCHED, float(before ^ fence.on), float(how))


@law
def switch_by_user(fence: FenceState, on: bool, chosen: int, params: Fence, events: Events, time_us: int) -> None:
    """A command or a switch puts the fences ``chosen`` on or off, as far as FENCE_TYPE has them."""
    if chosen & int(params.TYPE) & MIN_ALT != 0:
        fence.floor = FLOOR_ON if on else FLOOR_OFF
    switch(fence, ON if on else OFF, chosen & int(params.TYPE), events, time_us)


@law
def follow_parameters(fence: FenceState, params: Fence, autoenable: int, events: Events, time_us: int) -> None:
    """FENCE_ENABLE or FENCE_AUTOENABLE has been set: all fences but the least height are on, or all off, with it."""
    enable = int(params.ENABLE)
    if enable != fence.seen_enable or autoenable != fence.seen_autoenable:
        fence.seen_enable, fence.seen_autoenable = enable, autoenable
        fence.floor = FLOOR_AUTO
        if enable != 0:
            switch(fence, ON, int(params.TYPE) & ~MIN_ALT, events, time_us)
        else:
            switch(fence, OFF, ALL, events, time_us)


@law
def rests(fence: FenceState, autoenable: int) -> int:
    """Bits of the fences that are off while the vehicle stands or lands."""
    resting = ALL if autoenable == ON_TAKEOFF else MIN_ALT
    return resting & ~MIN_ALT if fence.floor == FLOOR_ON else resting


@law
def switch_floor(fence: FenceState, params: Fence, autoenable: int, events: Events, time_us: int) -> None:
    """The least height is on once the vehicle is above it, unless a take-off switches it or the user has."""
    if int(params.TYPE) & MIN_ALT == 0 or fence.on & MIN_ALT != 0 or fence.floor == FLOOR_OFF:
        return
    if params.ENABLE == 0.0 and autoenable in (0, ON_TAKEOFF):
        return
    if fence.over[3] <= -params.MARGIN:
        switch(fence, BY_FLOOR, MIN_ALT, events, time_us)


@law
def margin_of(kind: int, params: Fence) -> float:
    """Clearance that is kept to a fence of a ``kind`` [m]: FENCE_MARGIN_XY to the circle and to areas, if given."""
    if kind & (CIRCLE | AREAS) != 0 and params.MARGIN_XY > 0.0:
        return params.MARGIN_XY
    return params.MARGIN


@law
def report_margin(fence: FenceState, before: int, params: Fence, events: Events, time_us: int) -> None:
    """FENCE_OPTIONS 4: within the margin of which fences the vehicle is, breached ones, too, and how far the first of
    them is; anew with each further fence, while not all of them are breached. And that it has left a margin."""
    if int(params.OPTIONS) & REPORTS_MARGIN == 0:
        return
    left = before & ~fence.near
    if left != 0:
        emit(events, time_us, FENCE_NEAR, float(left), -1.0)
    if fence.near & ~fence.breached == 0 or params.NTF_FREQ <= 0.0:
        return
    if fence.near & ~before == 0 and time_us - fence.reported_us < 1e6 / params.NTF_FREQ:
        return
    nearest = 1e9
    for k in range(FENCES):
        if fence.near >> k & 1 != 0:
            nearest = min(nearest, -fence.over[k])
    fence.reported_us = time_us
    emit(events, time_us, FENCE_NEAR, float(fence.near), abs(nearest))


@law
def check(v: Vehicle, limits: Vec3, standing: bool) -> int:
    """Bits of the fences that the vehicle has breached now, or anew.

    Args:
        v: the vehicle.
        limits: greatest height, least height [m above home], FENCE_AUTOENABLE.
        standing: it stands on the ground, or lands.
    """
    ap, time_us = v.autopilot, v.time_us
    fence, params, events, autoenable = ap.fence, ap.params.FENCE, ap.events, int(limits.z)
    follow_parameters(fence, params, autoenable, events, time_us)
    fence.breached &= int(params.TYPE)
    if fence.on == 0 and (fence.floor != FLOOR_AUTO or (params.ENABLE == 0.0 and autoenable == 0)):
        fence.breached = fence.near = 0
        return 0
    use_origin(fence, ap.estimate)
    if standing:
        switch(fence, AUTO_OFF, rests(fence, autoenable) & int(params.TYPE), events, time_us)
    measure(fence, ap.estimate, ap.home, params, limits.x, limits.y)
    if not standing:
        switch_floor(fence, params, autoenable, events, time_us)
    watched, new, near = active(fence, params), 0, fence.near
    for k in range(FENCES):
        if watched >> k & 1 != 0 and judge(fence, k, margin_of(1 << k, params), time_us):
            new |= 1 << k
    report_margin(fence, near, params, events, time_us)
    if fence.recovery_us != 0:
        if time_us - fence.recovery_us < RECOVERY_US:
            return 0
        fence.recovery_us = 0
    return new


@law
def farthest(fence: FenceState, chosen: int) -> float:
    """How far beyond those of the fences ``chosen`` the vehicle is, the greatest of the distances [m]."""
    over = 0.0
    for k in range(FENCES):
        if chosen >> k & 1 != 0:
            over = max(over, fence.over[k])
    return over


@law
def report(fence: FenceState, before: int, new: int, reported: bool, events: Events, time_us: int) -> None:
    """Emit that fences are breached (``new``), or that none is any more, when some were ``before``."""
    if new != 0:
        emit(events, time_us, FENCE_BREACHED, float(new), 1.0 if reported else 0.0)
    elif before != 0 and fence.breached == 0:
        emit(events, time_us, FENCE_CLEAR, 0.0, 1.0 if reported else 0.0)


@law
def keeps_mode(fence: FenceState, reason: int, params: Fence) -> bool:
    """FENCE_OPTIONS 1: whether a mode that was entered for a breached fence (``reason``) is kept until it is not."""
    kept = int(params.OPTIONS) & NO_OTHER_MODE != 0
    return kept and reason == ModeReason.FENCE_BREACHED and active(fence, params) & fence.breached != 0


@law
def begin_recovery(fence: FenceState, params: Fence, events: Events, time_us: int) -> None:
    """The mode has changed: while a fence is breached that is the pilot, or the autopilot, who brings it back."""
    if fence.breached != 0 and params.ACTION != 0.0:
        fence.recovery_us = time_us
        emit(events, time_us, FENCE_RECOVERY, 0.0, 0.0)


@law
def switch_on_arming(fence: FenceState, params: Fence, autoenable: int, events: Events, time_us: int) -> None:
    """FENCE_AUTOENABLE 3: all fences but the least height."""
    if autoenable == WHEN_ARMED:
        fence.floor = FLOOR_AUTO
        switch(fence, AUTO_ON, int(params.TYPE) & ~MIN_ALT, events, time_us)


@law
def switch_on_disarming(fence: FenceState, autoenable: int, events: Events, time_us: int) -> None:
    """FENCE_AUTOENABLE 3: all off."""
    if autoenable == WHEN_ARMED:
        switch(fence, AUTO_OFF, ALL, events, time_us)


@law
def switch_after_takeoff(fence: FenceState, params: Fence, autoenable: int, events: Events, time_us: int) -> None:
    """FENCE_AUTOENABLE 1, 2: all fences, once an automatic take-off is done."""
    if autoenable in (ON_TAKEOFF, FLOOR_ON_TAKEOFF):
        switch(fence, AUTO_ON, int(params.TYPE), events, time_us)


@law
def allows(fence: FenceState, home: HomeState, position: Vec3, params: Fence, alt_max: float, alt_min: float) -> bool:
    """Whether a position [m, NED from the origin] is within all fences that are on."""
    watched, height = active(fence, params), home.pos.z - position.z
    if watched & MAX_ALT != 0 and height > alt_max:
        return False
    if watched & MIN_ALT != 0 and height < alt_min:
        return False
    if watched & CIRCLE != 0 and norm2(horizontal(position) - horizontal(home.pos)) > params.RADIUS:
        return False
    if watched & AREAS == 0 or not fence.is_placed:
        return True
    return beyond_areas(fence, horizontal(position), int(params.OPTIONS) & ONE_IS_ENOUGH != 0) <= 0.0
