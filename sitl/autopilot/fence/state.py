# SPDX-License-Identifier: BSD-3-Clause
"""The records of fences (areas that are loaded, which fences are on, what checks have found) and of rally points."""

from __future__ import annotations

from ...core.records import Floats, Ints, Record, array

SHAPES = 56
"""Areas that fit."""
CORNERS = 720
"""Corners of polygons and centres of circles that fit, all together."""

STAY_IN, STAY_OUT, CIRCLE_IN, CIRCLE_OUT = 1, 2, 3, 4
"""Kinds of areas: polygons to stay in and out of, circles to stay in and out of."""


FLOOR_AUTO, FLOOR_ON, FLOOR_OFF = 0, 1, 2

MAX_ALT, CIRCLE, AREAS, MIN_ALT = 1, 2, 4, 8
"""Bits of fences, as FENCE_TYPE has them: greatest height, circle around home, areas, least height."""
FENCES = 4
"""Bit k is fence k."""
_NAMES = {MAX_ALT: "Max Alt", CIRCLE: "Circle", AREAS: "Polygon", MIN_ALT: "Min Alt"}


def names(fences: int) -> str:
    """ "Circle and Polygon fences" of the bits of fences."""
    listed = [name for bit, name in _NAMES.items() if fences & bit]
    joined = " and ".join([", ".join(listed[:-1]), listed[-1]] if len(listed) > 1 else listed)
    return f"{joined} fences" if len(listed) > 1 else f"{joined} fence"


class FenceState(Record):
    """Fences. Positions are metres north and east of a point of reference, which is the estimator's origin once
    ``is_placed``: areas mean nothing before.
    """

    shapes: int  # areas that are loaded
    corners: int  # corners of all of them, in their order
    kind: Ints = array(SHAPES, stored="i2")  # STAY_IN, STAY_OUT, CIRCLE_IN, CIRCLE_OUT
    first: Ints = array(SHAPES, stored="i2")  # the area's first corner; a circle's is its centre
    count: Ints = array(SHAPES, stored="i2")  # of its corners; 1 for a circle
    radius: Floats = array(SHAPES, stored="f4")  # of a circle [m]
    north: Floats = array(CORNERS, stored="f4")  # of the point of reference [m]
    east: Floats = array(CORNERS, stored="f4")  # [m]
    reference_lat: int  # the point of reference [degE7]
    reference_lon: int  # [degE7]
    is_placed: bool  # the point of reference is the estimator's origin
    on: int  # bits of the fences that are switched on
    floor: int  # the least height was switched by the user: FLOOR_ON, FLOOR_OFF, or not: FLOOR_AUTO
    seen_enable: int  # FENCE_ENABLE and
    seen_autoenable: int  # FENCE_AUTOENABLE as the last check saw them
    breached: int  # bits of fences
    near: int  # bits of fences that are within FENCE_MARGIN, or breached
    over: Floats = array(FENCES)  # how far beyond each fence the vehicle is [m]; negative: how far from it
    limit: Floats = array(FENCES)  # further beyond it than this is another breach [m]
    breaches: int  # so far
    breach_us: int  # since when, of the last time that one was
    recovery_us: int  # since when the pilot brings the vehicle back; 0 not
    reported_us: int  # when it was last reported how far a fence is


POINTS = 50
"""Rally points that fit."""


class RallyState(Record):
    """The rally points; RALLY_TOTAL of them count."""

    lat: Ints = array(POINTS, stored="i4")  # [degE7]
    lon: Ints = array(POINTS, stored="i4")  # [degE7]
    alt: Ints = array(POINTS, stored="i4")  # [m]
    is_amsl: Ints = array(POINTS, stored="u1")  # 1: heights count from mean sea level, 0: from home
