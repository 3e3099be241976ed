# SPDX-License-Identifier: BSD-3-Clause
"""BendyRuler (OA_TYPE 1, 3): once a second the bearing nearest to the destination's that is free of fences and objects.

A bearing is free when the vehicle keeps OA_MARGIN_MAX as far as it looks ahead, and then as far again in one of three
directions. It looks OA_BR_LOOKAHEAD far; nearer, down to half of it, while no bearing is free. A bearing that differs
much from the last one (OA_BR_CONT_ANGLE) has to be better by OA_BR_CONT_RATIO. While a bearing bends away from the
destination, or would soon, the vehicle steers for the position at its end (vertically for one as far as the
destination).

Behaviour: https://ardupilot.org/copter/docs/common-oa-bendyruler.html
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from ...core.algebra import cross2, direction, dot, dot2, horizontal, norm, norm2, with_down
from ...core.elementary import atan2, hypot, sincos
from ...core.geodesy import location_e7
from ...core.kernels import law
from ...core.scalars import constrain, wrap_pi
from ...core.vectors import Vec2, Vec3
from ..events import Event, Row, emit, emit_and_return
from ..fence import shapes
from ..fence.checks import active
from ..fence.checks import margin_of as wanted_margin
from ..fence.state import AREAS, CIRCLE, MAX_ALT, FenceState
from ..navigation.state import BENT, DETOUR_REQUEST, ENDED, LEG_ENDING, STRAIGHT
from ..state import Autopilot
from . import objects
from .objects import BENDY_RULER
from .state import OBJECTS

PERIOD_US = 1_000_000
RECENT_US = 500_000
"""Legs that were followed so long ago still are."""
STEP = math.radians(5.0)
STEPS = 34
"""Bearings are tried up to so many steps to each side."""
SLOPE_STEP, SLOPE_STEPS = math.radians(90.0), 2
"""Vertically: level, up, down, back."""
TURN, SLOPE_TURN = math.radians(45.0), math.radians(80.0)
"""The second look goes towards the destination, and so far to both sides of it."""
PAST = 2.0
"""It looks so far past the destination [m]."""
SLOW = 0.2
"""Below this speed [m/s] the nose is the course."""
FAR = 1e9


def _rows(v: Any, margin: float, how: float) -> list[Row]:
    """OABR"""
    ap = v.autopilot
    nav, est, here, home = ap.modes.nav, ap.estimate, ap.estimate.pos, ap.home.pos.z
    upright = getattr(ap.params.OA, "BR_TYPE", 1.0) == 2.0  # a copter's
    target = nav.detour.bent_target
    towards = atan2(nav.target.y - here.y, nav.target.x - here.x)
    slope = atan2(here.z - target.z, hypot(target.x - here.x, target.y - here.y)) if upright else 0.0
    angles = (round(math.degrees(angle)) % 360 for angle in (towards, est.yaw, slope))
    origin = est.origin_lat, est.origin_lon
    locations = [(*location_e7(*origin, pos.x, pos.y), home - pos.z) for pos in (nav.target, target)]
    return [("OABR", (2 if upright else 1, int(how) & 1, *angles, int(how) >> 1, margin, *locations[0], *locations[1]))]


BENDY_RULER_LOOKED = Event(72, log=_rows)  # a: margin [m], b: 1 it steers, 3 and goes on as before


class Ruler(NamedTuple):
    """What a look starts from."""

    pos: Vec3  # NED [m]
    destination: Vec3
    bearing: float  # to the destination [rad]
    distance: float  # [m]
    first: float  # how far the first look goes [m], and
    second: float  # the second
    course: float  # [rad]
    upright: bool  # slopes are tried in place of bearings
    objects_only: bool  # fences are not looked at


class Found(NamedTuple):
    """What a look has found."""

    angle: float  # from the direction to the destination [rad]
    margin: float  # that it keeps [m]
    is_free: bool
    bends: bool  # the vehicle is steered
    is_kept: bool  # it goes on as before


@law
def distance_to_segment(point: Vec3, a: Vec3, b: Vec3) -> float:
    """Of a point to the line between two others [m]."""
    delta = b - a
    length = dot(delta, delta)
    share = constrain(dot(point - a, delta) / length, 0.0, 1.0) if length > 0.0 else 0.0
    return norm(a + delta * share - point)


@law
def crosses(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool:
    """Whether the lines from ``a`` to ``b`` and from ``c`` to ``d`` cross."""
    delta, edge = b - a, d - c
    on_edge = cross2(delta, c - a) * cross2(delta, d - a) < 0.0
    return on_edge and cross2(edge, a - c) * cross2(edge, b - c) < 0.0


@law
def flat(point: Vec2) -> Vec3:
    """A position on the plane."""
    return Vec3(point.x, point.y, 0.0)


@law
def margin_of_polygon(fence: FenceState, s: int, a: Vec2, b: Vec2) -> float:
    """How far a path stays from the edges of polygon ``s`` [m]; below zero when it crosses them."""
    margin = FAR
    for k in range(int(fence.count[s])):
        c, d = shapes.corner_of(fence, s, k), shapes.corner_of(fence, s, k + 1)
        if crosses(a, b, c, d):
            return -norm2(b - a)
        margin = min(margin, distance_to_segment(flat(a), flat(c), flat(d)))
        margin = min(margin, distance_to_segment(flat(b), flat(c), flat(d)))
        margin = min(margin, distance_to_segment(flat(c), flat(a), flat(b)))
    return margin if shapes.is_in_polygon(fence, s, a) == shapes.is_inclusion(fence, s) else -margin


@law
def margin_of_area(fence: FenceState, s: int, a: Vec2, b: Vec2) -> float:
    """How far a path stays from the edge of area ``s`` [m]; below zero where it does not."""
    if not shapes.is_circle(fence, s):
        return margin_of_polygon(fence, s, a, b)
    centre, radius = shapes.centre(fence, s), float(fence.radius[s])
    if shapes.is_inclusion(fence, s):
        return radius - max(norm2(a - centre), norm2(b - centre))
    return distance_to_segment(flat(centre), flat(a), flat(b)) - radius


@law
def margin_of_fences(ap: Autopilot, a: Vec3, b: Vec3, upright: bool) -> float:
    """How far a path stays from all fences that are on, and their margins [m]."""
    fence, p, margin = ap.fence, ap.params.FENCE, FAR
    on, home = active(fence, p), ap.home.pos
    if (on & CIRCLE) != 0 and ap.home.is_set:
        away = max(norm2(horizontal(a) - horizontal(home)), norm2(horizontal(b) - horizontal(home)))
        margin = p.RADIUS - away
    if (on & AREAS) != 0 and fence.is_placed:
        for s in range(fence.shapes):
            margin = min(margin, margin_of_area(fence, s, horizontal(a), horizontal(b)))
    margin -= wanted_margin(CIRCLE, p)
    if upright and (on & MAX_ALT) != 0:
        margin = min(margin, min(a.z, b.z) - ap.estimate.pos.z - fence.over[0] - wanted_margin(MAX_ALT, p))
    return margin


@law
def margin_of_objects(ap: Autopilot, a: Vec3, b: Vec3, time_us: int) -> float:
    """How far a path stays from all objects [m]."""
    margin = FAR
    for k in range(OBJECTS):
        if objects.is_known(ap.objects, k, time_us):
            away = distance_to_segment(objects.position(ap.objects, k), a, b)
            margin = min(margin, away - ap.objects.radius[k])
    return margin


@law
def margin_of(ap: Autopilot, a: Vec3, b: Vec3, ruler: Ruler, time_us: int) -> float:
    """How far a path stays from everything [m]."""
    margin = margin_of_objects(ap, a, b, time_us)
    return margin if ruler.objects_only else min(margin, margin_of_fences(ap, a, b, ruler.upright))


@law
def ahead(start: Vec3, bearing: float, slope: float, distance: float) -> Vec3:
    """The position in a direction; ``slope``: up positive [rad]."""
    rise, level = sincos(slope)
    return start + with_down(direction(bearing) * (level * distance), -rise * distance)


@law
def towards(ruler: Ruler, angle: float, distance: float) -> Vec3:
    """The position at an angle [rad] from the direction to the destination."""
    if ruler.upright:
        return ahead(ruler.pos, ruler.bearing, angle, distance)
    return ahead(ruler.pos, ruler.bearing + angle, 0.0, distance)


@law
def clear_side(ap: Autopilot, ruler: Ruler, start: Vec3, time_us: int) -> int:
    """From the end of the first look: 0 the path to the destination is free, 1 or 2 one beside it; -1 none."""
    offset = ruler.destination - start
    level = norm2(horizontal(offset))
    bearing = atan2(offset.y, offset.x)
    distance = constrain(ruler.second, PAST, max(norm(offset) if ruler.upright else level, PAST))
    for k in range(3):
        side = float(k if k < 2 else -1)
        if ruler.upright:
            end = ahead(start, bearing, atan2(-offset.z, level) + side * SLOPE_TURN, distance)
        else:
            end = ahead(start, bearing + side * TURN, 0.0, distance)
        if margin_of(ap, start, end, ruler, time_us) > ap.params.OA.MARGIN_MAX:
            return k
    return -1


@law
def is_same_position(a: Vec2, b: Vec2) -> bool:
    """Whether two positions are one."""
    return a.x == b.x and a.y == b.y


@law
def kept(ap: Autopilot, ruler: Ruler, found: Found, time_us: int) -> Found:
    """``found``, or the last direction again where a great change gains little."""
    detour, p = ap.modes.nav.detour, ap.params.OA.BR
    same = is_same_position(detour.bent_from, horizontal(ruler.destination))
    if found.bends and same and p.CONT_RATIO > 0.0:
        last = wrap_pi(detour.bearing if ruler.upright else detour.bearing - ruler.bearing)
        if abs(wrap_pi(last - found.angle)) > math.radians(p.CONT_ANGLE):
            margin = margin_of(ap, ruler.pos, towards(ruler, last, ruler.first), ruler, time_us)
            if found.margin < p.CONT_RATIO * margin:
                found = Found(last, margin, True, True, True)
    else:
        detour.bent_from = horizontal(ruler.destination)
    detour.bearing = found.angle if ruler.upright else wrap_pi(ruler.bearing + found.angle)
    return found


@law
def look(ap: Autopilot, ruler: Ruler, time_us: int) -> Found:
    """The first direction that is free; else one that is so as far as the first look goes, as near to the course as
    can be; else the one with the greatest margin."""
    margin_max = ap.params.OA.MARGIN_MAX
    widest, half = Found(0.0, -FAR, False, True, False), Found(0.0, -FAR, False, True, False)
    step, steps = (SLOPE_STEP, SLOPE_STEPS) if ruler.upright else (STEP, STEPS)
    for i in range(2 * steps + 1):
        angle = step * ((i + 1) // 2) * (1.0 if i % 2 == 0 else -1.0)
        if ruler.upright:
            angle = -angle  # up first
        end = towards(ruler, angle, ruler.first)
        margin = margin_of(ap, ruler.pos, end, ruler, time_us)
        if margin > widest.margin:
            widest = Found(angle, margin, False, True, False)
        if margin > margin_max:
            turn = abs(wrap_pi(ruler.course - ruler.bearing - angle))
            if half.margin == -FAR or turn < abs(wrap_pi(ruler.course - ruler.bearing - half.angle)):
                half = Found(angle, margin, False, True, False)
            side = clear_side(ap, ruler, end, time_us)
            if side >= 0:
                return kept(ap, ruler, Found(angle, margin, True, i != 0 or side != 0, False), time_us)
    return half if half.margin > -FAR else widest


@law
def height_on_leg(origin: Vec3, destination: Vec3, point: Vec3) -> float:
    """How far down the path from an origin to a destination is beside a point [m]."""
    offset = horizontal(destination) - horizontal(origin)
    length = dot2(offset, offset)
    share = dot2(horizontal(point) - horizontal(origin), offset) / length if length > 0.0 else 1.0
    return origin.z + (destination.z - origin.z) * constrain(share, 0.0, 1.0)


@law
def plan(ap: Autopilot, origin: Vec3, destination: Vec3, upright: bool, time_us: int) -> None:
    """Look once, on the leg from an origin to a destination, and steer where that is needed."""
    nav, oa, est = ap.modes.nav, ap.params.OA, ap.estimate
    detour, offset = nav.detour, destination - est.pos
    reach = max(oa.BR.LOOKAHEAD, 1.0)
    detour.lookahead = constrain(detour.lookahead, 0.5 * reach, reach)
    distance = norm2(horizontal(offset))
    course = atan2(est.vel.y, est.vel.x) if norm2(horizontal(est.vel)) > SLOW else est.yaw
    ruler = Ruler(
        est.pos, destination, atan2(offset.y, offset.x), distance, min(detour.lookahead, distance + PAST),
        detour.lookahead, course, upright, oa.TYPE != 1.0,
    )  # fmt: skip
    found = look(ap, ruler, time_us)
    detour.lookahead = min(reach, detour.lookahead * 1.1) if found.is_free else max(0.5 * reach, detour.lookahead * 0.9)
    target = towards(ruler, found.angle, distance if upright else min(ruler.first, distance))
    if not upright:
        target = with_down(horizontal(target), height_on_leg(origin, destination, target))
    detour.bent_target = target
    if found.bends:
        detour.bend = BENT
    elif detour.bend == BENT:
        detour.bend = ENDED
        emit_and_return(ap.events, time_us, LEG_ENDING, DETOUR_REQUEST, 0.0)
    how = (1.0 if found.bends else 0.0) + (2.0 if found.is_kept else 0.0)
    emit(ap.events, time_us, BENDY_RULER_LOOKED, found.margin, how)


@law
def watch(ap: Autopilot, ground_d: float, upright: bool, time_us: int) -> None:
    """Ten times a second: on the way to a destination it looks once a second.

    ``ground_d``: how far down from the origin the heights of the leg count from [m].
    ``upright``: it looks for paths over and under what is in the way (OA_BR_TYPE 2).
    """
    nav = ap.modes.nav
    detour = nav.detour
    if ap.params.OA.TYPE not in BENDY_RULER:
        if detour.bend == BENT:
            detour.bend = ENDED
            emit_and_return(ap.events, time_us, LEG_ENDING, DETOUR_REQUEST, 0.0)
        return
    follows = nav.active_us > 0 and time_us - nav.active_us < RECENT_US
    if not follows or not ap.estimate.position_ok:
        detour.bend = STRAIGHT
    elif time_us - detour.bent_us >= PERIOD_US and nav.request_pending == 0 and not nav.reached:
        detour.bent_us = time_us
        above = Vec3(0.0, 0.0, ground_d)
        plan(ap, nav.current.origin + above, nav.target + above, upright, time_us)
