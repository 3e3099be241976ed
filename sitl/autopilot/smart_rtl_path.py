# SPDX-License-Identifier: BSD-3-Clause
"""The path that SMART_RTL goes back (SRTL_ACCURACY, SRTL_POINTS): where the vehicle has been since it was armed.

A point is kept when it is SRTL_ACCURACY from the last one. Fifty new points, or little space, and the path is
simplified (Ramer, Douglas and Peucker: points near the line between their neighbours go); when that is not enough, and
before the way home begins, loops are cut out where two stretches of the path come close. The first point is home.
Points are NED metres from the EKF origin; a rover's are all at 0 down.
"""

from __future__ import annotations

from typing import NamedTuple

from ..core.algebra import dot, finite_vector
from ..core.elementary import hypot
from ..core.kernels import law
from ..core.mavlink import MavSeverity
from ..core.scalars import constrain
from ..core.vectors import Vec3
from .events import Event, Events, emit
from .params.system import SmartRtl
from .state import PATH_POINTS, PathState

TIMEOUT_US = 15_000_000
"""Without a position or without space for so long, the path is given up."""
REPORT_INTERVAL_US = 10_000_000
"""How often it is said that there is little space."""
NEW_POINTS, NEW_POINTS_MIN, MARGIN = 50, 10, 10
"""New points that start a simplification; fewer do when less than MARGIN space is left."""
EPSILON_RATIO = 0.5
"""Of SRTL_ACCURACY: how far a dropped point may lie from the simplified path."""
LOOP_RATIO = 0.99
"""Of SRTL_ACCURACY: stretches of the path closer than this are one position."""

BAD_POSITION, FULL = 0, 1
"""Why the path was given up."""
_LOST = {BAD_POSITION: "SmartRTL deactivated: bad position", FULL: "SmartRTL deactivated: buffer full"}

PATH_LOST = Event(25, MavSeverity.WARNING, _LOST)
PATH_LOW = Event(35, MavSeverity.INFO, "SmartRTL Low on space!")


class Farthest(NamedTuple):
    """The point of a stretch that is farthest from the line between the stretch's ends."""

    k: int
    distance: float  # [m]


class Meeting(NamedTuple):
    """Where two stretches of the path come closest."""

    distance: float  # [m]
    pos: Vec3  # in the middle between them [m]


@law
def capacity(params: SmartRtl) -> int:
    """Most points on the path."""
    return min(max(int(params.POINTS), 0), PATH_POINTS)


@law
def length(v: Vec3) -> float:
    """Of a vector [m]."""
    return hypot(hypot(v.x, v.y), v.z)


@law
def point(path: PathState, k: int) -> Vec3:
    """Point ``k`` of the path [m]."""
    return Vec3(float(path.n[k]), float(path.e[k]), float(path.d[k]))


@law
def set_point(path: PathState, k: int, pos: Vec3) -> None:
    """Write point ``k`` of the path [m]."""
    path.n[k] = pos.x
    path.e[k] = pos.y
    path.d[k] = pos.z


@law
def begin(path: PathState, pos: Vec3, position_ok: bool, time_us: int, params: SmartRtl) -> None:
    """On arming: forget the path; it begins at ``pos``, NED [m], if that is known (``position_ok``)."""
    path.points = 0
    path.simplified = 0
    path.active = False
    path.home_saved = False
    path.reported_us = 0
    if not position_ok or capacity(params) == 0 or params.ACCURACY <= 0.0:
        return
    path.good_us = time_us
    path.saved_us = time_us
    path.active = True
    path.home_saved = add(path, pos, params)


@law
def give_up(path: PathState, events: Events, time_us: int, reason: int) -> None:
    """No path any more until the next arming."""
    path.active = False
    emit(events, time_us, PATH_LOST, float(reason), 0.0)


@law
def record(path: PathState, pos: Vec3, position_ok: bool, events: Events, time_us: int, params: SmartRtl) -> None:
    """Three times a second, unless on the way home: note the position, NED [m], if it is known, and keep space."""
    if not path.active:
        return
    if not position_ok:
        if time_us - path.good_us > TIMEOUT_US:
            give_up(path, events, time_us, BAD_POSITION)
        return
    path.good_us = time_us
    if add(path, pos, params):
        path.saved_us = time_us
    elif time_us - path.saved_us > TIMEOUT_US:
        give_up(path, events, time_us, FULL)
    keep_space(path, params)
    if is_tight(path, params) and (path.reported_us == 0 or time_us - path.reported_us >= REPORT_INTERVAL_US):
        path.reported_us = time_us
        emit(events, time_us, PATH_LOW, 0.0, 0.0)


