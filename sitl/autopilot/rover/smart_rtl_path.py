# SPDX-License-Identifier: BSD-3-Clause
"""The path that SMART_RTL drives back (SRTL_ACCURACY, SRTL_POINTS): where the vehicle has been since it was armed.

A point is kept when it is SRTL_ACCURACY from the last one. Fifty new points, or little room, and the path is simplified
(Ramer, Douglas and Peucker: points near the line between their neighbours go); when that is not enough, and before the
way home begins, loops are cut out where two stretches of the path come close. The first point is home.
"""

from __future__ import annotations

import math

from ...core.kernels import law
from ...core.scalars import constrain, finite
from ..events import PATH_LOST, emit
from .modes.state import PATH_POINTS

TIMEOUT_US = 15_000_000
"""Without a position or without room for so long, the path is given up."""
TRIGGER, LEAST, MARGIN = 50, 10, 10
"""New points that start a simplification; fewer do when less than MARGIN room is left."""
EPSILON_SHARE = 0.5
"""Of SRTL_ACCURACY: how far a dropped point may lie from the simplified path."""
LOOP_SHARE = 0.99
"""Of SRTL_ACCURACY: stretches of the path closer than this are one place."""

# Why the path was given up (PATH_LOST)
BAD_POSITION, FULL = 0, 1


@law
def capacity(ap):
    """Most points on the path."""
    return min(max(int(ap.params.SRTL.POINTS), 0), PATH_POINTS)


@law
def set_home(v):
    """On arming: forget the path; it begins here, if there is a position."""
    ap = v.autopilot
    path = ap.modes.path
    path.points = 0
    path.simplified = 0
    path.active = 0
    path.home_saved = 0
    if ap.estimate.position_ok == 0 or capacity(ap) == 0 or ap.params.SRTL.ACCURACY <= 0.0:
        return
    path.good_us = v.time_us
    path.saved_us = v.time_us
    path.active = 1
    path.home_saved = add(ap, float(ap.estimate.pos[0]), float(ap.estimate.pos[1]))


@law
def give_up(v, reason):
    """No path any more until the next arming."""
    v.autopilot.modes.path.active = 0
    emit(v.autopilot.events, v.time_us, PATH_LOST, float(reason), 0.0)


@law
def update(v, record):
    """Three times a second: note the position, when ``record``, and keep room."""
    ap = v.autopilot
    path = ap.modes.path
    if path.home_saved == 0 and ap.estimate.position_ok != 0:
        set_home(v)
    if path.active == 0 or record == 0:
        return
    if ap.estimate.position_ok == 0:
        if v.time_us - path.good_us > TIMEOUT_US:
            give_up(v, BAD_POSITION)
        return
    path.good_us = v.time_us
    if add(ap, float(ap.estimate.pos[0]), float(ap.estimate.pos[1])) != 0:
        path.saved_us = v.time_us
    elif v.time_us - path.saved_us > TIMEOUT_US:
        give_up(v, FULL)
    keep_room(ap)


@law
def add(ap, n, e):
    """Append a point; 0 when there is no room. A point near the last one needs none."""
    path = ap.modes.path
    if not finite(n + e):
        return 1
    last = int(path.points) - 1
    if last >= 0 and math.hypot(n - path.n[last], e - path.e[last]) < ap.params.SRTL.ACCURACY:
        return 1
    if path.points >= capacity(ap):
        return 0
    path.n[last + 1] = n
    path.e[last + 1] = e
    path.points += 1
    return 1


@law
def keep_room(ap):
    """Simplify now and then; cut loops only when that leaves little room."""
    path = ap.modes.path
    fresh = int(path.points) - int(path.simplified)
    tight = capacity(ap) - int(path.points) <= MARGIN
    if fresh >= TRIGGER or (tight and fresh >= LEAST):
        simplify(ap)
    elif tight:
        cut_loops(ap)


@law
def clean_up(ap):
    """Before the way home: the shortest path that has been driven."""
    simplify(ap)
    cut_loops(ap)


@law
def pop(ap):
    """Take the last point: (1, north, east), or (0, 0, 0) when the path is used up."""
    path = ap.modes.path
    if path.points == 0:
        return (0, 0.0, 0.0)
    path.points -= 1
    path.simplified = min(int(path.simplified), int(path.points))
    last = int(path.points)
    return (1, float(path.n[last]), float(path.e[last]))


@law
def peek(ap):
    """The last point without taking it: (1, north, east), or (0, 0, 0)."""
    path = ap.modes.path
    last = int(path.points) - 1
    if last < 0:
        return (0, 0.0, 0.0)
    return (1, float(path.n[last]), float(path.e[last]))


