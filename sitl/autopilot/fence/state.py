# SPDX-License-Identifier: BSD-3-Clause
"""The record of fences: the areas that are loaded, and what the checks have found."""

from __future__ import annotations

from ...core.records import Floats, Ints, Record, array

SHAPES = 56
"""Areas that fit."""
CORNERS = 720
"""Corners of polygons and centres of circles that fit, all together."""

STAY_IN, STAY_OUT, CIRCLE_IN, CIRCLE_OUT = 1, 2, 3, 4
"""Kinds of areas: polygons to stay in and out of, circles to stay in and out of."""


class FenceState(Record):
    """Fences. Places are metres north and east of a point of reference, which is the estimator's origin once
    ``is_placed``: areas mean nothing before.
    """

    shapes: int  # areas that are loaded
    corners: int  # corners of all of them, in their order
    kind: Ints = array(SHAPES, stored="i4")  # STAY_IN, STAY_OUT, CIRCLE_IN, CIRCLE_OUT
    first: Ints = array(SHAPES, stored="i4")  # the area's first corner; a circle's is its centre
    count: Ints = array(SHAPES, stored="i4")  # of its corners; 1 for a circle
    radius: Floats = array(SHAPES, stored="f4")  # of a circle [m]
    north: Floats = array(CORNERS, stored="f4")  # of the point of reference [m]
    east: Floats = array(CORNERS, stored="f4")  # [m]
    reference_lat: int  # the point of reference [degE7]
    reference_lon: int  # [degE7]
    is_placed: bool  # the point of reference is the estimator's origin