@law
def add(path: PathState, pos: Vec3, params: SmartRtl) -> bool:
    """Append a point [m]; False when there is no space. A point near the last one needs none."""
    if not finite_vector(pos):
        return True
    if path.points > 0:
        if length(pos - point(path, path.points - 1)) < params.ACCURACY:
            return True
    if path.points >= capacity(params):
        return False
    set_point(path, path.points, pos)
    path.points += 1
    return True


@law
def drop_last(path: PathState) -> None:
    """Take the last point away; there is one."""
    path.points -= 1
    path.simplified = min(path.simplified, path.points)


@law
def is_tight(path: PathState, params: SmartRtl) -> bool:
    """Whether little space is left."""
    return capacity(params) - path.points <= MARGIN


@law
def keep_space(path: PathState, params: SmartRtl) -> None:
    """Simplify now and then; cut loops only when that leaves little space."""
    fresh = path.points - path.simplified
    tight = is_tight(path, params)
    if fresh >= NEW_POINTS or (tight and fresh >= NEW_POINTS_MIN):
        simplify(path, params.ACCURACY)
    elif tight:
        cut_loops(path, params.ACCURACY)


@law
def clean_up(path: PathState, accuracy: float) -> None:
    """Before the way home: the shortest path that it has been along, to ``accuracy`` [m]."""
    simplify(path, accuracy)
    cut_loops(path, accuracy)


@law
def ratio_along(p: Vec3, a: Vec3, b: Vec3) -> float:
    """Where on the stretch a .. b the point nearest to p is: 0 .. 1."""
    line = b - a
    square = dot(line, line)
    if square > 0.0:
        return constrain(dot(p - a, line) / square, 0.0, 1.0)
    return 0.0


@law
def stretch_distance(p: Vec3, a: Vec3, b: Vec3) -> float:
    """Distance [m] of the point p from the stretch a .. b."""
    return length(p - a - ratio_along(p, a, b) * (b - a))


@law
def farthest(path: PathState, first: int, last: int) -> Farthest:
    """The point between two of the path that is farthest from the line between them."""
    a, b = point(path, first), point(path, last)
    k_max = first
    distance_max = 0.0
    for k in range(first + 1, last):
        distance = stretch_distance(point(path, k), a, b)
        if distance > distance_max:
            distance_max = distance
            k_max = k
    return Farthest(k_max, distance_max)


@law
def simplify(path: PathState, accuracy: float) -> None:
    """Drop points that lie on the line between those that stay; what was simplified before stays as it is."""
    count = path.points
    first = max(path.simplified - 1, 0)
    for k in range(count):
        path.keep[k] = 1 if k <= first or k == count - 1 else 0
    a = first
    while a < count - 1:
        b = a + 1
        while path.keep[b] == 0:
            b += 1
        found = farthest(path, a, b)
        if found.distance > EPSILON_RATIO * accuracy:
            path.keep[found.k] = 1
        else:
            a = b
    kept = 0
    for k in range(count):
        if path.keep[k] != 0:
            set_point(path, kept, point(path, k))
            kept += 1
    path.points = kept
    path.simplified = kept


@law
def meeting(p: Vec3, q: Vec3) -> Meeting:
    """Of two points [m]."""
    return Meeting(length(p - q), 0.5 * (p + q))


@law
def nearest(path: PathState, j: int, i: int) -> Meeting:
    """Where the stretches j-1 .. j and i-1 .. i of the path come closest.

    Of neighbours and of parallel stretches, the end of the later one counts: it drove back along the other.
    """
    a, c = point(path, j - 1), point(path, i - 1)
    b, d = point(path, j), point(path, i)
    u, w, r = b - a, d - c, a - c
    uu, uw, ww = dot(u, u), dot(u, w), dot(w, w)
    det = uu * ww - uw * uw
    if i == j + 1 or det <= 1e-9 * uu * ww:
        return meeting(d, a + ratio_along(d, a, b) * u)
    ur, wr = dot(u, r), dot(w, r)
    s = constrain((uw * wr - ww * ur) / det, 0.0, 1.0)
    t = constrain((uu * wr - uw * ur) / det, 0.0, 1.0)
    return meeting(a + s * u, c + t * w)


@law
def cut_loops(path: PathState, accuracy: float) -> None:
    """Where a later stretch comes close to an earlier one, what lies between is cut out; from home outwards."""
    j = 1
    while j < path.points - 1:
        i = path.points - 1
        while i > j:
            met = nearest(path, j, i)
            if met.distance < LOOP_RATIO * accuracy:
                replace(path, j, i - 1, met.pos)
                i = 0
            else:
                i -= 1
        j += 1


@law
def replace(path: PathState, first: int, last: int, pos: Vec3) -> None:
    """Put ``pos`` [m] where the points ``first`` .. ``last`` were."""
    set_point(path, first, pos)
    for k in range(last + 1, path.points):
        set_point(path, k - last + first, point(path, k))
    path.points = path.points - last + first
    path.simplified = min(path.simplified, path.points)