@law
def segment_distance(pn, pe, an, ae, bn, be):
    """Distance [m] of the point p from the stretch a .. b."""
    dn, de = bn - an, be - ae
    square = dn * dn + de * de
    share = 0.0
    if square > 0.0:
        share = constrain(((pn - an) * dn + (pe - ae) * de) / square, 0.0, 1.0)
    return math.hypot(pn - an - share * dn, pe - ae - share * de)


@law
def farthest(path, a, b):
    """(point between ``a`` and ``b`` that is farthest from the line between them, its distance [m])."""
    best = a
    most = 0.0
    for k in range(a + 1, b):
        distance = segment_distance(
            float(path.n[k]), float(path.e[k]), float(path.n[a]), float(path.e[a]), float(path.n[b]), float(path.e[b])
        )
        if distance > most:
            most = distance
            best = k
    return (best, most)


@law
def simplify(ap):
    """Drop points that lie on the line between those that stay; what was simplified before stays as it is."""
    path = ap.modes.path
    count = int(path.points)
    first = max(int(path.simplified) - 1, 0)
    for k in range(count):
        path.keep[k] = 1 if k <= first or k == count - 1 else 0
    a = first
    while a < count - 1:
        b = a + 1
        while path.keep[b] == 0:
            b += 1
        best, distance = farthest(path, a, b)
        if distance > EPSILON_SHARE * ap.params.SRTL.ACCURACY:
            path.keep[best] = 1
        else:
            a = b
    kept = 0
    for k in range(count):
        if path.keep[k] != 0:
            path.n[kept] = path.n[k]
            path.e[kept] = path.e[k]
            kept += 1
    path.points = kept
    path.simplified = kept


@law
def return_to(path, j, i):
    """(distance of point ``i`` from the stretch j-1 .. j, north and east of the place between) [m]."""
    an, ae = float(path.n[j - 1]), float(path.e[j - 1])
    pn, pe = float(path.n[i]), float(path.e[i])
    dn, de = float(path.n[j]) - an, float(path.e[j]) - ae
    square = dn * dn + de * de
    share = 0.0
    if square > 0.0:
        share = constrain(((pn - an) * dn + (pe - ae) * de) / square, 0.0, 1.0)
    qn, qe = an + share * dn, ae + share * de
    return (math.hypot(pn - qn, pe - qe), 0.5 * (pn + qn), 0.5 * (pe + qe))


@law
def crossing(path, j, i):
    """(distance of the stretches j-1 .. j and i-1 .. i, north and east of the place between) [m].

    Of neighbours and of parallel stretches, the end of the later one counts: it drove back along the other.
    """
    an, ae = float(path.n[j - 1]), float(path.e[j - 1])
    cn, ce = float(path.n[i - 1]), float(path.e[i - 1])
    un, ue = float(path.n[j]) - an, float(path.e[j]) - ae
    wn, we = float(path.n[i]) - cn, float(path.e[i]) - ce
    rn, re = an - cn, ae - ce
    uu, uw, ww = un * un + ue * ue, un * wn + ue * we, wn * wn + we * we
    det = uu * ww - uw * uw
    if i == j + 1 or det <= 1e-9 * uu * ww:
        return return_to(path, j, i)
    ur, wr = un * rn + ue * re, wn * rn + we * re
    s = constrain((uw * wr - ww * ur) / det, 0.0, 1.0)
    t = constrain((uu * wr - uw * ur) / det, 0.0, 1.0)
    pn, pe = an + s * un, ae + s * ue
    qn, qe = cn + t * wn, ce + t * we
    return (math.hypot(pn - qn, pe - qe), 0.5 * (pn + qn), 0.5 * (pe + qe))


@law
def cut_loops(ap):
    """Where a later stretch comes close to an earlier one, what lies between is cut out; from home outwards."""
    path = ap.modes.path
    near = LOOP_SHARE * float(ap.params.SRTL.ACCURACY)
    j = 1
    while j < int(path.points) - 1:
        i = int(path.points) - 1
        while i > j:
            distance, n, e = crossing(path, j, i)
            if distance < near:
                remove(path, j, i - 1, n, e)
                i = 0
            else:
                i -= 1
        j += 1


@law
def remove(path, first, last, n, e):
    """Replace the points ``first`` .. ``last`` by (n, e)."""
    path.n[first] = n
    path.e[first] = e
    count = int(path.points)
    for k in range(last + 1, count):
        path.n[k - last + first] = path.n[k]
        path.e[k - last + first] = path.e[k]
    path.points = count - last + first
    path.simplified = min(int(path.simplified), int(path.points))
